#include "base/ray.h"

#include <doctest/doctest.h>

#include "support/random.h"

using namespace lsde;

namespace {

using DVec3 = glm::dvec3;

// In a cube of edge 2 size around the origin.
Vec3 vectorIn(test::Random& random, float size) { return size * (2.0F * random.inCube() - 1.0F); }

// Signed distance from the plane through a, b, c, without the rounding of floats.
double planeDistance(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const DVec3 n = glm::normalize(glm::cross(DVec3(b) - DVec3(a), DVec3(c) - DVec3(a)));
    return glm::dot(DVec3(p) - DVec3(a), n);
}

}  // namespace

TEST_CASE("a point of a ray is its origin plus the distance along its direction") {
    const Ray ray{Vec3(1, 2, 3), Vec3(0, 0.6F, -0.8F), kInfinity};
    CHECK(ray.at(0) == Vec3(1, 2, 3));
    CHECK(ray.at(5).y == doctest::Approx(5));
    CHECK(ray.at(5).z == doctest::Approx(-1));
}

TEST_CASE("an origin moves to the side into which the ray leaves") {
    const Vec3 p(1, 2, 3), ng(0, 1, 0);
    CHECK(offsetOrigin(p, ng, Vec3(0, 1, 0), 0.5F) == Vec3(1, 2.5F, 3));
    CHECK(offsetOrigin(p, ng, glm::normalize(Vec3(1, -0.01F, 0)), 0.5F) == Vec3(1, 1.5F, 3));
}

TEST_CASE("an offset origin lies on the ray's side of its triangle, and near it, from 1 cm to 1 km") {
    test::Random random(9);
    for (const float size : {0.01F, 1.0F, 1000.0F})
        for (int i = 0; i < 50000; ++i) {
            const Vec3 centre = vectorIn(random, size);
            const float edge = size * std::pow(10.0F, random.between(-4, 0));
            const Vec3 a = centre + vectorIn(random, edge), b = centre + vectorIn(random, edge),
                       c = centre + vectorIn(random, edge);
            const Vec3 cross = glm::cross(b - a, c - a);
            // Slivers have no normal in single precision.
            if (glm::length(cross) < 0.01F * square(edge)) continue;
            const Vec3 ng = glm::normalize(cross);
            const float u = random.between(0, 1), v = random.between(0, 1 - u);
            const Vec3 p = (1 - u - v) * a + u * b + v * c;
            const Vec3 leaving = random.onSphere();
            const float epsilon = surfaceEpsilon(largestCoordinates(a, b, c), 0);
            const double distance = planeDistance(offsetOrigin(p, ng, leaving, epsilon), a, b, c);
            CAPTURE(size);
            CAPTURE(edge);
            REQUIRE((distance > 0) == (glm::dot(leaving, ng) >= 0));
            REQUIRE(std::fabs(distance) < 4e-6 * size);
        }
}

TEST_CASE("the offset grows with the triangle's largest coordinate, and with a long way to it") {
    CHECK(largestCoordinates(Vec3(1, -9, 0), Vec3(-3, 2, 0), Vec3(2, 2, -0.5F)) == Vec3(3, 9, 0.5F));
    CHECK(surfaceEpsilon(Vec3(1, 2, 4), 0) == surfaceEpsilon(Vec3(4, 0, 0), 1));
    CHECK(surfaceEpsilon(Vec3(8, 0, 0), 0) == doctest::Approx(2 * surfaceEpsilon(Vec3(4, 0, 0), 0)));
    CHECK(surfaceEpsilon(Vec3(1), 1000) > 10 * surfaceEpsilon(Vec3(1), 1));
    CHECK(surfaceEpsilon(Vec3(0), 1) > 0);
}
