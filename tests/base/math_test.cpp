#include "base/math.h"

#include <doctest/doctest.h>

#include <random>
#include <vector>

using namespace lsde;

namespace {

// Unit vectors all over the sphere, and those where frames are known to break: the poles and their surroundings.
std::vector<Vec3> normals() {
    std::vector<Vec3> out{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {1, 0, -0.0F}};
    for (const float z : {1.0F, -1.0F})
        for (const float tilt : {1e-7F, 1e-5F, 1e-3F, 1e-2F}) {
            out.push_back(glm::normalize(Vec3(tilt, 0, z)));
            out.push_back(glm::normalize(Vec3(-tilt, tilt, z)));
        }
    std::mt19937_64 random(2);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 10000; ++i) out.push_back(glm::normalize(Vec3(normal(random), normal(random), normal(random))));
    return out;
}

// A few roundings of unit vectors.
constexpr float kTolerance = 1e-6F;

}  // namespace

TEST_CASE("a frame is orthonormal and right-handed about every normal") {
    for (const Vec3 n : normals()) {
        CAPTURE(n.x);
        CAPTURE(n.y);
        CAPTURE(n.z);
        const Frame f(n);
        REQUIRE(f.z == n);
        REQUIRE(std::fabs(glm::length(f.x) - 1) < kTolerance);
        REQUIRE(std::fabs(glm::length(f.y) - 1) < kTolerance);
        REQUIRE(std::fabs(glm::dot(f.x, f.y)) < kTolerance);
        REQUIRE(std::fabs(glm::dot(f.x, f.z)) < kTolerance);
        REQUIRE(std::fabs(glm::dot(f.y, f.z)) < kTolerance);
        REQUIRE(glm::length(glm::cross(f.x, f.y) - f.z) < 2 * kTolerance);
    }
}

TEST_CASE("to a frame and back is where one was, and the normal is the frame's z axis") {
    for (const Vec3 n : normals()) {
        const Frame f(n);
        const Vec3 v(0.3F, -2, 1.5F);
        REQUIRE(glm::length(f.toWorld(f.toLocal(v)) - v) < 4 * kTolerance);
        REQUIRE(glm::length(f.toLocal(f.toWorld(v)) - v) < 4 * kTolerance);
        REQUIRE(glm::length(f.toLocal(n) - Vec3(0, 0, 1)) < 2 * kTolerance);
    }
}

TEST_CASE("small helpers mean what they say") {
    CHECK(safeSqrt(-1e-9F) == 0);
    CHECK(safeSqrt(4) == 2);
    CHECK(maxComponent(Vec3(-3, -1, -2)) == -1);
    CHECK(lengthSquared(Vec3(1, 2, 3)) == 14);
    CHECK(luminance(Rgb(1)) == doctest::Approx(1));
    CHECK(isBlack(Rgb(0, -0.0F, 0)));
    CHECK(!isBlack(Rgb(0, 0, 1e-30F)));
    CHECK(isFinite(Vec3(1)));
    CHECK(!isFinite(Vec3(0, kInfinity, 0)));
    CHECK(!isFinite(Vec3(0, 0, std::numeric_limits<float>::quiet_NaN())));
    CHECK(square(-3) == 9);
}

TEST_CASE("an octave goes from a power of two to below the next") {
    CHECK(octaveOf(0) == 0);
    CHECK(octaveOf(0x1.fffffep-1F) == 0);
    for (int l = 1; l <= 127; ++l) {
        const float first = std::ldexp(1.0F, l - 1);
        REQUIRE(octaveOf(first) == l);
        REQUIRE(octaveOf(std::nextafter(2 * first, 0.0F)) == l);
    }
    CHECK(octaveOf(kInfinity) > 127);
}
