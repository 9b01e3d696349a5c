#include "sampling/spherical_triangle.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/chi_squared.h"
#include "support/random.h"
#include "support/statistics.h"

using namespace lsde;

namespace {

struct Corners {
    Vec3 a, b, c;
};

Vec3 randomUnit(test::Random& random) {
    const float z = 2 * random.uniform() - 1, phi = 2 * kPi * random.uniform(), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// Weights of b and c where the direction from the origin meets the triangle's plane, in double.
glm::dvec2 barycentric(const Corners& t, Vec3 direction) {
    const glm::dvec3 a(t.a), ab = glm::dvec3(t.b) - a, ac = glm::dvec3(t.c) - a, n = glm::cross(ab, ac);
    const glm::dvec3 p = glm::dvec3(direction) * (glm::dot(n, a) / glm::dot(n, glm::dvec3(direction))) - a;
    return {glm::dot(glm::cross(p, ac), n) / glm::dot(n, n), glm::dot(glm::cross(ab, p), n) / glm::dot(n, n)};
}

}  // namespace

TEST_CASE("an octant's solid angle is half pi, and that of what is small its area seen over its distance squared") {
    const auto octant = SphericalTriangle::seen({2, 0, 0}, {0, 3, 0}, {0, 0, 0.1F});
    REQUIRE(octant);
    CHECK(octant->solidAngle() == doctest::Approx(kPi / 2));
    const auto small = SphericalTriangle::seen({0, 0, 10}, {0.5F, 0, 10}, {0, 0.5F, 10});
    REQUIRE(small);
    CHECK(small->solidAngle() == doctest::Approx(0.125 / 100).epsilon(2e-3));
}

TEST_CASE("triangles too small or too close for it, or seen edge on, are left to sampling by area") {
    CHECK(!SphericalTriangle::seen({0, 0, 100}, {0.5F, 0, 100}, {0, 0.5F, 100}));
    CHECK(!SphericalTriangle::seen({-1, -1, 1e-4F}, {2, -1, 1e-4F}, {-1, 2, 1e-4F}));
    CHECK(!SphericalTriangle::seen({1, 0, 0}, {2, 0, 0}, {2, 1, 0}));
    CHECK(!SphericalTriangle::seen({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
}

TEST_CASE("directions towards a triangle are spread evenly by solid angle") {
    // Wide and flat, obtuse, small, and all around the point.
    const Corners triangles[] = {{{-3, -1, 1}, {4, -1, 1}, {0, 2, 1}},
                                 {{0, 0, 1}, {5, 0.2F, 1}, {-3, 1, 0.5F}},
                                 {{0.2F, 0.1F, 20}, {0.9F, 0, 20}, {0, 0.9F, 20}},
                                 {{-1, -1, 0.2F}, {2, -1, 0.2F}, {-1, 2, 0.2F}}};
    for (const Corners& t : triangles) {
        const auto seen = SphericalTriangle::seen(t.a, t.b, t.c);
        REQUIRE(seen);
        const glm::dvec3 a(t.a), ab = glm::dvec3(t.b) - a, ac = glm::dvec3(t.c) - a;
        const double height = glm::dot(glm::cross(ab, ac), a);  // twice the area times the plane's distance
        test::Random random(1);
        const auto result = test::chiSquaredOnSquare(
            {16, 16, 32, 200'000},
            [&] { return std::optional(Vec2(barycentric(t, seen->sample(random.uniform2D())))); },
            [&](double u, double v) {
                // dOmega = height / d^3 du dv
                const double d = glm::length(a + u * ab + v * ac);
                return u + v < 1 ? std::fabs(height) / (d * d * d) / static_cast<double>(seen->solidAngle()) : 0.0;
            });
        CHECK(result.accepted(4));
    }
}

TEST_CASE("no sampled direction misses its triangle by more than rounding") {
    test::Random random(2);
    for (int i = 0; i < 20'000; ++i) {
        // Of all shapes, slivers and the smallest among them.
        const Vec3 centre = randomUnit(random);
        const float size = std::pow(10.0F, 2 * random.uniform() - 1.5F);
        const Corners t{centre + size * randomUnit(random), centre + size * randomUnit(random),
                        centre + size * random.uniform() * randomUnit(random)};
        const auto seen = SphericalTriangle::seen(t.a, t.b, t.c);
        if (!seen) continue;
        Vec2 u = random.uniform2D();
        if (i % 8 == 0) u = {i % 16 == 0 ? 0 : kOneMinusEpsilon, i % 32 < 16 ? 0 : kOneMinusEpsilon};
        const Vec3 direction = seen->sample(u);
        CHECK(std::fabs(glm::length(direction) - 1) < 1e-5F);
        // Beyond each side's plane by at most this angle.
        const Vec3 corners[] = {glm::normalize(t.a), glm::normalize(t.b), glm::normalize(t.c)};
        const float handed = glm::dot(glm::cross(corners[0], corners[1]), corners[2]) > 0 ? 1.0F : -1.0F;
        for (size_t k = 0; k < 3; ++k) {
            const Vec3 side = glm::cross(corners[k], corners[(k + 1) % 3]);
            CHECK(handed * glm::dot(glm::normalize(side), direction) > -2e-4F);
        }
    }
}
