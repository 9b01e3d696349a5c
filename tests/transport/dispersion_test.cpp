// Paths of one wavelength through media whose refractive index varies with it.
#include <doctest/doctest.h>

#include <cmath>

#include "bsdf/cauchy.h"
#include "support/scenes.h"
#include "transport/walking.h"

using namespace lsde;
using test::SceneBuilder;

namespace {

constexpr double kDegrees = 3.14159265358979 / 180;

Material flint(float dispersion = 20 / 25.68F) {
    Material m = test::glass(1.7847F);
    m.dispersion = dispersion;
    return m;
}

// Closest to a wavelength in nm.
WavelengthId wavelengthAt(float nm) {
    WavelengthId n = 1;
    while (n < kWavelengths && wavelengthNm(n) < nm) ++n;
    return n;
}

PathState startAt(const Scene& scene, Vec3 origin, Vec3 direction, WavelengthId reserved) {
    PathState path = test::startAt(scene, origin, direction);
    path.reserved = reserved;
    return path;
}

// A prism along z with an apex of 60 degrees at the top, its base of length 1 on y = 0.
Mesh prism() {
    const float top = std::sqrt(0.75F);
    const Vec3 a(-0.5F, 0, 1), b(0.5F, 0, 1), c(0, top, 1), back(0, 0, -2);
    Mesh m = test::polygonFan({a, b, c});
    test::append(m, test::polygonFan({a + back, c + back, b + back}));
    test::append(m, test::quad(a, a + back, b + back, b));
    test::append(m, test::quad(b, b + back, c + back, c));
    test::append(m, test::quad(c, c + back, a + back, a));
    return m;
}

// Angle (degrees) by which the prism turns a ray that comes to the middle of its left face at `incidence` degrees.
double deviation(const Scene& scene, double incidence, WavelengthId wavelength) {
    // The left face's normal points to the left and up by 30 degrees; the ray comes from below it.
    const double angle = (180 - 30 + incidence) * kDegrees;
    const Vec3 from(std::cos(angle), std::sin(angle), 0);
    PathState path = startAt(scene, Vec3(-0.25F, std::sqrt(0.75F) / 2, 0) + from, -from, wavelength);
    test::pass(scene, path);
    CHECK(path.wavelength == wavelength);
    test::pass(scene, path);
    CHECK(path.media.size() == 0);
    return std::acos(std::clamp(static_cast<double>(glm::dot(path.ray.direction, -from)), -1.0, 1.0)) / kDegrees;
}

}  // namespace

TEST_CASE("Cauchy's index has the index of the d line and the Abbe number that it is made from") {
    for (const float abbe : {25.68F, 36.37F, 55.3F, 64.17F})
        for (const float ior : {1.333F, 1.5168F, 2.417F}) {
            const float dispersion = 20 / abbe;
            // Fraunhofer's d, F and C.
            const float d = cauchyIor(ior, dispersion, 587.56F), f = cauchyIor(ior, dispersion, 486.13F),
                        c = cauchyIor(ior, dispersion, 656.27F);
            CHECK(d == doctest::Approx(ior).epsilon(1e-5));
            CHECK((d - 1) / (f - c) == doctest::Approx(abbe).epsilon(1e-3));
        }
    CHECK(cauchyIor(1.5F, 0, 400) == 1.5F);
    CHECK(cauchyIor(1.1F, 200, 780) == 1);  // an index below 1 has no place here
}

TEST_CASE("a prism's least deviation of each wavelength is Snell's") {
    SceneBuilder builder;
    builder.add(prism(), flint());
    const auto scene = builder.build();
    CHECK(scene->disperses());
    double last = 180;
    for (const float nm : {400.0F, 450.0F, 500.0F, 550.0F, 600.0F, 650.0F, 700.0F}) {
        CAPTURE(nm);
        const WavelengthId wavelength = wavelengthAt(nm);
        const double n =
            1.7847 + 0.7847 / 25.68 * (523655 / square(static_cast<double>(wavelengthNm(wavelength))) - 1.5168);
        const double least = 2 * std::asin(n * std::sin(30 * kDegrees)) / kDegrees - 60;
        const double incidence = std::asin(n * std::sin(30 * kDegrees)) / kDegrees;
        CHECK(deviation(*scene, incidence, wavelength) == doctest::Approx(least).epsilon(2e-5));
        for (const double aside : {-3.0, 3.0}) CHECK(deviation(*scene, incidence + aside, wavelength) > least + 0.02);
        CHECK(least < last - 0.3);
        last = least;
    }
}

TEST_CASE("between two media each has its own index, and where both are the same nothing is reflected") {
    SceneBuilder builder;
    Material crown = test::glass(1.5168F);
    crown.dispersion = 20 / 64.17F;
    builder.add(test::box({0, -9, -9}, {1, 9, 9}), flint());
    builder.add(test::box({1, -9, -9}, {2, 9, 9}), crown);
    builder.add(test::box({2, -9, -9}, {3, 9, 9}), crown);
    const auto scene = builder.build();
    for (const float nm : {420.0F, 650.0F}) {
        const WavelengthId wavelength = wavelengthAt(nm);
        const float at = wavelengthNm(wavelength);
        const float first = cauchyIor(1.7847F, 20 / 25.68F, at), second = cauchyIor(1.5168F, 20 / 64.17F, at);
        PathState path = startAt(*scene, {-1, 0.1F, 0.2F}, {1, 0.1F, 0.05F}, wavelength);
        CHECK(std::get<DielectricBsdf>(test::pass(*scene, path).bsdf).eta == doctest::Approx(first));
        CHECK(test::deltaLobe(test::pass(*scene, path), true)->eta == doctest::Approx(second / first));
        const Vertex same = test::pass(*scene, path);
        CHECK(isBlack(test::deltaLobe(same, false)->weight));
    }
}

TEST_CASE("total reflection sets in at each wavelength's own angle") {
    SceneBuilder builder;
    builder.add(test::box({-1, -1, -1}, {1, 1, 1}), flint());
    const auto scene = builder.build();
    WalkScratch scratch;
    // Between the critical angles of violet (1 / 1.835) and red (1 / 1.772).
    const float sine = 1 / 1.8F;
    for (const float nm : {410.0F, 690.0F}) {
        PathState path = startAt(*scene, {0, 0, 0}, {sine, safeSqrt(1 - sine * sine), 0}, wavelengthAt(nm));
        Vertex v;
        REQUIRE(advance(*scene, path, v, scratch));
        CHECK(test::deltaLobe(v, true).has_value() == (nm > 600));
    }
}

TEST_CASE("a path has its wavelength from the first surface on that disperses, reflected or refracted") {
    SceneBuilder builder;
    builder.add(test::quad({-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}), test::metal(0));
    builder.add(test::box({-1, 3, -1}, {1, 4, 1}), test::glass(1.5F));
    builder.add(test::box({-1, 5, -1}, {1, 6, 1}), flint());
    const auto scene = builder.build();
    const WavelengthId reserved = wavelengthAt(610);
    for (const bool transmitted : {false, true}) {
        PathState path = startAt(*scene, {0.1F, 2, 0.1F}, {0, -1, 0}, reserved);
        WalkScratch scratch;
        Vertex v;
        REQUIRE(advance(*scene, path, v, scratch));
        REQUIRE(scatter(v, *test::deltaLobe(v, false), Quantity::Power, path));
        test::pass(*scene, path, Quantity::Power);
        test::pass(*scene, path, Quantity::Power);
        CHECK(path.wavelength == kAllWavelengths);
        CHECK(path.rgb() == path.throughput);
        REQUIRE(advance(*scene, path, v, scratch));
        REQUIRE(scatter(v, *test::deltaLobe(v, transmitted), Quantity::Power, path));
        CHECK(path.wavelength == reserved);
        CHECK(path.rgb() == path.throughput * wavelengthWeight(reserved));
    }
}

TEST_CASE("a wavelength is drawn only where something disperses") {
    for (const Material& material : {flint(0), flint(), test::lambert(Rgb(1))}) {
        SceneBuilder builder;
        builder.add(prism(), material);
        const auto scene = builder.build();
        CHECK(scene->disperses() == (material.dispersion > 0));
        const WavelengthId drawn = reserveWavelength(*scene, Sampler::sequence(1, Stage::Test, 5));
        CHECK((drawn != kAllWavelengths) == (material.dispersion > 0));
    }
    // An index of 1, and glTF's infinite one, are those of all wavelengths.
    for (const float ior : {0.0F, 1.0F}) {
        Material m = flint();
        m.ior = ior;
        SceneBuilder builder;
        builder.add(prism(), m);
        CHECK(!builder.build()->disperses());
    }
}

TEST_CASE("what a rough surface that disperses sends to a lamp or takes from a photon has the path's wavelength") {
    SceneBuilder builder;
    Material rough = flint();
    rough.roughness = 0.3F;
    builder.add(test::box({-1, 3, -1}, {1, 4, 1}), rough);
    const auto scene = builder.build();
    const WavelengthId reserved = wavelengthAt(610);
    PathState path = startAt(*scene, {0.1F, 2, 0.1F}, {0, 1, 0}, reserved);
    WalkScratch scratch;
    Vertex v;
    REQUIRE(advance(*scene, path, v, scratch));
    CHECK(path.rgb() == Rgb(1));
    CHECK(path.wavelengthAt(v) == reserved);
    CHECK(path.rgbAt(v) == wavelengthWeight(reserved));
}
