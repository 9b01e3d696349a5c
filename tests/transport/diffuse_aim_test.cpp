#include "transport/diffuse_aim.h"

#include <doctest/doctest.h>

#include "sampling/sampler.h"
#include "sampling/warp.h"
#include "support/chi_squared.h"
#include "support/random.h"
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
constexpr int kAimTests = 4;
constexpr float kBoost = 4;

bool sampleOnce(const DiffuseAim& aim, const Vertex& v, Sampler sampler, DiffuseAim::Direction& direction) {
    const float uChoice = sampler.next();
    const Vec2 u = sampler.next2D();
    return aim.at(v, kGrey).sample(uChoice, u, sampler.next(), direction);
}

// Teaches that in the upper half of each caster's cone nothing is worth anything, and in the lower most what the next
// event's number leaves below a fourth.
constexpr float kWorthMost = 0.25F;
void teachLowerHalf(DiffuseAim& aim, const Scene& scene) {
    test::Random random(11);
    std::vector<DiffuseAim::Trial> trials;
    for (size_t i = 0; i < 20'000 * scene.casters().size(); ++i) {
        const PrimaryPoint u = {random.uniform(), random.uniform(), random.uniform(), 0};
        const float below = u[2] < kWorthMost ? 8 : 1;
        trials.push_back({i % scene.casters().size(), {u, squareToCone({u[0], u[1]}, 1).y > 0 ? 0 : below}});
    }
    aim.learn(trials);
}

}  // namespace

TEST_CASE("directions aimed from a diffuse surface have the density of the mixture") {
    const auto scene = floorWithCasters();
    const DiffuseAim aim(*scene, kBoost);
    for (const bool fromBelow : {false, true})
        for (const Vec3 p : {Vec3(0, 0, 0), Vec3(-2, 0, 0.1F)}) {  // the second lies in a caster's sphere
            CAPTURE(fromBelow);
            const Vertex v = floorAt(p, fromBelow);
            uint64_t i = 0;
            const auto result = test::chiSquaredOnSphere(
                {24, 24, 12, 100'000},
                [&]() -> std::optional<Vec3> {
                    DiffuseAim::Direction d;
                    if (!sampleOnce(aim, v, Sampler::sequence(i++, Stage::Test, 0), d)) return {};
                    return v.frame.toWorld(d.sample.wi);
                },
                [&](Vec3 direction) -> double {
                    return direction.y * v.woWorld.y > 0 ? aim.at(v, kGrey).pdf(direction, 0) : 0;
                });
            CHECK(result.accepted(kAimTests));
        }
}

TEST_CASE("what is learnt has the density of the mixture, of the direction and of the next event's number together") {
    const auto scene = floorWithCasters();
    DiffuseAim aim(*scene, kBoost);
    teachLowerHalf(aim, *scene);
    const Vertex v = floorAt({0, 0, 0}, false);
    for (const bool most : {false, true}) {
        CAPTURE(most);
        uint64_t i = 0;
        const auto result = test::chiSquaredOnSphere(
            {24, 24, 12, 100'000},
            [&]() -> std::optional<Vec3> {
                DiffuseAim::Direction d;
                if (!sampleOnce(aim, v, Sampler::sequence(i++, Stage::Test, 3), d)) return {};
                if ((d.uEvent < kWorthMost) != most) return {};
                return v.frame.toWorld(d.sample.wi);
            },
            [&](Vec3 direction) -> double {
                if (direction.y <= 0) return 0;
                constexpr int kNumbers = 4;  // between which the density hardly changes
                const float from = most ? 0 : kWorthMost, length = most ? kWorthMost : 1 - kWorthMost;
                double sum = 0;
                for (int n = 0; n < kNumbers; ++n)
                    sum += aim.at(v, kGrey).pdf(direction, from + length * (static_cast<float>(n) + 0.5F) / kNumbers);
                return sum * static_cast<double>(length) / kNumbers;
            });
        CHECK(result.accepted(2));
    }
}

TEST_CASE("light is aimed at the part of a caster that was worth most, from wherever on a surface and on either side") {
    SceneBuilder builder;
    builder.add(test::sphere({0, 1, 0}, 0.5F, 1), test::metal(0));
    builder.add(test::sphere({0, -1, 0}, 0.5F, 1), test::metal(0));
    const auto scene = builder.build();
    DiffuseAim aim(*scene, 100);
    teachLowerHalf(aim, *scene);
    for (const bool fromBelow : {false, true})
        for (const Vec3 p : {Vec3(1, 0, 0), Vec3(-0.5F, 0, 2)}) {
            CAPTURE(fromBelow);
            CAPTURE(p.x);
            const Vertex v = floorAt(p, fromBelow);
            test::Mean lower, most;
            for (uint64_t i = 0; i < 20'000; ++i) {
                DiffuseAim::Direction d;
                if (!sampleOnce(aim, v, Sampler::sequence(i, Stage::Test, 4), d) || !d.aimed()) continue;
                const Vec3 towards = v.frame.toWorld(d.sample.wi), centre = glm::normalize(Vec3(0, 1, 0) - p);
                lower.add(std::abs(towards.y) < centre.y ? 1 : 0);
                most.add(d.uEvent < kWorthMost ? 1 : 0);
            }
            // A tenth of the mean goes everywhere; the root of the mean square of 8 in a fourth, and 1.
            CHECK(lower.value() > 0.9);
            CHECK(most.value() > 0.6);
        }
}

TEST_CASE("light aimed from a diffuse surface has even weights, near and far from the caster") {
    SceneBuilder builder;
    builder.add(test::sphere({0, 1, 0}, 0.5F, 1), test::metal(0));
    const auto scene = builder.build();
    for (const float boost : {0.0F, 4.0F, 100.0F, 1e4F}) {
        const DiffuseAim aim(*scene, boost);
        for (const Vec3 p : {Vec3(0.2F, 0, 0.1F), Vec3(3, 0, 0), Vec3(0, 0, 30)}) {
            CAPTURE(boost);
            CAPTURE(p.x);
            const Vertex v = floorAt(p, false);
            const float aimed = boost * aim.at(v, kGrey).share();
            CHECK(aim.at(v, kGrey).effort() == doctest::Approx(1 + std::min(32.0F, aimed)));
            for (uint64_t i = 0; i < 20'000; ++i) {
                DiffuseAim::Direction d;
                if (!sampleOnce(aim, v, Sampler::sequence(1, Stage::Test, i), d)) continue;
                CHECK(d.weight <= 1.00001F);
                // Of the lobe's density, within the cone, by the cone's mean density: up to the cosine's change in it.
                if (d.aimed()) {
                    if (aimed < 32) CHECK(d.weight < 2.5F / (1 + boost));
                    CHECK(d.weight > 0);
                }
            }
        }
    }
}

TEST_CASE("the mean weight is 1 on both sides, in a caster's sphere and beside casters below the horizon") {
    const auto scene = floorWithCasters();
    DiffuseAim aim(*scene, kBoost);
    for (const int round : {0, 1, 2, 3})
        for (const Vec3 p : {Vec3(0.2F, 0, 0.1F), Vec3(-2, 0, 0.1F), Vec3(1, 0.5F, 0), Vec3(0, 9, 0)}) {
            const bool fromBelow = round % 2 == 1;
            if (round == 2) teachLowerHalf(aim, *scene);
            CAPTURE(round);
            CAPTURE(p.x);
            const Vertex v = floorAt(p, fromBelow);
            test::Mean weight;
            for (uint64_t i = 0; i < 100'000; ++i) {
                DiffuseAim::Direction d;
                // Directions below the horizon carry nothing: the others make up for them.
                const bool goesOn = sampleOnce(aim, v, Sampler::sequence(i, Stage::Test, 1), d);
                weight.add(goesOn ? static_cast<double>(d.weight * aim.at(v, kGrey).effort()) : 0);
                if (goesOn) REQUIRE(d.sample.wi.z * v.wo.z > 0);
            }
            CHECK(weight.agrees(1));
        }
}

TEST_CASE("no direction towards a far caster weighs as if it had not been aimed") {
    SceneBuilder builder;
    builder.add(test::sphere({1, 100, -2}, 0.01F, 2), test::metal(0));
    const auto scene = builder.build();
    constexpr float kHigh = 1e8F;
    const DiffuseAim aim(*scene, kHigh);
    const Vertex v = floorAt({0.1F, 0, 0.3F}, false);
    const auto at = aim.at(v, kGrey);
    for (uint64_t i = 0; i < 300'000; ++i) {
        DiffuseAim::Direction d;
        if (sampleOnce(aim, v, Sampler::sequence(1, Stage::Test, i), d) && d.aimed())
            REQUIRE(d.weight * (at.effort() - 1) < 2.5F * at.share());
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
    const DiffuseAim aim(*scene, kBoost);
    const Vertex v = floorAt({0.3F, 0, 0.1F}, false);
    test::Mean weight, aimed;
    for (uint64_t i = 0; i < 50'000; ++i) {
        DiffuseAim::Direction d;
        const bool goesOn = sampleOnce(aim, v, Sampler::sequence(i, Stage::Test, 2), d);
        const float effort = aim.at(v, kGrey).effort();
        weight.add(goesOn ? static_cast<double>(d.weight * effort) : 0);
        aimed.add((d.aimed() ? 1 : 0) - (effort - 1) / effort);
    }
    CHECK(weight.agrees(1));
    CHECK(aimed.agrees(0));
}

TEST_CASE("nothing is aimed at a sphere around the point, nor at one below the horizon") {
    SceneBuilder builder;
    builder.add(test::sphere({0, 1, 0}, 0.5F, 1), test::metal(0));
    const auto scene = builder.build();
    const DiffuseAim aim(*scene, kBoost);
    const auto aimedFrom = [&](Vec3 p, bool fromBelow) {
        const Vertex v = floorAt(p, fromBelow);
        int aimed = 0;
        for (uint64_t i = 0; i < 1000; ++i) {
            DiffuseAim::Direction d;
            const bool goesOn = sampleOnce(aim, v, Sampler::sequence(1, Stage::Test, i), d);
            aimed += d.aimed() || !goesOn ? 1 : 0;
            if (goesOn && !d.aimed()) CHECK(d.weight > 0);
        }
        return aimed;
    };
    // Half the distance away: the cone's 1 - cos is .134, its share of the lobe as much.
    const double shareAimed = kBoost * 0.134 / (1 + kBoost * 0.134);
    CHECK(aimedFrom({0, 0, 0}, false) == doctest::Approx(1000 * shareAimed).epsilon(0.02));
    CHECK(aimedFrom({0, 2, 0}, true) == doctest::Approx(1000 * shareAimed).epsilon(0.02));
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
