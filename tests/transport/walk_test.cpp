#include "transport/walk.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "bsdf/fresnel.h"
#include "sampling/sampler.h"
#include "support/scenes.h"
#include "transport/walking.h"

using namespace lsde;
using test::SceneBuilder;

namespace {

constexpr float kIor = 1.5F;

// A point of a path as it does not depend on the scene's size and place.
struct Step {
    Vec3 position;
    uint32_t mesh;
    Event event;
};

// The events of a path from `origin`, at most `longest`; numbers by index.
std::vector<Step> walk(const Scene& scene, Vec3 origin, Vec3 direction, uint64_t index, size_t longest) {
    PathState path = test::startAt(scene, origin, direction);
    Sampler sampler = Sampler::sequence(7, Stage::Test, index);
    WalkScratch scratch;
    std::vector<Step> steps;
    Vertex v;
    while (steps.size() < longest && advance(scene, path, v, scratch)) {
        BsdfSample sample;
        const float uLobe = sampler.next();
        if (!sampleBsdf(v.bsdf, v.wo, uLobe, sampler.next2D(), sample)) break;
        steps.push_back({v.surface.position, v.surface.mesh, sample.event});
        if (!scatter(v, sample, Quantity::Power, path)) break;
    }
    return steps;
}

// A closed room with a ball and a cube of glass, a mirror and a tilted board; flat faces throughout.
SceneBuilder room() {
    SceneBuilder scene;
    scene.add(test::flipped(test::box({-1, 0, -1}, {1, 2, 1})), test::lambert(Rgb(0.8F)));
    scene.add(test::sphere({-0.4F, 0.5F, 0.1F}, 0.35F, 2, test::Shading::Flat), test::glass(kIor));
    scene.add(test::box({0.2F, 0.1F, -0.5F}, {0.7F, 0.6F, 0}), test::glass(kIor));
    scene.add(test::quad({0.3F, 0.9F, 0.5F}, {0.8F, 0.8F, 0.6F}, {0.85F, 1.5F, 0.3F}, {0.35F, 1.6F, 0.2F}),
              test::metal(0));
    scene.add(test::quad({-0.8F, 1.2F, -0.3F}, {-0.2F, 1.3F, -0.4F}, {-0.25F, 1.6F, -0.7F}, {-0.85F, 1.5F, -0.6F}),
              test::lambert(Rgb(0.8F)));
    return scene;
}

// A plate at y = 0 with the normal `ns` at all corners.
Vertex bentVertex(const Scene& scene, Vec3 wo) {
    PathState path = test::startAt(scene, wo, -wo);
    WalkScratch scratch;
    Vertex v;
    REQUIRE(advance(scene, path, v, scratch));
    return v;
}

std::unique_ptr<Scene> bentPlate(Vec3 ns, const Material& material) {
    SceneBuilder builder;
    Mesh plate = test::plate({0, 0, 0}, 1);
    plate.normals.assign(4, glm::normalize(ns));
    builder.add(plate, material);
    return builder.build();
}

}  // namespace

TEST_CASE(
    "a slab of glass shifts a ray by Snell's law, takes eta squared from radiance within it and none from power") {
    SceneBuilder builder;
    constexpr float kThickness = 0.4F;
    builder.add(test::box({-9, -kThickness, -9}, {9, 0, 9}), test::glass(kIor));
    const auto scene = builder.build();
    for (const float angleDeg : {0.0F, 20.0F, 55.0F, 80.0F}) {
        CAPTURE(angleDeg);
        const float theta = angleDeg * kPi / 180, inside = std::asin(std::sin(theta) / kIor);
        const Vec3 direction(std::sin(theta), -std::cos(theta), 0);
        PathState radiance = test::startAt(*scene, -direction, direction), power = radiance;
        const float t = 1 - fresnelDielectric(std::cos(theta), kIor).reflectance;

        test::pass(*scene, radiance, Quantity::Radiance);
        test::pass(*scene, power, Quantity::Power);
        CHECK(radiance.ray.direction.x == doctest::Approx(std::sin(inside)));
        CHECK(radiance.throughput.x == doctest::Approx(t / square(kIor)));
        CHECK(power.throughput.x == doctest::Approx(t));
        CHECK(radiance.media.size() == 1);

        const Vertex out = test::pass(*scene, radiance, Quantity::Radiance);
        test::pass(*scene, power, Quantity::Power);
        CHECK(glm::length(radiance.ray.direction - direction) < 1e-5F);
        CHECK(out.surface.position.x == doctest::Approx(kThickness * std::tan(inside)));
        CHECK(out.distance == doctest::Approx(kThickness / std::cos(inside)));
        CHECK(radiance.throughput.x == doctest::Approx(t * t));
        CHECK(power.throughput.x == doctest::Approx(t * t));
        CHECK(radiance.media.size() == 0);
        CHECK(test::escapes(*scene, radiance));
    }
}

TEST_CASE("a ball of glass turns a ray by twice the refraction, and by total reflection never lets it in or out") {
    SceneBuilder builder;
    builder.add(test::sphere({0, 0, 0}, 1, 6), test::glass(kIor));
    const auto scene = builder.build();
    for (const float b : {0.05F, 0.3F, 0.6F, 0.9F}) {  // impact parameter
        CAPTURE(b);
        const Vec3 aside = glm::normalize(Vec3(0.31F, 0.77F, 0));
        PathState path = test::startAt(*scene, b * aside + Vec3(0, 0, 3), {0, 0, -1});
        test::pass(*scene, path);
        test::pass(*scene, path);
        const float deviation = 2 * (std::asin(b) - std::asin(b / kIor));
        CHECK(std::acos(-path.ray.direction.z) == doctest::Approx(deviation).epsilon(0.01));
        CHECK(glm::dot(path.ray.direction, aside) < 0);
        CHECK(test::escapes(*scene, path));
    }
    // From within, beyond the critical angle.
    PathState path = test::startAt(*scene, {0, 0, 0.9F}, {1, 0.02F, 0.01F});
    WalkScratch scratch;
    Vertex v;
    for (int i = 0; i < 50; ++i) {
        REQUIRE(advance(*scene, path, v, scratch));
        REQUIRE_FALSE(test::deltaLobe(v, true).has_value());
        REQUIRE(scatter(v, *test::deltaLobe(v, false), Quantity::Radiance, path));
        REQUIRE(path.media.size() == 1);
    }
    CHECK(path.throughput.x == doctest::Approx(1));
}

TEST_CASE("a scene scaled and moved far away gives the same events at the same places") {
    constexpr int kPaths = 2000;
    constexpr size_t kLongest = 8;
    const Vec3 origin(0.1F, 1.1F, -0.2F);
    const auto scene = room().build();
    struct Case {
        float scale, move,
            same;  // share of paths whose events are all the same: coarse coordinates move hits over edges
    };
    for (const Case c : {Case{1e-2F, 0, 0.998F}, Case{1e3F, 0, 0.998F}, Case{1, 100, 0.975F}, Case{1e-2F, 100, 0.975F},
                         Case{1e3F, -100, 0.975F}}) {
        CAPTURE(c.scale);
        CAPTURE(c.move);
        SceneBuilder builder = room();
        const Vec3 move = 2 * c.move * c.scale * Vec3(1, -0.7F, 0.6F);  // times the room's size
        builder.transform(c.scale, move);
        const auto other = builder.build();
        test::Random random(3);
        int same = 0;
        for (int i = 0; i < kPaths; ++i) {
            const Vec3 direction = test::onSphere(random);
            const auto expected = walk(*scene, origin, direction, static_cast<uint64_t>(i), kLongest);
            const auto got = walk(*other, c.scale * origin + move, direction, static_cast<uint64_t>(i), kLongest);
            REQUIRE(expected.size() == kLongest);  // the room is closed
            CHECK(got.size() == kLongest);
            bool equal = got.size() == expected.size();
            for (size_t s = 0; equal && s < got.size(); ++s)
                equal = got[s].mesh == expected[s].mesh && got[s].event == expected[s].event &&
                        glm::length((got[s].position - move) / c.scale - expected[s].position) < 0.02F;
            same += equal ? 1 : 0;
        }
        CHECK(same >= c.same * kPaths);
    }
}

TEST_CASE("no ray meets the flat face that it leaves, of any size and tilt") {
    test::Random random(9);
    for (const float size : {1e-2F, 1.0F, 1e4F})
        for (int plane = 0; plane < 30; ++plane) {
            CAPTURE(size);
            const Frame f(test::onSphere(random));
            const Vec3 p = test::onSphere(random);  // near the origin, however large the plate
            const Vec3 middle = p + 0.4F * size * (random.uniform() * f.x + random.uniform() * f.y);
            SceneBuilder builder;
            builder.add(test::quad(middle - size * f.x - size * f.y, middle + size * f.x - size * f.y,
                                   middle + size * f.x + size * f.y, middle - size * f.x + size * f.y),
                        test::lambert(Rgb(0.5F)));
            const auto scene = builder.build();
            const float reach = std::min(size, 1.0F);
            for (int i = 0; i < 300; ++i) {
                WalkScratch scratch;
                Vertex v;
                PathState path = test::startAt(*scene, p + reach * (f.z + 0.2F * test::onSphere(random)),
                                               -f.z + 0.2F * test::onSphere(random));
                REQUIRE(advance(*scene, path, v, scratch));
                BsdfSample sample;
                REQUIRE(sampleBsdf(v.bsdf, v.wo, 0, random.uniform2D(), sample));
                REQUIRE(scatter(v, sample, Quantity::Power, path));
                REQUIRE(test::escapes(*scene, path));
            }
        }
}

TEST_CASE("no light leaks out of a closed solid: what starts within meets its surface, and within stays within") {
    for (const bool ball : {true, false}) {
        SceneBuilder builder;
        builder.add(ball ? test::sphere({0.3F, 0, 0}, 1, 3) : test::box({-1, -1, -1}, {1, 1.1F, 0.9F}),
                    test::glass(kIor));
        const auto scene = builder.build();
        test::Random random(4);
        WalkScratch scratch;
        int met = 0, within = 0, reflected = 0, lost = 0;
        constexpr int kRays = 100'000;
        for (int i = 0; i < kRays; ++i) {
            PathState path = test::startAt(*scene, 0.5F * test::onSphere(random), test::onSphere(random)), out = path;
            Vertex v;
            if (!advance(*scene, path, v, scratch)) continue;
            ++met;
            const auto refracted = test::deltaLobe(v, true);
            if (refracted && scatter(v, *refracted, Quantity::Power, out) &&
                (out.media.size() != 0 || !test::escapes(*scene, out)))
                ++lost;
            if (!scatter(v, *test::deltaLobe(v, false), Quantity::Power, path)) continue;
            ++reflected;
            if (advance(*scene, path, v, scratch) && v.medium == 1) ++within;
        }
        CHECK(met == kRays);
        CHECK(lost == 0);
        CHECK(within == reflected);
        CHECK(reflected >=
              0.99 * kRays);  // smooth normals turn a few through the ball's flat faces: those carry nothing
    }
}

TEST_CASE("shading normals correct power by Veach's factor, radiance not at all") {
    const Vec3 ns = glm::normalize(Vec3(0.3F, 1, -0.2F)), wo = glm::normalize(Vec3(-0.5F, 1, 0.4F));
    for (const Material& material : {test::lambert(Rgb(0.5F)), test::metal(0), test::metal(0.5F)}) {
        const auto scene = bentPlate(ns, material);
        const Vertex v = bentVertex(*scene, wo);
        for (const Vec2 u : {Vec2(0.3F, 0.2F), Vec2(0.55F, 0.45F), Vec2(0.6F, 0.7F)}) {
            BsdfSample sample;
            REQUIRE(sampleBsdf(v.bsdf, v.wo, 0.5F, u, sample));
            PathState power, radiance;
            REQUIRE(scatter(v, sample, Quantity::Power, power));
            REQUIRE(scatter(v, sample, Quantity::Radiance, radiance));
            const Vec3 wi = power.ray.direction;
            // |wo.Ns| |wi.Ng| / (|wo.Ng| |wi.Ns|): the light comes from wo (Veach 1997, eq. 5.19).
            const float factor = glm::dot(wo, ns) * wi.y / (wo.y * glm::dot(wi, ns));
            CHECK(power.throughput.x == doctest::Approx(sample.weight.x * factor));
            CHECK(radiance.throughput.x == doctest::Approx(sample.weight.x));
        }
    }
}

TEST_CASE("a direction on different sides of the geometric and the shading normal carries nothing") {
    const Vec3 ns = glm::normalize(Vec3(1, 1, 0));
    const auto scene = bentPlate(ns, test::metal(0));
    // The mirror swaps x and y: what comes from the left would go on below the plate.
    for (const float x : {-0.4F, 0.4F}) {
        const Vertex v = bentVertex(*scene, glm::normalize(Vec3(x, 1, 0.3F)));
        PathState path;
        CHECK(scatter(v, *test::deltaLobe(v, false), Quantity::Radiance, path) == (x > 0));
        CHECK(scatter(v, *test::deltaLobe(v, false), Quantity::Power, path) == (x > 0));
    }
    // Seen from behind the shading normal: no light either way.
    const Vertex behind = bentVertex(*scene, glm::normalize(Vec3(-1, 0.5F, 0)));
    CHECK(behind.wo.z < 0);
    PathState path;
    CHECK_FALSE(scatter(behind, *test::deltaLobe(behind, false), Quantity::Radiance, path));
}
