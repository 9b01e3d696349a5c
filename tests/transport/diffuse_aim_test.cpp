#include "transport/diffuse_aim.h"

#include <doctest/doctest.h>

#include "sampling/sampler.h"
#include "support/chi_squared.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/cone.h"

using namespace lsde;
using test::SceneBuilder;

namespace {

// A floor with casters above it, one of them half below the horizon, one around a part of the floor.
std::unique_ptr<Scene> floorWithCasters() {
    SceneBuilder builder;
    const auto caster = [&](Vec3 centre, float radius) {
        builder.add(test::sphere(centre, radius, 1), test::metal(0));
    };
    caster({0, 1, 0}, 0.5F);
    caster({0.6F, 0.9F, 0}, 0.4F);  // overlaps the first
    caster({1.5F, 0, 0.5F}, 0.4F);  // on the horizon
    caster({-2, 0, 0}, 0.7F);
    return builder.build();
}

Vertex floorAt(Vec3 position, bool fromBelow) {
    Vertex v;
    v.surface.position = position;
    v.surface.ng = v.surface.ns = {0, 1, 0};
    v.frame = Frame(v.surface.ns);
    v.woWorld = {0, fromBelow ? -1.0F : 1.0F, 0};
    v.wo = v.frame.toLocal(v.woWorld);
    return v;
}

constexpr DiffuseBsdf kGrey{Rgb(0.5F)};
constexpr int kTests = 4;

bool sampleOnce(const DiffuseAim& aim, const Vertex& v, Sampler sampler, DiffuseAim::Direction& direction) {
    const float uChoice = sampler.next();
    return aim.sample(v, kGrey, uChoice, sampler.next2D(), direction);
}

}  // namespace

TEST_CASE("directions aimed from a diffuse surface have the density of the mixture") {
    const auto scene = floorWithCasters();
    const DiffuseAim aim(*scene, 0.5F);
    for (const bool fromBelow : {false, true})
        for (const Vec3 p : {Vec3(0, 0, 0), Vec3(-2, 0, 0.1F)}) {  // the second lies in a caster's sphere
            CAPTURE(fromBelow);
            const Vertex v = floorAt(p, fromBelow);
            uint64_t i = 0;
            const auto result = test::chiSquaredOnSphere(
                {24, 24, 12, 100'000},
                [&]() -> std::optional<Vec3> {
                    Sampler s = Sampler::sequence(i++, Stage::Test, 0);
                    DiffuseAim::Direction d;
                    const float uChoice = s.next();
                    if (!aim.sample(v, kGrey, uChoice, s.next2D(), d)) return {};
                    return v.frame.toWorld(d.sample.wi);
                },
                [&](Vec3 direction) -> double {
                    return direction.y * v.woWorld.y > 0 ? aim.pdf(v, kGrey, direction) : 0;
                });
            CHECK(result.accepted(kTests));
        }
}

TEST_CASE("the weights of aimed directions carry all the light, and none carries more than the lobe's share allows") {
    const auto scene = floorWithCasters();
    const Vertex v = floorAt({0.2F, 0, 0.1F}, false);
    for (const float share : {0.0F, 0.5F, 0.9F}) {
        const DiffuseAim aim(*scene, share);
        double sum = 0;
        constexpr int kSamples = 1 << 16;
        for (int i = 0; i < kSamples; ++i) {
            Sampler s = Sampler::sequence(1, Stage::Test, static_cast<uint64_t>(i));
            DiffuseAim::Direction d;
            const Vec2 u = s.next2D();
            if (!aim.sample(v, kGrey, s.next(), u, d)) continue;
            CHECK(d.weight <= 1.00001F / (1 - share));
            if (share == 0) CHECK(d.weight == 1);
            sum += d.weight;
        }
        CHECK(sum / kSamples == doctest::Approx(1).epsilon(share > 0.5F ? 0.015 : 0.005));
    }
}

TEST_CASE("the mean weight is 1 on both sides, in a caster's sphere and beside casters below the horizon") {
    const auto scene = floorWithCasters();
    const DiffuseAim aim(*scene, 0.5F);
    for (const bool fromBelow : {false, true})
        for (const Vec3 p : {Vec3(0.2F, 0, 0.1F), Vec3(-2, 0, 0.1F), Vec3(1, 0.5F, 0), Vec3(0, 9, 0)}) {
            CAPTURE(fromBelow);
            CAPTURE(p.x);
            const Vertex v = floorAt(p, fromBelow);
            test::Mean weight;
            for (uint64_t i = 0; i < 100'000; ++i) {
                DiffuseAim::Direction d;
                // Directions below the horizon carry nothing: the others make up for them.
                const bool goesOn = sampleOnce(aim, v, Sampler::sequence(i, Stage::Test, 1), d);
                weight.add(goesOn ? static_cast<double>(d.weight) : 0);
                if (goesOn) REQUIRE(d.sample.wi.z * v.wo.z > 0);
            }
            CHECK(weight.agrees(1));
        }
}

TEST_CASE("more casters than are aimed at one by one are aimed at in groups") {
    SceneBuilder builder;
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 8; ++column)
            builder.add(
                test::sphere({0.5F * static_cast<float>(column) - 2, 2, 0.5F * static_cast<float>(row) - 1}, 0.2F, 1),
                test::metal(0));
    const auto scene = builder.build();
    REQUIRE(scene->casters().size() == 16);
    const DiffuseAim aim(*scene, 0.5F);
    const Vertex v = floorAt({0.3F, 0, 0.1F}, false);
    test::Mean weight, aimed;
    for (uint64_t i = 0; i < 50'000; ++i) {
        DiffuseAim::Direction d;
        const bool goesOn = sampleOnce(aim, v, Sampler::sequence(i, Stage::Test, 2), d);
        weight.add(goesOn ? static_cast<double>(d.weight) : 0);
        aimed.add(d.aimed ? 1 : 0);
    }
    CHECK(weight.agrees(1));
    CHECK(aimed.agrees(0.5));
}

TEST_CASE("nothing is aimed at a sphere around the point, nor at one below the horizon") {
    SceneBuilder builder;
    builder.add(test::sphere({0, 1, 0}, 0.5F, 1), test::metal(0));
    const auto scene = builder.build();
    const DiffuseAim aim(*scene, 0.5F);
    const auto aimedFrom = [&](Vec3 p, bool fromBelow) {
        const Vertex v = floorAt(p, fromBelow);
        int aimed = 0;
        for (uint64_t i = 0; i < 1000; ++i) {
            DiffuseAim::Direction d;
            if (!sampleOnce(aim, v, Sampler::sequence(1, Stage::Test, i), d)) d.aimed = true;
            aimed += d.aimed ? 1 : 0;
            if (!d.aimed) CHECK(d.weight > 0);
        }
        return aimed;
    };
    CHECK(aimedFrom({0, 0, 0}, false) == doctest::Approx(500).epsilon(0.01));
    CHECK(aimedFrom({0, 2, 0}, true) == doctest::Approx(500).epsilon(0.01));
    CHECK(aimedFrom({0, 0, 0}, true) == 0);
    CHECK(aimedFrom({0, 2, 0}, false) == 0);
    CHECK(aimedFrom({0, 1.1F, 0}, false) == 0);
    CHECK(aimedFrom({0, 1.1F, 0}, true) == 0);
}

TEST_CASE("a sphere's cone ends at its tangents, wide or narrow") {
    for (const float radius : {1e-3F, 0.1F, 0.5F, 0.9F, 0.999F}) {
        CAPTURE(radius);
        const Cone cone = coneTo({{0, 0, 1}, radius}, Vec3(0));
        REQUIRE(!cone.everything);
        const float angle = std::asin(radius);
        CHECK(within(cone, {std::sin(0.999F * angle), 0, std::cos(0.999F * angle)}));
        CHECK(!within(cone, {0, std::sin(1.001F * angle), std::cos(1.001F * angle)}));
        // Of the horizon: turned below it by the half angle the cone is just out of sight.
        const auto normalAt = [&](float beyond) {
            const float turned = kPi / 2 + beyond * angle;
            return Vec3(std::sin(turned), 0, std::cos(turned));
        };
        CHECK(cosineShare(cone, normalAt(0.99F)) > 0);
        CHECK(cosineShare(cone, normalAt(1.01F)) == 0);
    }
    CHECK(coneTo({{0, 0, 1}, 1.5F}, Vec3(0)).everything);
}
