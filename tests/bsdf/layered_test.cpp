// Sheen and clearcoat: their own lobes, and what they leave to what lies below.
#include "bsdf/layered.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"
#include "bsdf/rows.h"
#include "support/chi_squared.h"

using namespace lsde;
using doctest::Approx;
using test::directionAt;

namespace {

double integral(const Sheen& sheen, Vec3 wo) {
    const test::SquareGrid grid{60, 60, 8};
    double sum = 0;
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x)
            sum += test::integrateCell(grid, x, y, [&](double s, double t) {
                const Vec3 wi = test::sphereFromSquare(s, t);
                return wi.z > 0 ? 4 * std::numbers::pi * sheen.lobe(wo, wi) * double{wi.z} : 0;
            });
    return sum;
}

}  // namespace

TEST_CASE("the table of sheen's albedo is the lobe's integral") {
    for (const float roughness : {0.2F, 0.5F, 0.77F, 1.0F})
        for (const float angle : {0.0F, 40.0F, 65.0F, 80.0F}) {
            const Sheen sheen{Rgb(1), roughness};
            const Vec3 wo = directionAt(angle, 0);
            CAPTURE(roughness);
            CAPTURE(angle);
            CHECK(std::fabs(integral(sheen, wo) - sheen.albedo(wo.z)) < 0.015);
        }
}

TEST_CASE("sheen is Charlie's distribution under its own masking") {
    // Conty Estevez & Kulla 2017, eq. 2, at a half vector of 60 degrees: D = (2 + 1/a) sin^(1/a) / (2 pi).
    const Sheen sheen{Rgb(1), 0.8F};
    const Vec3 wo = directionAt(60, 0);
    const double alpha = 0.64,
                 d = (2 + 1 / alpha) * std::pow(std::sin(std::numbers::pi / 3), 1 / alpha) / (2 * std::numbers::pi);
    const auto fit = [&](double x) {
        const double t = square(1 - alpha);
        const auto mix = [t](double a, double b) { return (1 - t) * a + t * b; };
        return mix(21.5473, 25.3245) / (1 + mix(3.82987, 3.32435) * std::pow(x, mix(0.19823, 0.16801))) +
               mix(-1.97760, -1.27393) * x + mix(-4.32054, -4.85967);
    };
    const double lambda = std::exp(2 * fit(0.5) - fit(1 - 0.5));
    CHECK(sheen.lobe(wo, wo) == Approx(d / ((1 + 2 * lambda) * 4 * 0.25)).epsilon(1e-3));
}

TEST_CASE("sheen leaves to the base what it does not send back, by the more slanted direction") {
    const Sheen sheen{Rgb(0.5F, 0.8F, 0.1F), 0.6F};
    const Vec3 steep = directionAt(10, 0), flat = directionAt(75, 90);
    CHECK(sheen.transmittance(steep, flat) == Approx(1 - 0.8 * sheen.albedo(flat.z)));
    CHECK(sheen.transmittance(flat, steep) == sheen.transmittance(steep, flat));
    CHECK(Sheen{}.transmittance(flat, flat) == 1);
    const MetalRoughBsdf base{Rgb(0.5F), Rgb(0.04F), 0, 0, 1};
    const LayeredBsdf cloth{.base = base, .sheen = sheen};
    const Rgb f = cloth.eval(steep, flat).diffuse.f;
    CHECK(f.x == Approx(0.5F * sheen.lobe(steep, flat) + sheen.transmittance(steep, flat) * 0.5 / std::numbers::pi));
}

TEST_CASE("a smooth coat adds a delta reflection and dims what lies under it by what it reflects") {
    const MetalRoughBsdf base{Rgb(0.5F), Rgb(0.04F), 1, 0, 0.6F};
    const LayeredBsdf coated{.base = base, .coat = {0.8F, 0}};
    const Vec3 wo = directionAt(30, 0), wi = directionAt(70, 120);
    const auto f = [](Vec3 w) { return 0.8F * fresnelSchlick(Rgb(0.04F), w.z).x; };
    const BsdfEval bare = base.eval(wo, wi), under = coated.eval(wo, wi);
    CHECK(under.diffuse.f.x == Approx(bare.diffuse.f.x * (1 - f(wi))));
    CHECK(under.glossy.f.x == Approx(bare.glossy.f.x * (1 - f(wi))));
    const DeltaLobes lobes = deltaLobes(coated, wo);
    REQUIRE(lobes.count == 1);
    CHECK(lobes.lobe[0].weight.x == Approx(f(wo)));
    // Where both are smooth, both reflect.
    const LayeredBsdf mirror{.base = MetalRoughBsdf{Rgb(0.9F), Rgb(0.04F), 1, 1, 0}, .coat = {1, 0}};
    const DeltaLobes two = deltaLobes(mirror, {0, 0, 1});
    REQUIRE(two.count == 2);
    CHECK(two.lobe[0].weight.x == Approx(0.96 * 0.9));
    CHECK(two.lobe[1].weight.x == Approx(0.04));
}

TEST_CASE("a coat has a normal of its own, from either side of the surface") {
    const LayeredBsdf bent{.base = MetalRoughBsdf{Rgb(0), Rgb(0.04F), 0, 0, 1}, .coat = {1, 0, {0.28F, 0, 0.96F}}};
    const Vec3 wi = deltaLobes(bent, {0, 0, 1}).lobe[0].wi;
    CHECK(wi.x == Approx(2 * 0.96 * 0.28));
    CHECK(wi.z == Approx(2 * 0.96 * 0.96 - 1));
    CHECK(deltaLobes(bent, {0, 0, -1}).lobe[0].wi.z == Approx(-wi.z));
    CHECK(deltaLobes(bent, directionAt(80, 180)).count == 0);  // its mirror direction lies below the surface
}

TEST_CASE("of a narrow and a wide glossy lobe, the wide one goes with the diffuse ones, and each has its class") {
    const MetalRoughBsdf wide{Rgb(1), Rgb(0.04F), 1, 1, 0.5F};
    const Bsdf narrowOnWide = LayeredBsdf{.base = wide, .coat = {1, 0.1F}};
    CHECK(glossyClass(narrowOnWide) == VertexClass::Glossy);
    CHECK(hasDiffuseLobe(narrowOnWide));
    const Vec3 wo = directionAt(30, 0), mirror = directionAt(30, 180), off = directionAt(60, 180);
    CHECK(evalBsdf(narrowOnWide, wo, off).diffuse.f.x > 0.9 * wide.eval(wo, off).glossy.f.x);
    CHECK(evalBsdf(narrowOnWide, wo, mirror).glossy.f.x > 1);
    const Bsdf wideOnWide = LayeredBsdf{.base = wide, .coat = {1, 0.3F}};
    CHECK(glossyClass(wideOnWide) == VertexClass::Diffuse);
    CHECK_FALSE(hasDiffuseLobe(wideOnWide));
    const Bsdf smoothOnWide = LayeredBsdf{.base = wide, .coat = {1, 0}};
    CHECK(hasDelta(smoothOnWide));
    CHECK(glossyClass(smoothOnWide) == VertexClass::Diffuse);
}
