// glTF's material against its specification, written down a second time in double and by angles.
#include "bsdf/metal_rough.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "bsdf/rows.h"
#include "bsdf/smith.h"
#include "support/chi_squared.h"
#include "support/random.h"

using namespace lsde;
using doctest::Approx;
using test::directionAt;
using test::smithG1;

namespace {

constexpr double kPiDouble = std::numbers::pi;

// One channel of glTF 2.0 appendix B with KHR_materials_specular.
struct Specification {
    double baseColor, f0, specular, metallic, roughness;

    static double schlick(double f0, double cosH) { return f0 + (1 - f0) * std::pow(1 - cosH, 5); }
    double ggx(Vec3 wo, Vec3 wi, Vec3 h) const {
        const double alpha = square(roughness), cos2 = square(static_cast<double>(h.z));
        const double d = square(alpha) / (kPiDouble * square(cos2 * (square(alpha) - 1) + 1));
        return d * smithG1(wo.z, alpha) * smithG1(wi.z, alpha) / (4.0 * wo.z * wi.z);
    }
    double diffuse(double cosH) const {
        return (1 - metallic) * (1 - specular * schlick(f0, cosH)) * baseColor / kPiDouble;
    }
    double glossy(Vec3 wo, Vec3 wi, Vec3 h) const {
        const double cosH = glm::dot(wo, h);
        const double fresnel = metallic * schlick(baseColor, cosH) + (1 - metallic) * specular * schlick(f0, cosH);
        return fresnel * ggx(wo, wi, h);
    }
};

MetalRoughBsdf greyBsdf(const Specification& s) {
    return {Rgb(static_cast<float>(s.baseColor)), Rgb(static_cast<float>(s.f0)), static_cast<float>(s.specular),
            static_cast<float>(s.metallic), static_cast<float>(s.roughness)};
}

double meanWeight(const MetalRoughBsdf& b, Vec3 wo, int samples) {
    test::Random random(9);
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        BsdfSample s;
        const float uLobe = random.uniform();
        if (b.sample(wo, uLobe, random.uniform2D(), s)) sum += s.weight.x;
    }
    return sum / samples;
}

}  // namespace

TEST_CASE("both lobes are those of the specification") {
    test::Random random(1);
    for (const Specification& spec : {Specification{0.7, 0.04, 1, 0, 0.5}, Specification{0.7, 0.04, 1, 1, 0.3},
                                      Specification{0.3, 0.1, 0.5, 0.25, 0.8}, Specification{0.9, 0.04, 0, 0, 1}}) {
        const MetalRoughBsdf b = greyBsdf(spec);
        for (int i = 0; i < 500; ++i) {
            const Vec2 u = random.uniform2D(), v = random.uniform2D();
            Vec3 wo = test::sphereFromSquare(u.x, u.y), wi = test::sphereFromSquare(v.x, v.y);
            wo.z = std::fabs(wo.z);
            wi.z = std::fabs(wi.z);
            const Vec3 h = glm::normalize(wo + wi);
            const BsdfEval e = b.eval(wo, wi);
            CHECK(e.diffuse.f.x == Approx(spec.diffuse(glm::dot(wo, h))).epsilon(1e-4));
            CHECK(e.glossy.f.x == Approx(spec.glossy(wo, wi, h)).epsilon(1e-4));
            const BsdfEval below = b.eval({wo.x, wo.y, -wo.z}, {wi.x, wi.y, -wi.z});
            CHECK(below.glossy.f == e.glossy.f);
            CHECK(isBlack(b.eval(wo, {wi.x, wi.y, -wi.z}).diffuse.f));
        }
    }
}

TEST_CASE("the coat's share is taken from all channels of the diffuse lobe alike") {
    const MetalRoughBsdf b{Rgb(0.5F), Rgb(0.1F, 0.04F, 0.02F), 1, 0, 0.5F};
    const Rgb f = b.eval({0, 0, 1}, {0, 0, 1}).diffuse.f;
    CHECK(f.x == Approx(0.9 * 0.5 / kPiDouble));
    CHECK(f.x == f.z);
}

TEST_CASE("without a coat the material is exactly Lambert's") {
    const MetalRoughBsdf b{Rgb(0.8F, 0.5F, 0.2F), Rgb(0.04F), 0, 0, 1};
    CHECK_FALSE(b.hasGlossy());
    const DiffuseBsdf lambert{b.baseColor};
    const Vec3 wo = directionAt(50, 10), wi = directionAt(70, 200);
    for (int c = 0; c < 3; ++c) CHECK(b.eval(wo, wi).diffuse.f[c] == Approx(lambert.eval(wo, wi).diffuse.f[c]));
    BsdfSample s;
    for (const float uLobe : {0.0F, 0.5F, kOneMinusEpsilon}) {
        REQUIRE(b.sample(wo, uLobe, {0.3F, 0.6F}, s));
        CHECK(s.event == Event::Diffuse);
        for (int c = 0; c < 3; ++c) CHECK(s.weight[c] == Approx(b.baseColor[c]));
    }
}

TEST_CASE("a white metal of roughness 1 gives back 1 - ln 2 of the light from above") {
    // alpha = 1: D = 1/pi, G1(wi) = 2 cos/(1 + cos), so the albedo is the integral of cos/(1 + cos) over the cosine.
    const MetalRoughBsdf metal{Rgb(1), Rgb(0.04F), 1, 1, 1};
    CHECK(meanWeight(metal, {0, 0, 1}, 1'000'000) == Approx(1 - std::numbers::ln2).epsilon(2e-3));
}

TEST_CASE("the single-scattering albedo of a metal agrees with the specification's integral") {
    const test::SquareGrid grid{40, 40, 4};
    for (const double roughness : {0.4, 0.7, 1.0})
        for (const float angle : {20.0F, 60.0F, 80.0F}) {
            const Specification spec{0.6, 0.04, 1, 1, roughness};
            const Vec3 wo = directionAt(angle, 0);
            double albedo = 0;
            for (int y = 0; y < grid.height; ++y)
                for (int x = 0; x < grid.width; ++x)
                    albedo += test::integrateCell(grid, x, y, [&](double s, double t) {
                        const Vec3 wi = test::sphereFromSquare(s, t);
                        return wi.z > 0 ? 4 * kPiDouble * spec.glossy(wo, wi, glm::normalize(wo + wi)) * wi.z : 0;
                    });
            CAPTURE(roughness);
            CAPTURE(angle);
            CHECK(meanWeight(greyBsdf(spec), wo, 200'000) == Approx(albedo).epsilon(4e-3));
        }
}

TEST_CASE("a lobe as narrow as floats resolve keeps its power and its densities") {
    for (const float roughness : {1e-3F, 1e-2F})
        for (const float angle : {0.0F, 45.0F, 85.0F}) {
            const MetalRoughBsdf metal{Rgb(0.5F), Rgb(0.04F), 1, 1, roughness};
            const Vec3 wo = directionAt(angle, 40);
            CAPTURE(roughness);
            CAPTURE(angle);
            const double mirror = metal.reflect(wo).weight.x;
            CHECK(meanWeight(metal, wo, 10'000) == Approx(mirror).epsilon(1e-3));
            test::Random random(2);
            int near = 0;
            constexpr int kSamples = 1000;
            for (int i = 0; i < kSamples; ++i) {
                BsdfSample s;
                REQUIRE(metal.sample(wo, 0.5F, random.uniform2D(), s));
                const LobeEval e = metal.eval(wo, s.wi).glossy;
                // Rounding of wi moves it within the lobe by some hundredths of its width.
                near += std::fabs(e.pdfW / s.pdfW - 1) < 0.5F ? 1 : 0;
                CHECK(e.f.x * s.wi.z / e.pdfW == Approx(s.weight.x).epsilon(1e-3));
            }
            CHECK(near > 0.98 * kSamples);
        }
}

TEST_CASE("lobes are chosen such that weights stay bounded") {
    test::Random random(3);
    const MetalRoughBsdf plastic{Rgb(0.9F), Rgb(0.04F), 1, 0, 1};
    for (const float angle : {0.0F, 45.0F, 89.0F, 89.999F})
        for (int i = 0; i < 10'000; ++i) {
            BsdfSample s;
            const float uLobe = random.uniform();
            if (plastic.sample(directionAt(angle, 0), uLobe, random.uniform2D(), s)) CHECK(s.weight.x < 10);
        }
}

TEST_CASE("an anisotropic lobe is wide along its direction and as rough as without across it") {
    const MetalRoughBsdf brushed{.roughness = 0.3F, .anisotropy = 0.8F, .direction = {0.6F, 0.8F}};
    const MetalRoughBsdf plain{.roughness = 0.3F};
    const Vec3 along(0.6F, 0.8F, 0), across(-0.8F, 0.6F, 0);
    const auto at = [](Vec3 axis, float tilt) { return glm::normalize(Vec3(0, 0, 1) + tilt * axis); };
    // D of Burley 2012, eq. 12, by hand: alpha across is roughness^2, along it mix(roughness^2, 1, strength^2).
    const double b = 0.09, a = 0.09 + 0.91 * 0.64;
    CHECK(brushed.widestRoughness() == Approx(std::sqrt(a)));
    for (const float tilt : {0.0F, 0.1F, 0.5F})
        for (const bool isAlong : {false, true}) {
            const Vec3 wi = at(isAlong ? along : across, tilt), wo(0, 0, 1);
            const Vec3 h = glm::normalize(wo + wi);
            const double sine2 = 1 - square(double{h.z}), width = isAlong ? a : b;
            const double d = 1 / (kPiDouble * a * b * square(sine2 / square(width) + square(double{h.z})));
            const double tan2 = square(double{tilt}), g = 2 / (1 + std::sqrt(1 + square(width) * tan2));
            CHECK(brushed.eval(wo, wi).glossy.f.x == Approx(d * g / (4.0 * wi.z)).epsilon(1e-3));
        }
    CHECK(brushed.eval({0, 0, 1}, at(along, 0.5F)).glossy.f.x > 5 * plain.eval({0, 0, 1}, at(along, 0.5F)).glossy.f.x);
}
