#include "transport/emission.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "base/error.h"
#include "support/chi_squared.h"
#include "support/scenes.h"
#include "support/statistics.h"

using namespace lsde;
using test::SceneBuilder;

namespace {

// Where the light of these tests is, and around it casters far and near, overlapping, holding it, and behind it.
const Vec3 kLight(0.1F, 2, -0.2F);

void addCasters(SceneBuilder& scene) {
    const auto caster = [&](Vec3 centre, float radius) { scene.add(test::sphere(centre, radius, 1), test::metal(0)); };
    caster({0, 0.5F, 0}, 0.5F);
    caster({0.4F, 0.4F, 0.1F}, 0.4F);   // overlaps the first
    caster({-1.5F, 0.2F, 0.8F}, 0.1F);  // small
    caster({0.2F, 3, 0}, 0.3F);         // behind a light that shines down
    caster({1.5F, 1.9F, 0.3F}, 0.5F);   // on its horizon
}

void addContainingCaster(SceneBuilder& scene) { scene.add(test::sphere(kLight, 1, 1), test::metal(0)); }

// So small that every point of it sees the casters in the same directions; five triangles of different sizes.
Mesh speck() {
    const auto corner = [](float x, float z) { return kLight + 1e-5F * Vec3(x, 0, z); };
    return test::polygonFan({corner(0, 0), corner(1, 0), corner(1, 0.3F), corner(0.9F, 0.9F), corner(0.4F, 1),
                             corner(0, 0.9F), corner(-0.2F, 0.5F)});
}

enum class Kind { Point, Spot, NarrowSpot, Measured, AreaDown, AreaBothSides, Sun, SunDisc, Environment };
constexpr std::array kKinds = {Kind::Point,         Kind::Spot, Kind::NarrowSpot, Kind::Measured,   Kind::AreaDown,
                               Kind::AreaBothSides, Kind::Sun,  Kind::SunDisc,    Kind::Environment};
const Vec3 kFromSun(0.3F, -1, 0.2F);

void addLight(SceneBuilder& scene, Kind kind, const Mesh& lamp = speck()) {
    const Rgb strength(1, 2, 0.5F);
    switch (kind) {
        case Kind::Point:
            return scene.point(kLight, strength);
        case Kind::Spot:
            return scene.spot(kLight, {0.3F, 0, 0}, strength, 20, 60);
        case Kind::NarrowSpot:
            return scene.spot(kLight, {0.1F, 0, 0}, strength, 0.3F, 0.5F);
        case Kind::Measured:
            return scene.measured(kLight, strength);
        case Kind::AreaDown:
            scene.add(lamp, test::emitter(strength));
            return;
        case Kind::AreaBothSides:
            scene.add(lamp, test::emitter(strength, true));
            return;
        case Kind::Sun:
            return scene.sun(kFromSun, strength);
        case Kind::SunDisc:
            return scene.sunDisc(-kFromSun, 0.265F, 1e4F * strength);
        case Kind::Environment:
            return scene.environment(test::spottedSky(), 0.4F);
    }
}

struct Drawn {
    bool emits;
    LightPathStart start;
};

Drawn draw(const EmissionSampler& sources, uint64_t index, uint64_t seed = 1) {
    Sampler sampler = Sampler::sequence(seed, Stage::Test, index);
    Drawn d;
    d.emits = sources.sample(sampler, d.start);
    return d;
}

// Each from a sequence of its own: chi-squared tests expect independent samples.
Drawn drawIndependently(const EmissionSampler& sources, uint64_t i) { return draw(sources, 0, i); }

constexpr int kEmissionTests = 30;  // chi-squared tests in this file

// What it learns here has no sense, so that nothing but its use is tested: that paths to one side are worth much.
EmissionSampler learntSampler(const Scene& scene, AimShares shares = kAimedAtCasters) {
    EmissionSampler sources(scene, test::allLights(scene), shares);
    std::vector<AimTrial> trials;
    for (uint64_t i = 0; i < 50'000; ++i) {
        const LightPathStart start = draw(sources, i, 99).start;
        const Vec3 to = start.ray.origin + start.ray.direction;
        trials.push_back({start.light, start.part, {start.u, to.x > 0.1F && to.z > -0.3F ? 5.0F : 1.0F}});
    }
    sources.learn(trials);
    return sources;
}

void checkDirections(Kind kind, bool contained, bool learnt = false) {
    SceneBuilder builder;
    addCasters(builder);
    if (contained) addContainingCaster(builder);
    addLight(builder, kind);
    const auto scene = builder.build();
    const EmissionSampler sources =
        learnt ? learntSampler(*scene) : EmissionSampler(*scene, test::allLights(*scene), kAimedAtCasters);
    uint64_t i = 0;
    const auto result = test::chiSquaredOnSphere(
        {24, 24, 12, 100'000},
        [&]() -> std::optional<Vec3> {
            const Drawn d = drawIndependently(sources, i++);
            return d.emits ? std::optional(d.start.ray.direction) : std::nullopt;
        },
        [&](Vec3 direction) -> double {
            // The speck shines down, and half of what a two-sided one emits goes up.
            const bool up = kind == Kind::AreaBothSides && direction.y > 0;
            const float share = kind == Kind::AreaBothSides ? 0.5F : 1;
            const auto d = sources.directionDensities(0, kLight, {0, up ? 1 : -1, 0}, direction);
            return d.whole > 0 ? share * d.mixture : 0;
        });
    CHECK(result.accepted(kEmissionTests));
}

}  // namespace

TEST_CASE("directions from a light have the density of its mixture") {
    for (const Kind kind : {Kind::Point, Kind::Spot, Kind::AreaDown, Kind::AreaBothSides})
        for (const bool contained : {false, true}) {
            CAPTURE(static_cast<int>(kind));
            CAPTURE(contained);
            checkDirections(kind, contained);
        }
}

TEST_CASE("also where it has learnt which are worth more") {
    for (const Kind kind : {Kind::Point, Kind::Spot})
        for (const bool contained : {false, true}) {
            CAPTURE(static_cast<int>(kind));
            CAPTURE(contained);
            checkDirections(kind, contained, true);
        }
}

namespace {

void checkDiscs(Kind kind, bool learnt) {
    SceneBuilder builder;
    addCasters(builder);
    builder.add(test::plate({0, 0, 0}, 3), test::lambert(Rgb(0.5F)));
    addLight(builder, kind);
    const auto scene = builder.build();
    const EmissionSampler sources =
        learnt ? learntSampler(*scene) : EmissionSampler(*scene, test::allLights(*scene), kAimedAtCasters);
    const Sphere whole = scene->boundingSphere();
    const Frame frame(glm::normalize(kFromSun));
    const double side = 2 * whole.radius;
    uint64_t i = 0;
    const auto result = test::chiSquaredOnSquare(
        {24, 24, learnt ? 50 : 12, 100'000},
        [&]() -> std::optional<Vec2> {
            const Drawn d = drawIndependently(sources, i++);
            if (!d.emits) return std::nullopt;
            const Vec3 local = frame.toLocal(d.start.ray.origin - whole.centre);
            return Vec2(local) / (2 * whole.radius) + Vec2(0.5F);
        },
        [&](double x, double y) -> double {
            const Vec3 p = whole.centre + frame.toWorld(Vec3(static_cast<float>((x - 0.5) * side),
                                                             static_cast<float>((y - 0.5) * side), 0));
            const auto d = sources.discDensities(0, p, frame.z);
            return d.whole > 0 ? d.mixture * side * side : 0;
        });
    CHECK(result.accepted(kEmissionTests));
}

}  // namespace

TEST_CASE("rays of a directional light and of the sun have the density of its mixture of discs") {
    checkDiscs(Kind::Sun, false);
    checkDiscs(Kind::SunDisc, false);
}

TEST_CASE("also where it has learnt where they are worth more") { checkDiscs(Kind::Sun, true); }

TEST_CASE("rays of an environment come from each direction by its density, wherever they are aimed") {
    SceneBuilder builder;
    addCasters(builder);
    addLight(builder, Kind::Environment);
    const auto scene = builder.build();
    const EmissionSampler sources(*scene, test::allLights(*scene), kAimedAtCasters);
    const auto& light = std::get<InfiniteLight>(scene->lights()[0].shape);
    uint64_t i = 0;
    // Rays past the scene's disc carry nothing: what is aimed at a caster at its rim. Here all are within it.
    const auto result = test::chiSquaredOnSphere(
        {24, 24, 12, 100'000},
        [&]() -> std::optional<Vec3> {
            const Drawn d = drawIndependently(sources, i++);
            return d.emits ? std::optional(-d.start.ray.direction) : std::nullopt;
        },
        [&](Vec3 towards) { return light.pdfW(towards); });
    CHECK(result.accepted(kEmissionTests));
}

TEST_CASE("an even environment's rays go through a small sphere as pi times its cross-section says") {
    double errorUnaimed = kInfinity;
    for (const bool aim : {false, true}) {
        CAPTURE(aim);
        SceneBuilder builder;
        addCasters(builder);
        builder.environment(RgbImage(4, 2, Rgb(3)));
        const auto scene = builder.build();
        const EmissionSampler sources(*scene, test::allLights(*scene), aim ? kAimedAtCasters : kNotAimed);
        const Sphere target{{0.4F, 0.4F, 0.1F}, 0.3F};
        test::Mean power;
        for (uint64_t i = 0; i < 200'000; ++i) {
            const Drawn d = draw(sources, i);
            const Vec3 toCentre = target.centre - d.start.ray.origin;
            const bool hit = d.emits && glm::length(glm::cross(d.start.ray.direction, toCentre)) < target.radius;
            power.add(hit ? d.start.power.x : 0);
        }
        CHECK(power.agrees(3 * 4 * kPi * kPi * square(target.radius)));
        // It lies in a caster.
        CHECK(power.standardError() < errorUnaimed);
        errorUnaimed = 0.8 * power.standardError();
    }
}

TEST_CASE("what is learnt of directions changes no flux where the discs of several casters overlap") {
    const Sphere target{{0, 1, 0}, 0.3F};
    SceneBuilder builder;
    builder.add(test::sphere(target.centre, 0.5F, 1), test::metal(0));
    builder.add(test::sphere(target.centre, 0.9F, 1), test::metal(0));
    builder.add(test::plate({0, 0, 0}, 2), test::lambert(Rgb(0.5F)));
    builder.environment(RgbImage(4, 2, Rgb(3)));
    const auto scene = builder.build();
    EmissionSampler sources(*scene, test::allLights(*scene), kAimedAtCasters);
    std::vector<AimTrial> trials;
    for (uint64_t i = 0; i < 50'000; ++i) {
        const LightPathStart start = draw(sources, i, 99).start;
        // In one part alone, so that errors of two do not make up for each other.
        const bool worth = start.part != 1 || start.ray.direction.y > 0;
        trials.push_back({start.light, start.part, {start.u, worth ? 5.0F : 0.5F}});
    }
    sources.learn(trials);
    test::Mean up, down;
    for (uint64_t i = 0; i < 200'000; ++i) {
        const Drawn d = draw(sources, i);
        const Ray& r = d.start.ray;
        const bool hit = d.emits && glm::length(glm::cross(r.direction, target.centre - r.origin)) < target.radius;
        up.add(hit && r.direction.y > 0 ? d.start.power.x : 0);
        down.add(hit && r.direction.y < 0 ? d.start.power.x : 0);
    }
    CHECK(up.agrees(3 * 2 * kPi * kPi * square(target.radius)));
    CHECK(down.agrees(3 * 2 * kPi * kPi * square(target.radius)));
}

TEST_CASE("no path weighs more than the whole emission's share allows") {
    for (const Kind kind : kKinds)
        for (const bool contained : {false, true}) {
            CAPTURE(static_cast<int>(kind));
            SceneBuilder builder;
            addCasters(builder);
            if (contained) addContainingCaster(builder);
            addLight(builder, kind);
            const auto scene = builder.build();
            const EmissionSampler sources(*scene, test::allLights(*scene), kAimedAtCasters);
            float most = 0;
            for (uint64_t i = 0; i < 50'000; ++i) {
                const Drawn d = draw(sources, i);
                if (d.emits) most = std::max(most, d.start.aimWeight);
            }
            CHECK(most > 0.1F);
            CHECK(most <= 1.0001F / kAimedAtCasters.whole);
        }
}

TEST_CASE("nothing that meets a far caster, or its rim, weighs as if it had not been aimed") {
    constexpr float kRadius = 0.01F;
    const Vec3 centre = kLight - Vec3(1, 100, -2);
    for (const Kind kind : {Kind::Point, Kind::AreaDown, Kind::Sun, Kind::Environment}) {
        CAPTURE(static_cast<int>(kind));
        SceneBuilder builder;
        builder.add(test::sphere(centre, kRadius, 2), test::metal(0));
        builder.add(test::plate(centre, 50, false), test::lambert(Rgb(0.5F)));
        addLight(builder, kind);
        const auto scene = builder.build();
        const EmissionSampler sources(*scene, test::allLights(*scene), kAimedAtCasters);
        int met = 0;
        float most = 0;
        for (uint64_t i = 0; i < 300'000; ++i) {
            const Drawn d = draw(sources, i);
            if (!d.emits) continue;
            const glm::dvec3 direction(d.start.ray.direction), toCentre = glm::dvec3(centre - d.start.ray.origin);
            // What was aimed is all there is so close by, whole emission is too rare.
            if (glm::length(glm::cross(direction, toCentre)) > 1.5 * static_cast<double>(kRadius)) continue;
            ++met;
            most = std::max(most, d.start.aimWeight);
        }
        CHECK(met > 100'000);
        CHECK(most < 1e-3F);
    }
}

TEST_CASE("the mean power of a path is the lights' total power, aimed or not") {
    const Mesh lamp = test::plate(kLight, 0.4F, false);
    for (const Kind kind : kKinds)
        for (const bool aim : {false, true}) {
            CAPTURE(static_cast<int>(kind));
            CAPTURE(aim);
            SceneBuilder builder;
            addCasters(builder);
            addLight(builder, kind, lamp);
            const auto scene = builder.build();
            const EmissionSampler sources(*scene, test::allLights(*scene), aim ? kAimedAtCasters : kNotAimed);
            test::Mean power;
            for (uint64_t i = 0; i < 100'000; ++i) {
                const Drawn d = draw(sources, i);
                power.add(d.emits ? d.start.power.y : 0);
            }
            CHECK(power.value() > 0);
            CHECK(power.agrees(sources.totalPower().y));
        }
}

TEST_CASE("the sun gives a caster whose bounds reach beyond the scene's disc nothing from beyond it") {
    SceneBuilder builder;
    builder.add(test::quad({-5, 0, 0.5F}, {5, 0, 0.5F}, {5, 0, -0.5F}, {-5, 0, -0.5F}), test::lambert(Rgb(0.5F)));
    builder.add(test::plate({4.5F, 0, 0}, 0.5F), test::metal(0));
    builder.sun({0, -1, 0}, Rgb(1));
    const auto scene = builder.build();
    const EmissionSampler sources(*scene, test::allLights(*scene), kAimedAtCasters);
    const Sphere disc = scene->boundingSphere();
    int inCaster = 0;
    for (uint64_t i = 0; i < 10'000; ++i) {
        const Drawn d = draw(sources, i);
        if (!d.emits) continue;
        const Vec2 offset(d.start.ray.origin.x - disc.centre.x, d.start.ray.origin.z - disc.centre.z);
        CHECK(glm::length(offset) <= disc.radius * 1.00001F);
        inCaster += offset.x > 4 ? 1 : 0;
    }
    CHECK(inCaster > 5000);
}

TEST_CASE("the total power is that of Lambert, of all directions, of the spot's cone and of the sun's disc") {
    const auto totalOf = [](Kind kind) {
        SceneBuilder builder;
        addCasters(builder);
        addLight(builder, kind, test::plate(kLight, 0.4F, false));
        const auto scene = builder.build();
        return EmissionSampler(*scene, test::allLights(*scene), kAimedAtCasters).totalPower().y /
               (square(scene->boundingSphere().radius) * kPi);
    };
    SceneBuilder casters;
    addCasters(casters);
    const float disc = kPi * square(casters.build()->boundingSphere().radius);
    CHECK(totalOf(Kind::Sun) == doctest::Approx(2));
    CHECK(totalOf(Kind::Point) * disc == doctest::Approx(2 * 4 * kPi));
    // 1 - cos within the inner cone, a third of the rest.
    const double inner = 1 - std::cos(0.3 * kPi / 180), outer = 1 - std::cos(0.5 * kPi / 180);
    CHECK(totalOf(Kind::NarrowSpot) * disc ==
          doctest::Approx(2 * 2 * kPi * (inner + (outer - inner) / 3)).epsilon(1e-5));
    SceneBuilder lamp;
    lamp.add(test::plate({0, 0, 0}, 0.4F), test::emitter(Rgb(3)));
    CHECK(lamp.build()->lights()[0].power().x == doctest::Approx(3 * kPi * 0.64F));
}

TEST_CASE("aiming, learnt or not, changes no flux: on a caster, beside it, and by direction") {
    const Mesh lamp = test::plate(kLight, 0.4F, false);
    for (const Kind kind : {Kind::Point, Kind::Spot, Kind::Measured, Kind::AreaDown, Kind::AreaBothSides, Kind::Sun,
                            Kind::SunDisc, Kind::Environment}) {
        CAPTURE(static_cast<int>(kind));
        SceneBuilder builder;
        addCasters(builder);
        addLight(builder, kind, lamp);
        const auto scene = builder.build();
        // Flux through discs on the floor: under the casters, half under one, and beside.
        const std::array<Vec3, 3> targets = {Vec3(0, 0, 0), Vec3(-1.3F, 0, 0.6F), Vec3(0.2F, 0, -1.6F)};
        std::array<std::array<test::Mean, 3>, 3> flux;
        const std::array<EmissionSampler, 3> samplers = {
            EmissionSampler(*scene, test::allLights(*scene), kNotAimed),
            EmissionSampler(*scene, test::allLights(*scene), kAimedAtCasters), learntSampler(*scene)};
        for (size_t way = 0; way < samplers.size(); ++way) {
            const EmissionSampler& sources = samplers[way];
            for (uint64_t i = 0; i < 100'000; ++i) {
                const Drawn d = draw(sources, i);
                const Ray& r = d.start.ray;
                const Vec3 onFloor = r.at(-r.origin.y / r.direction.y);
                for (size_t t = 0; t < targets.size(); ++t) {
                    const bool hit = d.emits && r.direction.y < 0 && glm::length(onFloor - targets[t]) < 0.4F;
                    flux[way][t].add(hit ? d.start.power.y : 0);
                }
            }
        }
        for (size_t t = 0; t < targets.size(); ++t) {
            CAPTURE(t);
            CHECK(flux[0][t].value() > 0);
            CHECK(test::agree(flux[0][t], flux[1][t]));
            CHECK(test::agree(flux[0][t], flux[2][t]));
        }
        // What aiming is for: under the casters, less noise. From an environment the floor there is lit past them.
        if (kind != Kind::Environment) CHECK(flux[1][0].standardError() < flux[0][0].standardError());
    }
}

TEST_CASE("around a small glass in a large scene light is sampled at all scales, and its flux is right") {
    constexpr float kHeight = 50;
    SceneBuilder builder;
    builder.add(test::sphere({0, 0, 0}, 0.05F, 2), test::glass(1.5F));
    builder.add(test::plate({0, 0, 0}, 500, true), test::lambert(Rgb(0.5F)));
    builder.point({0, kHeight, 0}, Rgb(1));
    const auto scene = builder.build();
    const EmissionSampler sources(*scene, test::allLights(*scene), kAimedGoingOn);
    constexpr std::array kRadii = {0.1F, 0.4F, 1.6F, 6.4F, 25.6F};
    std::array<test::Mean, kRadii.size()> flux;
    std::array<int, kRadii.size()> paths{};
    constexpr int kPaths = 200'000;
    for (uint64_t i = 0; i < kPaths; ++i) {
        const Drawn d = draw(sources, i);
        const Ray& r = d.start.ray;
        const Vec3 onFloor = r.at(-r.origin.y / r.direction.y);
        for (size_t k = 0; k < kRadii.size(); ++k) {
            const bool within = d.emits && r.direction.y < 0 && glm::length(onFloor) < kRadii[k];
            flux[k].add(within ? d.start.power.y : 0);
            paths[k] += within ? 1 : 0;
        }
    }
    for (size_t k = 0; k < kRadii.size(); ++k) {
        CAPTURE(kRadii[k]);
        const double solidAngle = 2 * kPi * (1 - kHeight / std::hypot(kHeight, kRadii[k]));
        CHECK(flux[k].agrees(solidAngle));
        if (k > 0) CHECK(paths[k] - paths[k - 1] > kPaths / 50);
    }
}

TEST_CASE("one path in several is aimed at each light's casters, and several lights share the paths by power's root") {
    SceneBuilder builder;
    addCasters(builder);
    builder.point({0, 2, 0}, Rgb(9));
    builder.point({0, 3, 1}, Rgb(1));
    const auto scene = builder.build();
    const EmissionSampler sources(*scene, test::allLights(*scene), kAimedAtCasters);
    std::array<test::Mean, 2> power;
    std::array<int, 2> paths{};
    constexpr int kPaths = 100'000;
    for (uint64_t i = 0; i < kPaths; ++i) {
        const Drawn d = draw(sources, i);
        ++paths[d.start.light];
        for (size_t l = 0; l < 2; ++l) power[l].add(d.start.light == l ? d.start.power.x : 0);
    }
    CHECK(paths[0] == doctest::Approx(kPaths * (0.9 * 0.75 + 0.05)).epsilon(0.001));
    CHECK(power[0].agrees(9 * 4 * kPi));
    CHECK(power[1].agrees(1 * 4 * kPi));
}

TEST_CASE("the first points of the sequence lie evenly over a light's directions") {
    SceneBuilder builder;
    builder.add(test::plate({0, 0, 0}, 1), test::lambert(Rgb(0.5F)));
    builder.point({0, 1, 0}, Rgb(1));
    const auto scene = builder.build();
    const EmissionSampler sources(*scene, test::allLights(*scene), kNotAimed);
    // 256 points of a (0,2)-sequence: one in each of 16 x 16 cells of equal solid angle.
    std::array<int, 256> cells{};
    for (uint64_t i = 0; i < 256; ++i) {
        const Vec3 d = draw(sources, i).start.ray.direction;
        const float turn = std::atan2(d.y, d.x) / (2 * kPi);
        const int row = static_cast<int>(8 * (1 - d.z)), column = static_cast<int>(16 * (turn < 0 ? turn + 1 : turn));
        ++cells[static_cast<size_t>(std::min(row, 15)) * 16 + static_cast<size_t>(std::min(column, 15))];
    }
    CHECK(std::count(cells.begin(), cells.end(), 1) >= 250);  // rounding may move a few over a cell's edge
}

TEST_CASE("a path's further numbers start at the same dimension for every light") {
    for (const Kind kind : kKinds) {
        SceneBuilder builder;
        addCasters(builder);
        addLight(builder, kind);
        const auto scene = builder.build();
        const EmissionSampler sources(*scene, test::allLights(*scene), kNotAimed);
        Sampler sampler = Sampler::sequence(1, Stage::Test, 17), fresh = sampler;
        LightPathStart start;
        REQUIRE(sources.sample(sampler, start));
        fresh.skipTo(6);
        CHECK(sampler.next() == fresh.next());
    }
}

TEST_CASE("paths that start within a solid know it, and others do not") {
    const auto mediaOf = [](auto addLightTo) {
        SceneBuilder builder;
        builder.add(test::box({-1, -1, -1}, {1, 1, 1}), test::glass(1.5F));
        Mesh& water = builder.add(test::plate({8, 0, 0}, 1), test::glass(1.33F));
        water.openEdges = 4;
        addLightTo(builder);
        const auto scene = builder.build();
        const EmissionSampler sources(*scene, test::allLights(*scene), kNotAimed);
        return draw(sources, 3).start.media;
    };
    const auto lampAt = [](Vec3 p) {
        return [p](SceneBuilder& b) { b.add(test::plate(p, 0.1F, false), test::emitter(Rgb(1))); };
    };
    const auto pointAt = [](Vec3 p) { return [p](SceneBuilder& b) { b.point(p, Rgb(1)); }; };
    for (const Vec3 inside : {Vec3(0, 0, 0), Vec3(-0.9F, 0.8F, 0.8F)}) {
        CHECK(mediaOf(lampAt(inside)).contains(1));
        CHECK(mediaOf(pointAt(inside)).contains(1));
        CHECK(mediaOf(pointAt(inside)).size() == 1);
    }
    for (const Vec3 outside : {Vec3(0, 1.5F, 0), Vec3(2, 0, 0), Vec3(8, 0.5F, 0)}) {
        CHECK(mediaOf(lampAt(outside)).size() == 0);
        CHECK(mediaOf(pointAt(outside)).size() == 0);
    }
    // Below an open sheet is inside.
    CHECK(mediaOf(lampAt({8, -3, 0})).contains(2));
    CHECK(mediaOf(pointAt({8, -3, 0})).contains(2));
    CHECK(mediaOf([](SceneBuilder& b) { b.sun({0, -1, 0}, Rgb(1)); }).size() == 0);
}

TEST_CASE("an emission without any light is refused") {
    SceneBuilder builder;
    builder.add(test::plate({0, 0, 0}, 1), test::lambert(Rgb(0.5F)));
    builder.point({0, 1, 0}, Rgb(1));
    const auto scene = builder.build();
    CHECK_THROWS_AS(EmissionSampler(*scene, {false}, kAimedAtCasters), Error);
}
