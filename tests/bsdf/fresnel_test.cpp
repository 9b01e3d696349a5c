#include "bsdf/fresnel.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace lsde;
using doctest::Approx;

namespace {

float reflectanceAt(double angleDeg, float eta) {
    return fresnelDielectric(static_cast<float>(std::cos(angleDeg * kPi / 180)), eta).reflectance;
}

// Of Lambertian light: 2 times the integral of F cos over the cosine.
double diffuseReflectance(float eta) {
    constexpr int kSteps = 20'000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const float c = (static_cast<float>(i) + 0.5F) / kSteps;
        sum += 2 * c * fresnelDielectric(c, eta).reflectance;
    }
    return sum / kSteps;
}

}  // namespace

TEST_CASE("glass reflects what the textbooks say") {
    CHECK(reflectanceAt(0, 1.5F) == Approx(0.04));
    CHECK(reflectanceAt(0, 1 / 1.5F) == Approx(0.04));
    CHECK(reflectanceAt(60, 1.5F) == Approx(0.0891867).epsilon(1e-5));
    CHECK(reflectanceAt(0, 1.333F) == Approx(0.0203725).epsilon(1e-4));
    CHECK(reflectanceAt(0, 2.417F) == Approx(0.171976).epsilon(1e-4));
    // At Brewster's angle, tan = 1.5, the parallel part vanishes: half of ((n^2 - 1)/(n^2 + 1))^2 is left.
    CHECK(reflectanceAt(std::atan(1.5) * 180 / kPi, 1.5F) == Approx(0.5 * square(1.25 / 3.25)).epsilon(1e-5));
    CHECK(fresnelDielectric(0, 1.5F).reflectance == Approx(1));
}

TEST_CASE("beyond the critical angle all light is reflected, just before it is not") {
    const double criticalDeg = std::asin(1 / 1.5) * 180 / kPi;
    const FresnelSplit beyond =
        fresnelDielectric(static_cast<float>(std::cos((criticalDeg + 0.01) * kPi / 180)), 1 / 1.5F);
    CHECK(beyond.reflectance == 1);
    CHECK(beyond.cosT == 0);
    CHECK(reflectanceAt(criticalDeg - 0.01, 1 / 1.5F) < 0.96F);
    CHECK(reflectanceAt(criticalDeg - 0.01, 1 / 1.5F) > 0.8F);
    CHECK(reflectanceAt(89, 1 / 1.5F) == 1);
}

TEST_CASE("Lambertian light is reflected as Walsh's formula says") {
    // 0.0918 from without at n = 1.5; from within 1 - (1 - 0.0918) / n^2 (Judd 1942).
    CHECK(diffuseReflectance(1.5F) == Approx(0.0918).epsilon(1e-3));
    CHECK(diffuseReflectance(1 / 1.5F) == Approx(1 - (1 - diffuseReflectance(1.5F)) / 2.25).epsilon(1e-4));
}

TEST_CASE("light on the way back meets the same reflectance, and returns along its path") {
    for (const float eta : {1.1F, 1.5F, 2.4F, 0.9F})
        for (int i = 10; i <= 100; ++i) {  // nearer to the horizon the way back is too near to the critical angle
            const float cosI = static_cast<float>(i) / 100;
            const FresnelSplit there = fresnelDielectric(cosI, eta);
            if (there.cosT == 0) continue;
            const FresnelSplit back = fresnelDielectric(there.cosT, 1 / eta);
            CHECK(back.reflectance == Approx(there.reflectance).epsilon(2e-4));
            CHECK(back.cosT == Approx(cosI).epsilon(2e-5));
        }
}

TEST_CASE("refraction obeys Snell's law") {
    for (const float eta : {1.1F, 1.5F, 0.8F})
        for (const float cosI : {1.0F, 0.9F, 0.8F, 0.7F}) {
            const float cosT = fresnelDielectric(cosI, eta).cosT;
            CHECK(std::sqrt(1 - square(cosI)) == Approx(eta * std::sqrt(1 - square(cosT))).epsilon(1e-4));
        }
}

TEST_CASE("equal media have no interface, and nearly equal ones hardly one") {
    for (const float cosI : {1.0F, 0.5F, 0.1F, 1e-3F}) {
        CHECK(fresnelDielectric(cosI, 1).reflectance == 0);
        CHECK(fresnelDielectric(cosI, 1).cosT == Approx(cosI));
    }
    CHECK(reflectanceAt(0, 1.001F) == Approx(square(0.001 / 2.001)).epsilon(1e-3));
    CHECK(reflectanceAt(0, 1e6F) == Approx(1).epsilon(1e-5));
}

TEST_CASE("Schlick's approximation runs from F0 to 1, and stays near the truth between") {
    const Rgb f0(0.04F, 0.5F, 1);
    CHECK(fresnelSchlick(f0, 1) == f0);
    CHECK(fresnelSchlick(f0, 0) == Rgb(1));
    CHECK(fresnelSchlick(f0, 0.5F).x == Approx(0.07));
    CHECK(fresnelSchlick(f0, 1.0000001F) == f0);
    for (int angle = 0; angle <= 90; angle += 5)
        CHECK(std::fabs(fresnelSchlick(Rgb(0.04F), std::cos(static_cast<float>(angle) * kPi / 180)).x -
                        reflectanceAt(angle, 1.5F)) < 0.04F);
}
