#include "sampling/warp.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/chi_squared.h"
#include "support/random.h"

using namespace lsde;

namespace {

// The four corners, as near to 1 as a random number gets, and the centre.
constexpr Vec2 kExtremes[] = {
    {0, 0}, {0, kOneMinusEpsilon}, {kOneMinusEpsilon, 0}, {kOneMinusEpsilon, kOneMinusEpsilon}, {0.5F, 0.5F}};

// Density of visible normals, Heitz 2018, eq. 3, in double and by tangents, as the paper writes it.
struct VisibleNormals {
    double alphaX, alphaY;

    double lambda(Vec3 w) const {
        const double slope2 = (square(alphaX * w.x) + square(alphaY * w.y)) / square(static_cast<double>(w.z));
        return (std::sqrt(1 + slope2) - 1) / 2;
    }
    double pdf(Vec3 wo, Vec3 h) const {
        if (h.z <= 0) return 0;
        const double e = square(h.x / alphaX) + square(h.y / alphaY) + square(static_cast<double>(h.z));
        const double d = 1 / (std::numbers::pi * alphaX * alphaY * e * e);
        return std::max(0.0, static_cast<double>(glm::dot(wo, h))) * d / ((1 + lambda(wo)) * wo.z);
    }
};

Vec3 direction(float angleDeg, float azimuthDeg) {
    const float t = angleDeg * kPi / 180, p = azimuthDeg * kPi / 180;
    return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
}

}  // namespace

TEST_CASE("squares map to the unit disc evenly") {
    test::Random random(1);
    const auto result = test::chiSquaredOnSquare(
        {40, 40, 1, 400'000},
        [&]() -> std::optional<Vec2> {
            const Vec2 d = squareToDisk(random.uniform2D());
            const float phi = std::atan2(d.y, d.x) / (2 * kPi);
            return Vec2(glm::dot(d, d), phi < 0 ? phi + 1 : phi);
        },
        [](double, double) { return 1.0; });
    CHECK(result.accepted(1));
    for (const Vec2 u : kExtremes) CHECK(glm::length(squareToDisk(u)) <= 1 + 1e-6F);
    CHECK(squareToDisk({0.5F, 0.5F}) == Vec2(0));
}

TEST_CASE("the concentric map keeps neighbours together") {
    test::Random random(2);
    for (int i = 0; i < 10'000; ++i) {
        const Vec2 u = random.uniform2D() * 0.999F;
        const Vec2 step(0.001F, 0.0005F);
        CHECK(glm::length(squareToDisk(u + step) - squareToDisk(u)) < 0.004F);
    }
}

TEST_CASE("hemisphere and sphere have the densities they state") {
    constexpr int kTests = 2;
    test::Random random(3);
    const test::SquareGrid grid{40, 40, 2, 400'000};
    CHECK(test::chiSquaredOnSphere(
              grid, [&] { return std::optional(squareToCosineHemisphere(random.uniform2D())); },
              [](Vec3 v) { return cosineHemispherePdf(v.z); })
              .accepted(kTests));
    CHECK(test::chiSquaredOnSphere(
              grid, [&] { return std::optional(squareToCone(random.uniform2D(), 2)); }, [](Vec3) { return conePdf(2); })
              .accepted(kTests));
}

TEST_CASE("cones are filled evenly, even those far narrower than a float's step below 1") {
    test::Random random(4);
    for (const float oneMinusCosMax : {1.5F, 1.0F, 0.2F, 1e-6F, 1e-12F}) {
        const auto sample = [&]() -> std::optional<Vec2> {
            const Vec3 v = squareToCone(random.uniform2D(), oneMinusCosMax);
            REQUIRE(glm::length(v) == doctest::Approx(1).epsilon(1e-6));
            // 1 - cos from the sine where the cosine is too near to 1.
            const float sine2 = square(v.x) + square(v.y);
            const float oneMinusCos = v.z < 0.5F ? 1 - v.z : sine2 / (1 + std::sqrt(1 - sine2));
            return Vec2(oneMinusCos / oneMinusCosMax, std::atan2(v.y, v.x) / (2 * kPi) + 0.5F);
        };
        const auto result = test::chiSquaredOnSquare({30, 30, 1, 200'000}, sample, [](double, double) { return 1.0; });
        CAPTURE(oneMinusCosMax);
        CHECK(result.accepted(5));
        CHECK(conePdf(oneMinusCosMax) * 2 * kPi * oneMinusCosMax == doctest::Approx(1));
    }
}

TEST_CASE("squares map to a triangle evenly, and stay within it") {
    test::Random random(5);
    // (b1 + b2)^2 and b2 / (b1 + b2) unfold the triangle to a square.
    const auto result = test::chiSquaredOnSquare(
        {40, 40, 1, 400'000},
        [&]() -> std::optional<Vec2> {
            const Vec2 b = squareToTriangle(random.uniform2D());
            const float sum = b.x + b.y;
            REQUIRE(b.x >= 0);
            REQUIRE(b.y >= 0);
            REQUIRE(sum <= 1);
            return Vec2(sum * sum, sum > 0 ? b.y / sum : 0);
        },
        [](double, double) { return 1.0; });
    CHECK(result.accepted(1));
    for (const Vec2 u : kExtremes) {
        const Vec2 b = squareToTriangle(u);
        CHECK(b.x + b.y <= 1);
    }
}

TEST_CASE("normals are drawn by their visibility from wo, isotropic or not") {
    const VisibleNormals surfaces[] = {{1, 1}, {0.5, 0.5}, {0.25, 0.25}, {0.6, 0.2}};
    const Vec3 directions[] = {{0, 0, 1}, direction(40, 20), direction(75, 200), direction(88, 130)};
    test::Random random(6);
    for (const VisibleNormals& surface : surfaces)
        for (const Vec3 wo : directions) {
            const auto x = static_cast<float>(surface.alphaX), y = static_cast<float>(surface.alphaY);
            const auto result = test::chiSquaredOnSphere(
                {40, 40, 4, 200'000},
                [&] { return std::optional(sampleGgxVisibleNormal(wo, x, y, random.uniform2D())); },
                [&](Vec3 h) { return surface.pdf(wo, h); });
            CAPTURE(x);
            CAPTURE(wo.z);
            CAPTURE(result.p);
            CHECK(result.accepted(16));
        }
}

TEST_CASE("on a nearly smooth surface half of the normals lie within slope alpha") {
    // From above, slope^2 / alpha^2 = t has the distribution t / (1 + t).
    test::Random random(7);
    for (const float alpha : {1e-3F, 1e-6F, 1e-10F}) {
        int within = 0;
        constexpr int kSamples = 100'000;
        for (int i = 0; i < kSamples; ++i) {
            const Vec3 h = sampleGgxVisibleNormal({0, 0, 1}, alpha, alpha, random.uniform2D());
            within += std::hypot(h.x, h.y) / h.z < alpha ? 1 : 0;
        }
        CHECK(within == doctest::Approx(0.5 * kSamples).epsilon(0.013));  // 4 sigma
    }
}

TEST_CASE("visible normals are unit vectors of the upper side, at grazing angles and corners of the square too") {
    for (const float alpha : {1e-10F, 1e-6F, 1e-3F, 0.3F, 1.0F})
        for (const float angle : {0.0F, 1e-6F, 1e-3F, 45.0F, 89.9F, 89.99999F})
            for (const Vec2 u : kExtremes) {
                Vec3 wo = direction(angle, 30);
                wo.z = std::max(wo.z, 1e-30F);
                const Vec3 h = sampleGgxVisibleNormal(wo, alpha, alpha, u);
                CAPTURE(alpha);
                CAPTURE(angle);
                CHECK(h.z >= 0);
                CHECK(glm::length(h) == doctest::Approx(1).epsilon(1e-5));
            }
}

TEST_CASE("points of the square are found again from where they are mapped to") {
    test::Random random(11);
    const auto near = [](Vec2 a, Vec2 b, float tolerance) {
        // The turn about an axis has no beginning.
        const float turn = std::fabs(a.y - b.y);
        return std::fabs(a.x - b.x) < tolerance && std::min(turn, 1 - turn) < tolerance;
    };
    for (int i = 0; i < 10'000; ++i) {
        const Vec2 u = 0.0005F + 0.999F * random.uniform2D();
        CAPTURE(u.x);
        CAPTURE(u.y);
        CHECK(near(diskToSquare(squareToDisk(u)), u, 1e-5F));
        CHECK(near(cosineHemisphereToSquare(squareToCosineHemisphere(u)), u, 1e-5F));
        for (const float oneMinusCos : {2.0F, 0.3F, 1e-4F})
            CHECK(near(coneToSquare(squareToCone(u, oneMinusCos), oneMinusCos), u, 3e-3F));
    }
    for (const Vec2 u : kExtremes) {
        const Vec2 back = diskToSquare(squareToDisk(u));
        CHECK(near(back, u, 1e-5F));
        CHECK(std::max(back.x, back.y) < 1);
    }
}
