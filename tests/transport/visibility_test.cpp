// Shadow rays, and straight passages of smooth thin walls, by shadow rays and by the walk alike.
#include <doctest/doctest.h>

#include "bsdf/fresnel.h"
#include "support/scenes.h"
#include "transport/walking.h"

using namespace lsde;
using test::SceneBuilder;

namespace {

// The point of the floor (y = 0) below `above`.
Vertex floorVertex(const Scene& scene, Vec3 above) {
    PathState path = test::startAt(scene, above, {0, -1, 0});
    WalkScratch scratch;
    Vertex v;
    REQUIRE(advance(scene, path, v, scratch));
    return v;
}

void addFloor(SceneBuilder& scene) { scene.add(test::plate({0, 0, 0}, 20), test::lambert(Rgb(0.5F))); }

const Rgb kTint(0.8F, 0.9F, 0.4F);

}  // namespace

TEST_CASE("thin walls tint shadow rays and are counted, as the walk that passes them straight is tinted") {
    SceneBuilder builder;
    addFloor(builder);
    builder.add(test::plate({0, 1, 0}, 9), test::thinWall(kTint));
    builder.add(test::plate({0, 1.5F, 0}, 9, false), test::thinWall(kTint, 1.3F));
    const auto scene = builder.build();
    const Vertex v = floorVertex(*scene, {0.1F, 0.5F, 0.2F});
    const Vec3 direction = glm::normalize(Vec3(0.4F, 1, 0.3F));
    WalkScratch scratch;
    const Visibility seen = visibility(*scene, v, direction, kInfinity, scratch);
    CHECK(seen.straightPassages == 2);
    for (const Quantity quantity : {Quantity::Radiance, Quantity::Power}) {
        PathState path{{v.surface.position + 1e-4F * direction, direction, kInfinity}, {}, Rgb(1)};
        for (int wall = 0; wall < 2; ++wall) {
            const Vertex passed = test::pass(*scene, path, quantity);
            CHECK(test::deltaLobe(passed, true)->straight);
            CHECK(path.ray.direction.x == doctest::Approx(direction.x));
            CHECK(path.media.size() == 0);
        }
        CHECK(test::escapes(*scene, path));
        for (int c = 0; c < 3; ++c) CHECK(seen.transmittance[c] == doctest::Approx(path.throughput[c]));
    }
    // Only those before the end count.
    const Visibility nearer = visibility(*scene, v, direction, 1.2F / direction.y, scratch);
    CHECK(nearer.straightPassages == 1);
    const float f = fresnelDielectric(direction.y, 1.5F).reflectance;
    CHECK(nearer.transmittance.x == doctest::Approx((1 - f) * kTint.x));
    CHECK(visibility(*scene, v, direction, 0.9F / direction.y, scratch).transmittance == Rgb(1));
}

TEST_CASE("what is behind a thin wall hides the light, and so does a wall of glass") {
    for (const bool solid : {false, true}) {
        SceneBuilder builder;
        addFloor(builder);
        builder.add(test::plate({0, 1, 0}, 9), test::thinWall(kTint));
        if (solid)
            builder.add(test::box({-1, 1.5F, -1}, {1, 1.6F, 1}), test::glass(1.5F));
        else
            builder.add(test::plate({0, 1.5F, 0}, 1), test::lambert(Rgb(0.5F)));
        const auto scene = builder.build();
        const Vertex v = floorVertex(*scene, {0.1F, 0.5F, 0.2F});
        WalkScratch scratch;
        CHECK(visibility(*scene, v, {0, 1, 0}, kInfinity, scratch).transmittance == Rgb(0));
        CHECK(visibility(*scene, v, {0, 1, 0}, 1.6F, scratch).transmittance == Rgb(0));
        CHECK(visibility(*scene, v, {0, 1, 0}, 1.4F, scratch).transmittance != Rgb(0));
    }
}

TEST_CASE("a bent normal stops straight passages by shadow ray and by walk at the same angles") {
    SceneBuilder builder;
    addFloor(builder);
    Mesh wall = test::plate({0, 1, 0}, 9);
    wall.normals.assign(4, glm::normalize(Vec3(1, 1, 0)));
    builder.add(wall, test::thinWall(kTint));
    const auto scene = builder.build();
    const Vertex v = floorVertex(*scene, {0, 0.5F, 0});
    WalkScratch scratch;
    for (const float x : {-2.0F, -1.1F, -0.9F, 0.5F, 2.0F}) {
        CAPTURE(x);
        const Vec3 direction = glm::normalize(Vec3(x, 1, 0));
        PathState path{{v.surface.position + 1e-4F * direction, direction, kInfinity}, {}, Rgb(1)};
        Vertex met;
        REQUIRE(advance(*scene, path, met, scratch));
        const auto lobe = test::deltaLobe(met, true);
        const bool passes = lobe && scatter(met, *lobe, Quantity::Radiance, path);
        CHECK(passes == (x > -1));
        const Rgb seen = visibility(*scene, v, direction, kInfinity, scratch).transmittance;
        CHECK(seen.x == doctest::Approx(passes ? path.throughput.x : 0));
    }
}

TEST_CASE("nothing lies between two points of a plane's open side, however near or grazing") {
    for (const float scale : {1e-2F, 1.0F, 1e3F})
        for (const float move : {0.0F, 100.0F}) {
            SceneBuilder builder;
            addFloor(builder);
            builder.transform(scale, scale * Vec3(move, -move, 0.7F * move));
            const auto scene = builder.build();
            const Vec3 origin = scale * Vec3(move, -move, 0.7F * move);
            const Vertex v = floorVertex(*scene, origin + scale * Vec3(0.3F, 1, 0.2F));
            WalkScratch scratch;
            for (const float distance : {1e-3F, 1.0F, 1e4F})
                for (const float height : {1e-3F, 0.1F, 1.0F}) {
                    const Vec3 d = glm::normalize(Vec3(1, height, 0.3F));
                    if (scale * distance * d.y < 2 * v.surface.epsilon) continue;  // ends on the plane
                    CHECK(visibility(*scene, v, d, scale * distance, scratch).transmittance == Rgb(1));
                    CHECK(visibility(*scene, v, -d, scale * distance, scratch).transmittance ==
                          Rgb(1));  // below is open too
                }
        }
}
