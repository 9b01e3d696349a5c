#include "transport/light_sampler.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "base/error.h"
#include "support/random.h"
#include "support/scenes.h"

using namespace lsde;
using test::SceneBuilder;

namespace {

constexpr LitPlace kUp{{0, 0, 0}, {0, 1, 0}};

double sumOfProbabilities(const Scene& scene, const LightChoice& choice) {
    double sum = 0;
    for (size_t i = 0; i < scene.lights().size(); ++i) sum += choice.probability(i);
    return sum;
}

}  // namespace

TEST_CASE("every selected light is chosen, the strongest most often, and none is an error") {
    SceneBuilder builder;
    builder.point({0, 1, 0}, Rgb(1));
    builder.point({0, 1, 0}, Rgb(1000));
    builder.point({0, 1, 0}, Rgb(1e-6F));
    const auto scene = builder.build();
    const LightSampler all(*scene, {true, true, true});
    const LightChoice choice = all.at(kUp);
    CHECK(sumOfProbabilities(*scene, choice) == doctest::Approx(1));
    CHECK(choice.probability(1) > 0.9F);
    CHECK(choice.probability(2) >= 0.1F * 0.2F / 3);
    const LightSampler one(*scene, {true, false, false});
    CHECK(one.at(kUp).probability(0) == 1);
    CHECK(one.selected(0));
    CHECK_FALSE(one.selected(1));
    CHECK(one.at(kUp).probability(1) == 0);
    CHECK_THROWS_AS(LightSampler(*scene, {false, false, false}), Error);
}

TEST_CASE("lights are chosen with the probability that is told, few or many, of all kinds") {
    for (const int perSide : {2, 14}) {
        CAPTURE(perSide);
        SceneBuilder builder;
        for (int i = 0; i < perSide; ++i)
            for (int k = 0; k < perSide; ++k)
                builder.point({static_cast<float>(i), 2, static_cast<float>(k)}, Rgb(static_cast<float>(1 + i * k)));
        builder.add(test::plate({1, 3, 0}, 0.5F, false), test::emitter(Rgb(2)));
        builder.add(test::plate({-1, 3, 0}, 0.5F, false), test::emitter(Rgb(2), true));
        builder.spot({0, 2, 1}, {0, 0, 0}, Rgb(3), 10, 20);
        builder.sun({0.3F, -1, 0.2F}, Rgb(1));
        builder.sun({0, -1, 0.2F}, Rgb(1));
        builder.environment(test::spottedSky());
        builder.sunDisc({1, 2, 0}, 0.265F, Rgb(1e4F));
        const auto scene = builder.build();
        const LightSampler lights(*scene, test::allLights(*scene));
        for (const LitPlace& place : {kUp, LitPlace{{3, 1.5F, 0.2F}, glm::normalize(Vec3(1, 0.2F, 0))}}) {
            const LightChoice choice = lights.at(place);
            CHECK(sumOfProbabilities(*scene, choice) == doctest::Approx(1).epsilon(1e-5));
            std::vector<int> chosen(scene->lights().size());
            constexpr int kSamples = 400'000;
            double rest = 0;
            for (int i = 0; i < kSamples; ++i) {
                float u = (static_cast<float>(i) + 0.5F) / kSamples;
                ++chosen[choice.choose(u)];
                rest += static_cast<double>(u);
            }
            CHECK(rest / kSamples == doctest::Approx(0.5).epsilon(0.02));
            for (size_t i = 0; i < chosen.size(); ++i) {
                CHECK(choice.probability(i) > 0);
                CHECK(std::fabs(chosen[i] - static_cast<double>(choice.probability(i)) * kSamples) < 12);
            }
        }
    }
}

TEST_CASE("a light is chosen by what it may send to the place") {
    SceneBuilder builder;
    builder.point({0.5F, 1, 0}, Rgb(1));                                         // 0: near
    builder.point({10, 1, 0}, Rgb(1));                                           // 1: far
    builder.point({0, -1, 0}, Rgb(1));                                           // 2: below the horizon
    builder.add(test::plate({0, 1, 0.5F}, 0.1F, false), test::emitter(Rgb(1)));  // shines down
    const auto scene = builder.build();
    size_t lamp = 0, near = 0, far = 0, below = 0;
    for (size_t i = 0; i < scene->lights().size(); ++i) {
        const auto* point = std::get_if<PointLight>(&scene->lights()[i].shape);
        (point == nullptr ? lamp : point->position.x == 10 ? far : point->position.y < 0 ? below : near) = i;
    }
    const LightSampler lights(*scene, test::allLights(*scene));
    const LightChoice choice = lights.at(kUp);
    CHECK(choice.probability(near) > 50 * (choice.probability(far) - 0.1F * 0.33F));
    CHECK(choice.probability(below) < 0.1F);
    CHECK(choice.probability(below) > 0);
    // From above the lamp is dark.
    const LightChoice above = lights.at({{0, 1.5F, 0.5F}, {0, -1, 0}});
    CHECK(above.probability(lamp) < 0.1F);
    CHECK(choice.probability(lamp) > above.probability(lamp));
}

TEST_CASE("where the sun does not reach, the sky around is chosen") {
    SceneBuilder builder;
    builder.add(test::plate({0, 0, 0}, 1), test::lambert(Rgb(0.5F)));
    builder.environment(RgbImage(4, 2, Rgb(0.1F)));
    builder.sunDisc({0, 1, 0}, 0.265F, Rgb(1e6F));
    const auto scene = builder.build();
    const LightSampler lights(*scene, test::allLights(*scene));
    CHECK(lights.at(kUp).probability(0) < 0.2F);
    CHECK(lights.at({{0, 0, 0}, {0, -1, 0}}).probability(0) > 0.9F);
    CHECK_FALSE(lights.onePoint());
    CHECK(lights.bsdfSamples(kUp) == 1);
    CHECK(LightSampler(*scene, {false, true}).bsdfSamples(kUp) == 0);
}
