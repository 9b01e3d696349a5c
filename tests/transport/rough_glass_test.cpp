// Rough interfaces of solids and rough panes, as the walk and direct light meet them.
#include <doctest/doctest.h>

#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/direct_light.h"
#include "transport/walking.h"

using namespace lsde;
using test::SceneBuilder;

namespace {

Material rough(Material m, float roughness) {
    m.roughness = roughness;
    return m;
}

Vertex arriveAt(const Scene& scene, Vec3 from, Vec3 direction, PathState& path) {
    path = test::startAt(scene, from, direction);
    WalkScratch scratch;
    Vertex v;
    REQUIRE(advance(scene, path, v, scratch));
    return v;
}

bool bounce(const Vertex& v, Quantity quantity, PathState& path, test::Random& random) {
    BsdfSample s;
    const float uLobe = random.uniform();
    return sampleBsdf(v.bsdf, v.wo, uLobe, random.uniform2D(), s) && scatter(v, s, quantity, path);
}

}  // namespace

TEST_CASE("light sampled through a rough interface is what sampled directions find behind it, from either side") {
    SceneBuilder builder;
    const VolumeProperties dye{{0.3F, 0.6F, 0.9F}, 1};
    builder.add(test::box({-9, -9, -9}, {9, 0, 9}), rough(test::glass(1.5F, dye), 0.4F));
    builder.add(test::plate({0, 1, 0}, 0.8F, false), test::emitter(Rgb(1)));
    builder.add(test::plate({0.2F, -1, 0}, 0.8F), test::emitter(Rgb(2)));
    const auto scene = builder.build();
    const LightSampler lights(*scene, test::allLights(*scene));
    const std::vector<std::pair<Vec3, Vec3>> starts = {{{0.3F, -0.5F, 0}, {0.1F, 1, 0}},
                                                       {{0.3F, 0.5F, 0}, {0.2F, -1, 0.3F}}};
    for (const auto& [from, direction] : starts) {
        PathState start;
        const Vertex v = arriveAt(*scene, from, direction, start);
        CHECK(v.interface);
        test::Random random(5);
        WalkScratch scratch;
        test::Mean byLight, byBsdf;
        for (int i = 0; i < 200'000; ++i) {
            const float uLight = random.uniform();
            const DirectLight d = sampleDirectLight(*scene, lights.at(litPlace(v)), v, {true, true, 0}, uLight,
                                                    random.uniform2D(), scratch);
            byLight.add(d.glossy.x);
            PathState path = start;
            path.throughput = Rgb(1);
            Vertex next;
            float found = 0;
            if (bounce(v, Quantity::Radiance, path, random) && advance(*scene, path, next, scratch))
                found = path.throughput.x * scene->emission(next.surface, next.woWorld).x;
            byBsdf.add(found);
        }
        CAPTURE(byLight.value());
        CAPTURE(byBsdf.value());
        CHECK(byLight.value() > 0.05);
        CHECK(test::agree(byLight, byBsdf, 4.5));
    }
}

TEST_CASE("paths through rough solids in solids come out of all they entered, with radiance scaled back") {
    SceneBuilder builder;
    builder.add(test::box({-3, -3, -3}, {3, 3, 3}), rough(test::glass(1.33F), 0.3F)).priority = 1;
    builder.add(test::box({-2, -2, -2}, {2, 2, 2}), rough(test::glass(1.31F), 0.2F)).priority = 2;
    builder.add(test::sphere({0, 0, 0}, 1, 3), rough(test::glass(1.5F), 0.4F)).priority = 3;
    const auto scene = builder.build();
    test::Random random(6);
    int through = 0, deepest = 0;
    for (int i = 0; i < 2000; ++i) {
        PathState path = test::startAt(*scene, {-5, 0.1F, 0.2F}, {1, 0.01F, 0.02F});
        WalkScratch scratch;
        Vertex v;
        float eta = 1;
        bool goesOn = true;
        while (goesOn && advance(*scene, path, v, scratch)) {
            BsdfSample s;
            const float uLobe = random.uniform();
            goesOn = sampleBsdf(v.bsdf, v.wo, uLobe, random.uniform2D(), s) && scatter(v, s, Quantity::Radiance, path);
            eta *= goesOn ? s.eta : 1;
            deepest = std::max(deepest, path.media.size());
            // What the stack says is what was refracted by.
            const float ior = scene->media()[path.media.dominant(scene->media())].ior;
            if (goesOn) REQUIRE(eta == doctest::Approx(ior).epsilon(1e-4));
        }
        if (!goesOn) continue;
        ++through;
        CHECK(path.media.size() == 0);
        CHECK(path.throughput.x < 1.001F);
    }
    CHECK(through > 1000);
    CHECK(deepest == 3);
}

TEST_CASE("a rough pane scatters light that goes through it, and hides lights from shadow rays") {
    SceneBuilder builder;
    builder.add(test::plate({0, 0, 0}, 9), test::lambert(Rgb(0.5F)));
    builder.add(test::plate({0, 1, 0}, 9), rough(test::thinWall(Rgb(1)), 0.3F));
    const auto scene = builder.build();
    PathState path;
    WalkScratch scratch;
    const Vertex floor = arriveAt(*scene, {0, 0.5F, 0}, {0, -1, 0}, path);
    CHECK(isBlack(visibility(*scene, floor, {0, 1, 0}, 2, scratch).transmittance));
    const Vertex pane = arriveAt(*scene, {0, 0.5F, 0}, {0, 1, 0}, path);
    CHECK_FALSE(hasDelta(pane.bsdf));
    test::Random random(7);
    int bent = 0;
    for (int i = 0; i < 100; ++i) {
        PathState next = path;
        if (bounce(pane, Quantity::Radiance, next, random) && next.ray.direction.y > 0)
            bent += next.ray.direction.y < 0.9999F ? 1 : 0;
    }
    CHECK(bent > 50);
}

TEST_CASE("a pane that is partly diffuse passes the rest unbent, for walks and shadow rays alike") {
    SceneBuilder builder;
    builder.add(test::plate({0, 0, 0}, 9), test::lambert(Rgb(0.5F)));
    Material milky = test::thinWall(Rgb(0.8F, 0.4F, 0.2F));
    milky.transmission = 0.25F;
    builder.add(test::plate({0, 1, 0}, 9), milky);
    const auto scene = builder.build();
    PathState path;
    WalkScratch scratch;
    const Vertex floor = arriveAt(*scene, {0, 0.5F, 0}, {0, -1, 0}, path);
    const Visibility v = visibility(*scene, floor, {0, 1, 0}, 2, scratch);
    CHECK(v.straightPassages == 1);
    for (int c = 0; c < 3; ++c) CHECK(v.transmittance[c] == doctest::Approx(0.25 * 0.96 * milky.baseColor[c]));
    const Vertex pane = arriveAt(*scene, {0, 0.5F, 0}, {0, 1, 0}, path);
    CHECK(hasDiffuseLobe(pane.bsdf));
    CHECK(test::deltaLobe(pane, true)->weight.x == doctest::Approx(v.transmittance.x));
}
