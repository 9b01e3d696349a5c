#include "photon/surface_extent.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "photon/kernel.h"
#include "support/random.h"

using namespace lsde;

namespace {

// The rim of a square [0, 10]^2 in the plane z = 0.
const std::vector<Segment> kSquare = {
    {{0, 0, 0}, {10, 0, 0}}, {{10, 0, 0}, {10, 10, 0}}, {{10, 10, 0}, {0, 10, 0}}, {{0, 10, 0}, {0, 0, 0}}};

SurfaceAround around(Vec3 p, float radius) {
    SurfaceAround out;
    SurfaceExtent(kSquare).around(p, {0, 0, 1}, radius, out);
    return out;
}

double shareAt(Vec3 p, float radius) { return static_cast<double>(around(p, radius).share(radius)); }

// The kernel's mass on the side x < distance (in radii) of a straight edge.
double massBeside(double distance) {
    double mass = 0;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const double x = 2 * (i + 0.5) / kSteps - 1, y = 2 * (j + 0.5) / kSteps - 1;
            if (x < distance && x * x + y * y < 1)
                mass += 4.0 / kSteps / kSteps * 2 / 3.14159265358979 * (1 - x * x - y * y);
        }
    return mass;
}

Vec3 within(float size, test::Random& random) { return size * (random.inCube() - 0.5F); }

// Short ones and some long ones.
std::vector<Segment> thousands(test::Random& random) {
    std::vector<Segment> creases;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 a = within(10, random);
        creases.push_back({a, a + within(i % 10 == 0 ? 5.0F : 0.3F, random)});
    }
    return creases;
}

}  // namespace

TEST_CASE("all of the kernel lies on a surface that ends beyond the radius") {
    CHECK(shareAt({5, 5, 0}, 1) == 1);
    CHECK(shareAt({5, 0.51F, 0}, 0.5F) == 1);
    SurfaceAround out;
    SurfaceExtent().around({0, 0, 0}, {0, 0, 1}, 1, out);
    CHECK(out.share(1) == 1);
}

TEST_CASE("half the kernel lies on a surface at its edge, a quarter at its corner") {
    CHECK(shareAt({5, 1e-4F, 0}, 0.5F) == doctest::Approx(0.5).epsilon(0.01));
    CHECK(shareAt({1e-4F, 1e-4F, 0}, 0.5F) == doctest::Approx(0.25).epsilon(0.01));
}

TEST_CASE("beside a straight edge the share is the kernel's integral") {
    for (const float distance : {0.1F, 0.3F, 0.6F, 0.9F})
        CHECK(shareAt({5, distance, 0}, 1) == doctest::Approx(massBeside(static_cast<double>(distance))).epsilon(0.01));
}

TEST_CASE("beside a straight edge the share of the area is the disc's less a segment of it") {
    for (const double distance : {0.1, 0.3, 0.6, 0.9}) {
        const double beyond = std::acos(distance) - distance * std::sqrt(1 - distance * distance);
        const SurfaceAround surface = around({5, static_cast<float>(distance), 0}, 1);
        CHECK(static_cast<double>(surface.areaShare(1)) == doctest::Approx(1 - beyond * 0.318309886).epsilon(0.015));
    }
    CHECK(around({5, 0.51F, 0}, 0.5F).areaShare(0.5F) == 1);
}

TEST_CASE("an edge above the plane's thickness does not end the surface") {
    CHECK(shareAt({5, 0.1F, -0.9F * kPlaneThickness}, 1) < 1);
    CHECK(shareAt({5, 0.1F, -1.1F * kPlaneThickness}, 1) == 1);
}

TEST_CASE("a photon behind a crease is hidden, one before it or beside it is not") {
    const SurfaceAround surface = around({5, 0.2F, 0}, 0.5F);
    REQUIRE(!surface.whole());
    CHECK(surface.hides({5, -0.1F, 0}));
    CHECK(surface.hides({5.3F, -0.1F, 0}));
    CHECK(!surface.hides({5, 0.1F, 0}));
    CHECK(!surface.hides({5.3F, 0.01F, 0}));
    const std::vector<Segment> wall = {{{0, 0, 0}, {1, 0, 0}}};
    SurfaceAround beside;
    SurfaceExtent(wall).around({1.1F, 0.1F, 0}, {0, 0, 1}, 0.5F, beside);
    CHECK(!beside.hides({1.2F, -0.1F, 0}));
    CHECK(beside.hides({0.8F, -0.1F, 0}));
}

TEST_CASE("a crease is near what lies within the distance of it") {
    const SurfaceAround surface = around({5, 0.2F, 0}, 0.5F);
    CHECK(surface.creaseNear({5, 0.1F, 0}, 0.11F));
    CHECK(!surface.creaseNear({5, 0.1F, 0}, 0.09F));
    CHECK(surface.creaseNear({5, -0.1F, 0}, 0.11F));
    CHECK(!surface.creaseNear({5, -0.1F, 0}, 0.09F));
    CHECK(!surface.creaseNear({5.2F, 0.3F, 0}, 0.2F));
    CHECK(!around({5, 5, 0}, 0.5F).creaseNear({5, 5.1F, 0}, 0.1F));
}

TEST_CASE("among thousands of creases those that cut the disc are found, and they alone") {
    test::Random random(21);
    const std::vector<Segment> creases = thousands(random);
    const SurfaceExtent extent(creases);
    int cut = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 centre = within(12, random), normal = glm::normalize(within(1, random));
        const float radius = 0.05F + random.uniform();
        SurfaceAround all;
        extent.around(centre, normal, radius, all);
        bool whole = true;
        float least = 1;
        for (const Segment& crease : creases) {
            SurfaceAround one;
            SurfaceExtent(std::span(&crease, 1)).around(centre, normal, radius, one);
            whole &= one.whole();
            least = std::min(least, one.share(radius));
        }
        CHECK(all.whole() == whole);
        CHECK(all.share(radius) <= least);
        cut += all.whole() ? 0 : 1;
    }
    CHECK(cut > 50);
    CHECK(cut < 250);
}

TEST_CASE("a crease separates two points if it hides one from the other") {
    test::Random random(22);
    const std::vector<Segment> creases = thousands(random);
    const SurfaceExtent extent(creases);
    int separated = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 centre = within(9, random), normal = glm::normalize(within(1, random));
        const Vec3 p = centre + within(2, random);
        const float radius = (1 + random.uniform()) * glm::length(p - centre);
        SurfaceAround surface;
        extent.around(centre, normal, radius, surface);
        const bool hidden = surface.hides(p);
        CHECK(extent.separates(centre, normal, p, radius) == hidden);
        separated += hidden ? 1 : 0;
    }
    CHECK(separated > 300);
    CHECK(separated < 2700);
    CHECK(!extent.separates({1, 2, 3}, {0, 0, 1}, {1, 2, 3}, 1));
    CHECK(!SurfaceExtent().separates({1, 2, 3}, {0, 0, 1}, {1, 3, 3}, 1));
}

TEST_CASE("the clearance is the distance of the nearest crease") {
    test::Random random(23);
    const std::vector<Segment> creases = thousands(random);
    const SurfaceExtent extent(creases);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p = within(12, random);
        float nearest = kInfinity;
        for (const Segment& s : creases) {
            const Vec3 along = s.b - s.a;
            const float t = std::clamp(glm::dot(p - s.a, along) / glm::dot(along, along), 0.0F, 1.0F);
            nearest = std::min(nearest, glm::length(s.a + t * along - p));
        }
        CHECK(extent.clearance(p) == doctest::Approx(nearest).epsilon(1e-4));
    }
    CHECK(SurfaceExtent().clearance({1, 2, 3}) == kInfinity);
}
