#include "bsdf/microfacet.h"

#include <doctest/doctest.h>

#include "bsdf/rows.h"

using namespace lsde;
using doctest::Approx;

namespace {

// Integral over the upper hemisphere; nodes lie denser about the pole, by angle squared, for narrow lobes.
template <typename F>
double integrateHemisphere(const F& f) {
    constexpr int kAngles = 600, kAzimuths = 300;
    double sum = 0;
    for (int i = 0; i < kAngles; ++i) {
        const double s = (i + 0.5) / kAngles, angle = s * s * kPi / 2;
        const double weight = std::sin(angle) * s * kPi / kAngles * (2 * kPi / kAzimuths);
        for (int j = 0; j < kAzimuths; ++j)
            sum += weight * f(test::directionAt(static_cast<float>(angle * 180 / kPi),
                                                (static_cast<float>(j) + 0.5F) * 360 / kAzimuths));
    }
    return sum;
}

}  // namespace

TEST_CASE("microfacets cover the surface they stand on") {
    for (const float roughness : {0.1F, 0.3F, 0.7F, 1.0F}) {
        const Ggx ggx(roughness);
        CAPTURE(roughness);
        CHECK(integrateHemisphere([&](Vec3 h) { return ggx.d(h) * h.z; }) == Approx(1).epsilon(2e-3));
    }
}

TEST_CASE("visible microfacets cover the surface as seen from any direction") {
    // What defines Smith's G1 (Heitz 2014, eq. 18).
    for (const float roughness : {0.3F, 0.7F, 1.0F})
        for (const float angle : {0.0F, 30.0F, 60.0F, 85.0F}) {
            const Ggx ggx(roughness);
            const Vec3 wo = test::directionAt(angle, 10);
            const double seen =
                integrateHemisphere([&](Vec3 h) { return ggx.g1(wo) * std::max(0.0F, glm::dot(wo, h)) * ggx.d(h); });
            CAPTURE(roughness);
            CAPTURE(angle);
            CHECK(seen == Approx(wo.z).epsilon(2e-3));
        }
}

TEST_CASE("visibility and density follow from D and G1") {
    const Ggx ggx(0.6F);
    for (const Vec3 wo : {test::directionAt(10, 5), test::directionAt(70, 100), test::directionAt(89, 30)})
        for (const Vec3 wi : {test::directionAt(0, 0), test::directionAt(50, 200), test::directionAt(88, 20)}) {
            CHECK(ggx.visibility(wo, wi) == Approx(ggx.g1(wo) * ggx.g1(wi) / (4 * wo.z * wi.z)).epsilon(1e-5));
            const Vec3 h = glm::normalize(wo + wi);
            CHECK(ggx.reflectionPdf(wo, h) == Approx(ggx.g1(wo) * ggx.d(h) / (4 * wo.z)).epsilon(1e-5));
        }
}

TEST_CASE("G1 is 1 from above, falls towards the horizon and is never above 1") {
    for (const float roughness : {1e-3F, 0.3F, 1.0F}) {
        const Ggx ggx(roughness);
        CHECK(ggx.g1({0, 0, 1}) == Approx(1));
        float last = 1;
        for (int angle = 1; angle < 90; ++angle) {
            const float g = ggx.g1(test::directionAt(static_cast<float>(angle), 0));
            CHECK(g <= last * 1.000001F);
            last = g;
        }
    }
    // alpha = 1: 2 cos / (1 + cos).
    CHECK(Ggx(1).g1(test::directionAt(60, 0)) == Approx(2.0 / 3));
}
