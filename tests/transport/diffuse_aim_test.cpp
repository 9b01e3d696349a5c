#include "transport/diffuse_aim.h"

#include <doctest/doctest.h>

#include "sampling/sampler.h"
#include "support/chi_squared.h"
#include "support/scenes.h"

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
