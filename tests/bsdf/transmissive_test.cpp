// Rough and partly transmissive glass against Walter et al. 2007 and the Khronos texts, written down a second time in
// double precision.
#include "bsdf/transmissive.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "bsdf/bsdf.h"
#include "bsdf/rows.h"
#include "bsdf/smith.h"
#include "support/chi_squared.h"
#include "support/random.h"

using namespace lsde;
using doctest::Approx;
using test::directionAt;
using test::smithG1;
using Vec3d = glm::dvec3;

namespace {

// Fresnel's equations by the two angles (Born & Wolf 1999, section 1.5.2).
double fresnel(double cosI, double etaT) {
    const double sinT = std::sqrt(1 - square(cosI)) / etaT;
    if (sinT >= 1) return 1;
    const double i = std::acos(cosI), t = std::asin(sinT);
    if (i < 1e-9) return square((etaT - 1) / (etaT + 1));
    return 0.5 * (square(std::sin(i - t) / std::sin(i + t)) + square(std::tan(i - t) / std::tan(i + t)));
}

double ggx(double cosH, double alpha) {
    const double tan2 = 1 / square(cosH) - 1;
    return 1 / (std::numbers::pi * square(alpha) * square(square(cosH)) * square(1 + tan2 / square(alpha)));
}

// Walter et al. 2007, eq. 21: light comes from i, in a medium of index etaI, and leaves to o; n is up.
double walterBtdf(Vec3d i, Vec3d o, double etaI, double etaO, double alpha) {
    Vec3d h = -glm::normalize(etaI * i + etaO * o);  // eq. 16
    if (h.z < 0) h = -h;
    const double ih = std::fabs(glm::dot(i, h)), oh = std::fabs(glm::dot(o, h));
    if (glm::dot(i, h) * i.z <= 0 || glm::dot(o, h) * o.z <= 0) return 0;
    const double g = smithG1(std::fabs(i.z), alpha) * smithG1(std::fabs(o.z), alpha);
    return ih * oh / std::fabs(i.z * o.z) * square(etaO) * (1 - fresnel(ih, etaO / etaI)) * g * ggx(h.z, alpha) /
           square(etaI * glm::dot(i, h) + etaO * glm::dot(o, h));
}

Vec3 anyDirection(test::Random& random) {
    const Vec2 u = random.uniform2D();
    return test::sphereFromSquare(u.x, u.y);
}

double meanWeight(const Bsdf& b, Vec3 wo, int samples, bool transmitted) {
    test::Random random(9);
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        BsdfSample s;
        const float uLobe = random.uniform();
        if (sampleBsdf(b, wo, uLobe, random.uniform2D(), s) && s.transmitted == transmitted) sum += s.weight.x;
    }
    return sum / samples;
}

}  // namespace

TEST_CASE("light through a rough interface follows Walter's equation, for power and for radiance") {
    test::Random random(1);
    for (const float eta : {1.5F, 1 / 1.5F, 2.4F})
        for (const float roughness : {0.3F, 0.7F, 1.0F}) {
            const TransmissiveBsdf glass{.eta = eta, .roughness = roughness};
            int there = 0;
            for (int k = 0; k < 3000; ++k) {
                const Vec3 wo = anyDirection(random), wi = anyDirection(random);
                if (wo.z * wi.z > 0) continue;
                const BsdfEval e = glass.eval(wo, wi);
                const double etaO = wo.z > 0 ? 1 : eta, etaI = wo.z > 0 ? eta : 1, alpha = square(double{roughness});
                CAPTURE(wo.z);
                CAPTURE(wi.z);
                CHECK(e.eta == Approx(etaI / etaO));
                CHECK(isBlack(e.diffuse.f));
                // A photon from wo goes on to wi; the eye at wo sees what comes from wi.
                const double power = walterBtdf(wo, wi, etaO, etaI, alpha);
                if (power > 1e-3) CHECK(e.glossy.f.x == Approx(power).epsilon(2e-3));
                if (power > 1e-3)
                    CHECK(e.glossy.f.x / square(e.eta) == Approx(walterBtdf(wi, wo, etaI, etaO, alpha)).epsilon(2e-3));
                if (power == 0) CHECK(e.glossy.f.x < 1e-3);
                there += power > 1e-3 ? 1 : 0;
            }
            CHECK(there > 200);
        }
}

TEST_CASE("reflection at a rough interface has the exact Fresnel reflectance of its microfacets") {
    test::Random random(2);
    const TransmissiveBsdf glass{.eta = 1.5F, .roughness = 0.6F};
    for (int k = 0; k < 1000; ++k) {
        const Vec3 wo = anyDirection(random);
        Vec3 wi = anyDirection(random);
        wi.z = std::copysign(wi.z, wo.z);
        const Vec3d h = glm::normalize(Vec3d(wo) + Vec3d(wi));
        const double f = fresnel(glm::dot(Vec3d(wo), h), wo.z > 0 ? 1.5 : 1 / 1.5), alpha = 0.36;
        const double expected = f * ggx(std::fabs(h.z), alpha) * smithG1(std::fabs(wo.z), alpha) *
                                smithG1(std::fabs(wi.z), alpha) / (4.0 * wo.z * wi.z);
        CHECK(glass.eval(wo, wi).glossy.f.x == Approx(expected).epsilon(1e-3));
    }
}

TEST_CASE("a rough thin wall's transmission is its reflection mirrored, of the light that it does not reflect") {
    test::Random random(3);
    const Rgb tint(0.2F, 0.6F, 1);
    const TransmissiveBsdf pane{.baseColor = tint, .roughness = 0.5F, .thin = true};
    for (int k = 0; k < 1000; ++k) {
        const Vec3 wo = anyDirection(random);
        Vec3 wi = anyDirection(random);
        wi.z = std::copysign(wi.z, wo.z);
        const double f = fresnel(glm::dot(wo, glm::normalize(wo + wi)), 1.5);
        const BsdfEval reflected = pane.eval(wo, wi), through = pane.eval(wo, {wi.x, wi.y, -wi.z});
        CHECK(through.eta == 1);
        for (int c = 0; c < 3; ++c)
            CHECK(through.glossy.f[c] * f == Approx(reflected.glossy.f[c] * (1 - f) * tint[c]).epsilon(2e-3));
    }
}

TEST_CASE("as roughness goes to 0, each lobe of a rough interface takes what a smooth one's does") {
    for (const bool thin : {false, true})
        for (const Vec3 wo : {directionAt(0, 0), directionAt(50, 20), directionAt(150, 70), directionAt(115, 0)}) {
            const TransmissiveBsdf rough{.roughness = 0.02F, .thin = thin};
            const Bsdf smooth = thin ? Bsdf(ThinDielectricBsdf{1.5F, Rgb(1)}) : Bsdf(DielectricBsdf{1.5F, Rgb(1)});
            const DeltaLobes lobes = deltaLobes(smooth, wo);
            CAPTURE(thin);
            CAPTURE(wo.z);
            CHECK(std::fabs(meanWeight(rough, wo, 100'000, false) - lobes.lobe[0].weight.x) < 5e-3);
            if (lobes.count > 1) CHECK(std::fabs(meanWeight(rough, wo, 100'000, true) - lobes.lobe[1].weight.x) < 5e-3);
        }
}

TEST_CASE("of roughness 0, all that is clear is the smooth interface's to the last digit") {
    for (const Vec3 wo : test::bsdfDirections())
        for (const bool thin : {false, true}) {
            const Rgb tint(0.9F, 0.5F, 0.1F);
            const DeltaLobes a = deltaLobes(TransmissiveBsdf{.baseColor = tint, .thin = thin}, wo);
            const DeltaLobes b =
                deltaLobes(thin ? Bsdf(ThinDielectricBsdf{1.5F, tint}) : Bsdf(DielectricBsdf{1.5F, tint}), wo);
            REQUIRE(a.count == b.count);
            for (size_t i = 0; i < static_cast<size_t>(a.count); ++i) {
                CHECK(a.lobe[i].weight == b.lobe[i].weight);
                CHECK(a.lobe[i].wi == b.lobe[i].wi);
                CHECK(a.lobe[i].straight == b.lobe[i].straight);
                CHECK(a.lobe[i].eta == b.lobe[i].eta);
            }
            CHECK(straightTransmittance(TransmissiveBsdf{.baseColor = tint, .thin = thin}, std::fabs(wo.z)) ==
                  (thin ? b.lobe[1].weight : Rgb(0)));
        }
}

TEST_CASE("transmission mixes the diffuse base with light that goes through, both under the same reflection") {
    const Vec3 wo = directionAt(30, 0), wi = directionAt(50, 100);
    const double f = fresnel(glm::dot(wo, glm::normalize(wo + wi)), 1.5);
    const TransmissiveBsdf clear{.roughness = 0.4F},
        milky{.baseColor = Rgb(0.5F), .roughness = 0.4F, .transmission = 0.25F};
    const BsdfEval e = milky.eval(wo, wi);
    CHECK(e.diffuse.f.x == Approx(0.75 * (1 - f) * 0.5 / std::numbers::pi));
    CHECK(e.glossy.f.x == Approx(clear.eval(wo, wi).glossy.f.x));
    const Vec3 through = -directionAt(25, 20);
    CHECK(milky.eval(wo, through).glossy.f.x == Approx(0.25 * 0.5 * clear.eval(wo, through).glossy.f.x));
    CHECK_FALSE(clear.hasDiffuse());
    // Smooth: the diffuse base stays.
    const TransmissiveBsdf smooth{.baseColor = Rgb(0.5F), .transmission = 0.25F};
    CHECK(smooth.eval(wo, wi).diffuse.f.x == Approx(e.diffuse.f.x));
    CHECK(isBlack(smooth.eval(wo, wi).glossy.f));
}

TEST_CASE("KHR_materials_specular scales the reflection of glass and leaves the rest to what goes through") {
    const Vec3 wo = directionAt(0, 0);
    const auto lobes = [&](float specular, Rgb color) {
        return deltaLobes(TransmissiveBsdf{.specularColor = color, .specular = specular}, wo);
    };
    CHECK(lobes(0, Rgb(1)).lobe[0].weight.x == 0);
    CHECK(lobes(0, Rgb(1)).lobe[1].weight.x == 1);
    CHECK(lobes(0.5F, Rgb(1)).lobe[0].weight.x == Approx(0.02));
    const DeltaLobes tinted = lobes(1, Rgb(2, 1, 0));
    CHECK(tinted.lobe[0].weight.x == Approx(0.08));
    CHECK(tinted.lobe[0].weight.z == Approx(0).epsilon(1e-6));
    CHECK(tinted.lobe[1].weight.z == Approx(0.92));  // the largest share is taken from all channels
    // At the horizon all reflect, as F90 is 1.
    const Vec3 grazing = directionAt(89.99F, 0);
    const DeltaLobes there = deltaLobes(TransmissiveBsdf{.specularColor = Rgb(0.5F)}, grazing);
    CHECK(there.lobe[0].weight.x == Approx(1).epsilon(2e-3));
}

TEST_CASE("a metal part of glass reflects and lets nothing through") {
    const TransmissiveBsdf b{.baseColor = Rgb(0.8F, 0.5F, 0.2F), .metallic = 0.5F};
    const DeltaLobes lobes = deltaLobes(b, {0, 0, 1});
    for (int c = 0; c < 3; ++c) {
        CHECK(lobes.lobe[0].weight[c] == Approx(0.5 * 0.04 + 0.5 * b.baseColor[c]));
        CHECK(lobes.lobe[1].weight[c] == Approx(0.5 * 0.96 * b.baseColor[c]));
    }
}

TEST_CASE("interfaces of roughnesses that floats hardly resolve keep their power and directions") {
    for (const float roughness : {1e-3F, 1e-2F})
        for (const float angle : {0.0F, 45.0F, 85.0F, 140.0F, 175.0F}) {
            const TransmissiveBsdf glass{.roughness = roughness};
            const Vec3 wo = directionAt(angle, 40);
            const DeltaLobes lobes = deltaLobes(DielectricBsdf{1.5F, Rgb(1)}, wo);
            CAPTURE(roughness);
            CAPTURE(angle);
            test::Random random(2);
            for (int i = 0; i < 1000; ++i) {
                BsdfSample s;
                const float uLobe = random.uniform();
                if (!glass.sample(wo, uLobe, random.uniform2D(), s)) continue;
                CHECK(s.weight.x == Approx(1).epsilon(2e-3));
                const BsdfSample& mirror = lobes.lobe[s.transmitted ? 1 : 0];
                if (i < 100) CHECK(glm::length(s.wi - mirror.wi) < 0.1F);
                const LobeEval e = glass.eval(wo, s.wi).glossy;
                CHECK(e.f.x * std::fabs(s.wi.z) / e.pdfW == Approx(s.weight.x).epsilon(2e-3));
            }
        }
}

TEST_CASE("of lobes that pass, the class is that of their roughness") {
    const auto glass = [](float roughness) { return Bsdf(TransmissiveBsdf{.roughness = roughness}); };
    CHECK(glossyClass(glass(0)) == VertexClass::Bend);
    CHECK(glossyClass(glass(0.2F)) == VertexClass::Glossy);
    CHECK(glossyClass(glass(kGlossyRoughness)) == VertexClass::Diffuse);
    CHECK(glossyLobePasses(glass(0.2F)));
    CHECK_FALSE(glossyLobePasses(glass(0)));
    CHECK_FALSE(glossyLobePasses(Bsdf(MetalRoughBsdf{})));
    BsdfSample s;
    REQUIRE(sampleBsdf(TransmissiveBsdf{.transmission = 0.5F, .thin = true}, {0, 0, 1}, 0.3F, {0.5F, 0.5F}, s));
    CHECK(classOf(TransmissiveBsdf{}, s) == VertexClass::Straight);
}
