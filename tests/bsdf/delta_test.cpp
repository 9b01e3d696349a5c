// Mirrors, interfaces and panes: where light goes, and how much of it.
#include <doctest/doctest.h>

#include <algorithm>

#include "bsdf/bsdf.h"
#include "bsdf/fresnel.h"
#include "bsdf/rows.h"

using namespace lsde;
using doctest::Approx;
using test::bsdfRows;
using test::directionAt;

namespace {

void checkDirection(Vec3 a, Vec3 b) { CHECK(glm::length(a - b) < 1e-6F); }

}  // namespace

TEST_CASE("a white mirror reflects all light, a tinted one its colour from above") {
    for (const Vec3 wo : test::bsdfDirections()) {
        const DeltaLobes lobes = deltaLobes(MirrorBsdf{}, wo);
        REQUIRE(lobes.count == 1);
        CHECK(lobes.lobe[0].weight == Rgb(1));
        checkDirection(lobes.lobe[0].wi, {-wo.x, -wo.y, wo.z});
    }
    const Rgb gold(1, 0.77F, 0.34F);
    CHECK(deltaLobes(MirrorBsdf{gold}, {0, 0, -1}).lobe[0].weight == gold);
    // Schlick at 60 degrees.
    CHECK(deltaLobes(MirrorBsdf{gold}, directionAt(60, 0)).lobe[0].weight.z == Approx(0.34 + 0.66 / 32));
}

TEST_CASE("interfaces and panes divide all light into reflected and transmitted") {
    for (const float eta : {1.0F, 1.33F, 1.5F, 1 / 1.5F, 2.4F})
        for (int angle = 0; angle < 180; angle += 3) {
            if (angle == 90) continue;
            const Vec3 wo = directionAt(static_cast<float>(angle), 25);
            for (const Bsdf& bsdf :
                 {Bsdf(DielectricBsdf{eta, Rgb(1)}), Bsdf(ThinDielectricBsdf{std::max(eta, 1.0F), Rgb(1)})}) {
                const DeltaLobes lobes = deltaLobes(bsdf, wo);
                float sum = 0;
                for (int i = 0; i < lobes.count; ++i) sum += lobes.lobe[static_cast<size_t>(i)].weight.x;
                CHECK(sum == Approx(1));
            }
        }
}

TEST_CASE("light bends by Snell's law on its way in and out") {
    const DielectricBsdf glass{1.5F, Rgb(1)};
    for (int angle = 1; angle < 89; angle += 4) {
        const Vec3 wo = directionAt(static_cast<float>(angle), 70);
        const BsdfSample in = deltaLobes(glass, wo).lobe[1];
        CAPTURE(angle);
        CHECK(in.transmitted);
        CHECK(in.eta == Approx(1.5));
        CHECK(in.wi.z < 0);
        CHECK(glm::length(in.wi) == Approx(1).epsilon(1e-6));
        checkDirection(Vec3(in.wi.x, in.wi.y, 0) * 1.5F, Vec3(-wo.x, -wo.y, 0));
        const DeltaLobes back = deltaLobes(glass, in.wi);
        REQUIRE(back.count == 2);
        CHECK(back.lobe[1].eta == Approx(1 / 1.5));
        CHECK(glm::length(back.lobe[1].wi - wo) < 2e-5F);
        CHECK(back.lobe[1].weight.x == Approx(in.weight.x).epsilon(1e-3));
    }
}

TEST_CASE("from within, beyond the critical angle, there is reflection alone") {
    const DielectricBsdf glass{1.5F, Rgb(0.5F)};
    const Vec3 wo = -directionAt(45, 10);
    const DeltaLobes lobes = deltaLobes(glass, wo);
    REQUIRE(lobes.count == 1);
    CHECK(lobes.lobe[0].weight == Rgb(1));
    checkDirection(lobes.lobe[0].wi, {-wo.x, -wo.y, wo.z});
    CHECK(deltaLobes(glass, -directionAt(40, 10)).count == 2);
}

TEST_CASE("a pane lets light pass unbent, tinted, and reflects by one interface") {
    const Rgb tint(0.2F, 0.6F, 1);
    const ThinDielectricBsdf pane{1.5F, tint};
    for (const Vec3 wo : test::bsdfDirections()) {
        const DeltaLobes lobes = deltaLobes(pane, wo);
        REQUIRE(lobes.count == 2);
        const float f = fresnelDielectric(std::fabs(wo.z), 1.5F).reflectance;
        CHECK(lobes.lobe[0].weight.x == Approx(f));
        CHECK_FALSE(lobes.lobe[0].straight);
        CHECK(lobes.lobe[1].straight);
        CHECK(lobes.lobe[1].transmitted);
        CHECK(lobes.lobe[1].eta == 1);
        CHECK(lobes.lobe[1].wi == -wo);
        for (int c = 0; c < 3; ++c) {
            CHECK(lobes.lobe[1].weight[c] == Approx((1 - f) * tint[c]));
            CHECK(lobes.lobe[1].weight[c] == Approx(pane.transmittance(std::fabs(wo.z))[c]));
        }
    }
}

TEST_CASE("delta lobes offered for splitting are unweighted by any choice, sampled ones by theirs") {
    for (const test::BsdfRow& row : bsdfRows())
        for (const Vec3 wo : test::bsdfDirections()) {
            CAPTURE(row.name);
            const DeltaLobes lobes = deltaLobes(row.bsdf, wo);
            CHECK((lobes.count > 0) == hasDelta(row.bsdf));
            for (int i = 0; i < lobes.count; ++i) {
                const BsdfSample& lobe = lobes.lobe[static_cast<size_t>(i)];
                CHECK(lobe.delta);
                CHECK(lobe.event == Event::Specular);
                CHECK(lobe.pdfW == 1);
                CHECK(lobe.reversePdfW == 1);
            }
            for (int i = 0; i < 64; ++i) {
                BsdfSample s;
                if (!sampleBsdf(row.bsdf, wo, (static_cast<float>(i) + 0.5F) / 64, {0.3F, 0.7F}, s) || !s.delta)
                    continue;
                // One of them: two may go the same way.
                const auto isSampled = [&](const BsdfSample& lobe) {
                    return s.wi == lobe.wi && s.eta == lobe.eta && s.straight == lobe.straight &&
                           glm::length(s.weight * s.pdfW - lobe.weight) < 1e-5F;
                };
                CHECK(std::any_of(lobes.lobe.begin(), lobes.lobe.begin() + lobes.count, isSampled));
            }
        }
}

TEST_CASE("a delta choice is as probable on the way back") {
    for (const test::BsdfRow& row : bsdfRows())
        for (const Vec3 wo : test::bsdfDirections())
            for (int i = 0; i < 64; ++i) {
                BsdfSample s, back;
                const float uLobe = (static_cast<float>(i) + 0.5F) / 64;
                if (!sampleBsdf(row.bsdf, wo, uLobe, {0.3F, 0.7F}, s) || !s.delta) continue;
                if (!sampleBsdf(row.bsdf, s.wi, uLobe, {0.3F, 0.7F}, back) || !back.delta) continue;
                if (back.transmitted != s.transmitted || glm::length(back.wi - wo) > 1e-4F) continue;
                CAPTURE(row.name);
                CHECK(s.reversePdfW == Approx(back.pdfW).epsilon(1e-3));
            }
}

TEST_CASE("white interfaces are sampled without any change of power") {
    for (const Bsdf& bsdf : {Bsdf(DielectricBsdf{1.5F, Rgb(1)}), Bsdf(ThinDielectricBsdf{1.5F, Rgb(1)})})
        for (int i = 0; i < 64; ++i) {
            BsdfSample s;
            REQUIRE(sampleBsdf(bsdf, directionAt(80, 0), (static_cast<float>(i) + 0.5F) / 64, {0, 0}, s));
            CHECK(s.weight.x == Approx(1));
        }
}
