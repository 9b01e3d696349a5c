// The sun and the sky against the paper's own formulas evaluated by hand, and spectra integrated by other means.
#include "scene/sky.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "support/random.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

SkySettings at(float elevationDeg, float turbidity = 3, float azimuthDeg = 0) {
    SkySettings s;
    s.sunElevationDeg = elevationDeg;
    s.turbidity = turbidity;
    s.sunAzimuthDeg = azimuthDeg;
    return s;
}

double relative(float value, double expected) { return static_cast<double>(value) / expected - 1; }

std::string refusal(const SkySettings& s) {
    try {
        makeSky(s);
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("the sun's radiance is that of its spectrum through the air, seen by the CIE observer") {
    // The paper's tables with water vapour, interpolated to 1 nm, and the CIE's own tables of the 1931 observer, in
    // numpy.
    struct Case {
        float turbidity, elevationDeg;
        glm::dvec3 radiance;
    };
    for (const Case& c :
         {Case{3, 45, {1.39561e9, 1.14771e9, 9.27108e8}}, Case{2, 90, {1.68378e9, 1.46011e9, 1.30509e9}},
          Case{6, 20, {4.64386e8, 2.84411e8, 1.34574e8}}}) {
        CAPTURE(c.elevationDeg);
        const Rgb sun = sunRadiance(at(c.elevationDeg, c.turbidity));
        for (int i = 0; i < 3; ++i) {
            CAPTURE(i);
            CHECK(std::fabs(relative(sun[i], c.radiance[i])) < 0.001);
        }
    }
}

TEST_CASE("the sky's zenith is the paper's, and the sky is brightest around the sun") {
    // Its formulas in numpy, at the zenith and 60 degrees from it, away from the sun.
    const auto is = [](Rgb sky, double r, double g, double b) {
        CHECK(sky.x == doctest::Approx(r).epsilon(1e-4));
        CHECK(sky.y == doctest::Approx(g).epsilon(1e-4));
        CHECK(sky.z == doctest::Approx(b).epsilon(1e-4));
    };
    is(skyRadiance(at(60, 3), {0, 1, 0}), 7184.07, 10499.84, 19068.22);
    is(skyRadiance(at(60, 3), {0, 0.5F, -std::sqrt(0.75F)}), 3538.27, 6606.28, 11856.06);
    const SkySettings low = at(20, 3, 90);
    const Vec3 toSun = sunDirection(low);
    CHECK(glm::length(toSun - Vec3(std::cos(kPi / 9), std::sin(kPi / 9), 0)) < 1e-6F);
    const float there = luminance(skyRadiance(low, toSun));
    for (const Vec3 other : {Vec3(0, 1, 0), Vec3(-toSun.x, toSun.y, 0), Vec3(0, toSun.y, toSun.x)})
        CHECK(there > 3 * luminance(skyRadiance(low, other)));
    // Blue away from the sun, red where it sets.
    const Rgb opposite = skyRadiance(low, glm::normalize(Vec3(-0.5F, 1, 0)));
    CHECK(opposite.z > 1.5F * opposite.x);
    const Rgb setting = sunRadiance(at(3));
    CHECK(setting.x > 3 * setting.y);
}

TEST_CASE("the table of the sky is the model within a thousandth, but for the horizon") {
    const SkySettings settings = at(25, 4, 60);
    const Sky sky = makeSky(settings);
    const EnvironmentMap map(sky.sky.image, sky.sky.turn);
    Random random(3);
    for (int i = 0; i < 20'000; ++i) {
        const float y = 0.008F + 0.99F * random.uniform(), azimuth = 2 * kPi * random.uniform();
        const float r = std::sqrt(1 - y * y);
        const Vec3 direction(r * std::sin(azimuth), y, r * std::cos(azimuth));
        const Rgb exact = skyRadiance(settings, direction);
        CHECK(maxComponent(glm::abs(map.radiance(direction) - exact)) < 1e-3F * maxComponent(exact));
    }
}

TEST_CASE("below the horizon is the ground, lit by sky and sun") {
    SkySettings settings = at(50);
    settings.groundAlbedo = 0.3F;
    const Sky sky = makeSky(settings);
    const EnvironmentMap map(sky.sky.image, 0);
    const Rgb ground = map.radiance({0, -1, 0});
    CHECK(ground == map.radiance(glm::normalize(Vec3(1, -0.02F, 3))));
    CHECK(maxComponent(glm::abs(ground - openIrradiance(settings) * (0.3F / kPi))) < 1e-4F * maxComponent(ground));
    // On the ground: 30001 lux of the sky, as numpy integrates the paper's luminance, and the rest of the sun.
    const double sun = static_cast<double>(luminance(sky.sun.radiance)) * 4 * std::numbers::pi *
                       square(std::sin(0.5 * static_cast<double>(sky.sun.angularRadius))) *
                       static_cast<double>(sky.sun.direction.y);
    CHECK(static_cast<double>(luminance(openIrradiance(settings))) - sun == doctest::Approx(30001).epsilon(2e-3));
}

TEST_CASE("a sky that the model does not know is refused") {
    CHECK(refusal(at(-1)) == "sky: sun elevation -1, expected 0 to 90");
    CHECK(refusal(at(NAN)) == "sky: sun elevation nan, expected 0 to 90");
    CHECK(refusal(at(45, 1)) == "sky: turbidity 1, expected 2 to 10");
    SkySettings bright;
    bright.groundAlbedo = 1.5F;
    CHECK(refusal(bright) == "sky: ground albedo 1.5, expected 0 to 1");
    for (const float elevation : {0.0F, 90.0F})
        for (const float turbidity : {2.0F, 10.0F}) CHECK(refusal(at(elevation, turbidity)) == "accepted");
}
