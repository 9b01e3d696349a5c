// What every Bsdf has to keep, checked over the table of rows.h.
#include "bsdf/bsdf.h"

#include <doctest/doctest.h>

#include <array>
#include <functional>
#include <map>
#include <numbers>
#include <optional>

#include "bsdf/rows.h"
#include "support/chi_squared.h"
#include "support/random.h"

using namespace lsde;
using doctest::Approx;
using test::bsdfDirections;
using test::BsdfRow;
using test::bsdfRows;

namespace {

void checkEqual(Rgb a, Rgb b, double epsilon) {
    for (int c = 0; c < 3; ++c) CHECK(a[c] == Approx(b[c]).epsilon(epsilon));
}

LobeEval lobeOf(const BsdfEval& e, Event event) { return event == Event::Glossy ? e.glossy : e.diffuse; }

using Rgb64 = glm::dvec3;  // for sums

// f times cosine of the non-delta lobes, integrated over all directions.
Rgb64 reflectanceByQuadrature(const Bsdf& bsdf, Vec3 wo) {
    const test::SquareGrid grid{40, 40, 6};
    Rgb64 sum(0);
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x)
            sum += test::integrateCell(grid, x, y, [&](double s, double t) {
                const Vec3 wi = test::sphereFromSquare(s, t);
                const BsdfEval e = evalBsdf(bsdf, wo, wi);
                return Rgb64(e.diffuse.f + e.glossy.f) * (4 * std::numbers::pi * std::fabs(wi.z));
            });
    return sum;
}

// Of a row of the table, found once: it takes a million evaluations.
const Rgb64& rowReflectance(const Bsdf& bsdf, Vec3 wo) {
    static std::map<std::pair<const Bsdf*, float>, Rgb64> known;
    const auto [at, added] = known.try_emplace({&bsdf, wo.z});
    if (added) at->second = reflectanceByQuadrature(bsdf, wo);
    return at->second;
}

// Mean and standard error of the samples' weights.
struct MeanWeight {
    Rgb64 sum{0}, squares{0};
    double samples = 0;

    void add(Rgb weight) {
        sum += Rgb64(weight);
        squares += square(Rgb64(weight));
    }
    Rgb64 mean() const { return sum / samples; }
    Rgb64 standardError() const { return glm::sqrt(glm::max(squares / samples - square(mean()), Rgb64(0)) / samples); }
};

struct SampledReflectance {
    std::array<MeanWeight, kEventCount> byEvent;
    MeanWeight total;
};

using SampleFunction = bool (*)(const Bsdf&, Vec3, float, Vec2, BsdfSample&);

SampledReflectance sampledReflectance(const Bsdf& bsdf, Vec3 wo, SampleFunction draw, uint32_t seed) {
    constexpr int kSamples = 40'000;
    test::Random random(seed);
    SampledReflectance out;
    for (MeanWeight& event : out.byEvent) event.samples = kSamples;
    out.total.samples = kSamples;
    for (int i = 0; i < kSamples; ++i) {
        BsdfSample s;
        const float uLobe = random.uniform();
        if (!draw(bsdf, wo, uLobe, random.uniform2D(), s)) continue;
        out.byEvent[static_cast<size_t>(s.event)].add(s.weight);
        out.total.add(s.weight);
    }
    return out;
}

// Of sums that are known to some standard error, and of rounding.
double tolerance(double standardError) { return 4.5 * standardError + 1e-4; }

Rgb64 deltaReflectance(const Bsdf& bsdf, Vec3 wo) {
    const DeltaLobes lobes = deltaLobes(bsdf, wo);
    Rgb64 sum(0);
    for (int i = 0; i < lobes.count; ++i) sum += Rgb64(lobes.lobe[static_cast<size_t>(i)].weight);
    return sum;
}

// Runs f over the table and the directions, naming both in failures.
void forEachRow(const std::function<void(const Bsdf&, Vec3 wo)>& f) {
    for (const BsdfRow& row : bsdfRows())
        for (const Vec3 wo : bsdfDirections()) {
            CAPTURE(row.name);
            CAPTURE(wo.z);
            f(row.bsdf, wo);
        }
}

}  // namespace

TEST_CASE("directions are drawn with the density that evaluation states, lobe by lobe" *
          doctest::test_suite("statistics")) {
    int tests = 0;
    for (const BsdfRow& row : bsdfRows())
        tests += (hasDiffuseLobe(row.bsdf) ? 4 : 0) + (hasGlossyLobe(row.bsdf) ? 4 : 0);
    test::Random random(1);
    forEachRow([&](const Bsdf& bsdf, Vec3 wo) {
        for (const Event event : {Event::Diffuse, Event::Glossy}) {
            if (!(event == Event::Diffuse ? hasDiffuseLobe(bsdf) : hasGlossyLobe(bsdf))) continue;
            const auto sample = [&]() -> std::optional<Vec3> {
                BsdfSample s;
                const float uLobe = random.uniform();
                if (!sampleBsdf(bsdf, wo, uLobe, random.uniform2D(), s) || s.event != event) return std::nullopt;
                return s.wi;
            };
            const auto pdf = [&](Vec3 wi) { return lobeOf(evalBsdf(bsdf, wo, wi), event).pdfW; };
            const test::ChiSquaredResult result = test::chiSquaredOnSphere({40, 40, 6, 100'000}, sample, pdf);
            CAPTURE(static_cast<int>(event));
            CAPTURE(result.p);
            CHECK(result.accepted(tests));
        }
    });
}

TEST_CASE("a sample's weight is f cos over pdf, and its densities are those of evaluation both ways") {
    test::Random random(2);
    forEachRow([&](const Bsdf& bsdf, Vec3 wo) {
        for (int i = 0; i < 300; ++i) {
            BsdfSample s;
            const float uLobe = random.uniform();
            if (!sampleBsdf(bsdf, wo, uLobe, random.uniform2D(), s) || s.delta) continue;
            const LobeEval there = lobeOf(evalBsdf(bsdf, wo, s.wi), s.event);
            const LobeEval back = lobeOf(evalBsdf(bsdf, s.wi, wo), s.event);
            REQUIRE(glm::length(s.wi) == Approx(1).epsilon(1e-5));
            REQUIRE(s.pdfW > 0);
            checkEqual(s.weight * s.pdfW, there.f * std::fabs(s.wi.z), 2e-3);
            CHECK(s.pdfW == Approx(there.pdfW).epsilon(1e-3));
            CHECK(s.reversePdfW == Approx(there.reversePdfW).epsilon(1e-3));
            CHECK(s.reversePdfW == Approx(back.pdfW).epsilon(1e-3));
            CHECK(s.eta == evalBsdf(bsdf, wo, s.wi).eta);
            CHECK(s.transmitted == (s.wi.z * wo.z < 0));
            CHECK((!s.transmitted || glossyLobePasses(bsdf)));
        }
    });
}

TEST_CASE("light scatters the same there and back, but for eta squared where it changes the medium") {
    test::Random random(3);
    for (const BsdfRow& row : bsdfRows())
        for (int i = 0; i < 500; ++i) {
            const Vec2 u = random.uniform2D(), v = random.uniform2D();
            const Vec3 wo = test::sphereFromSquare(u.x, u.y), wi = test::sphereFromSquare(v.x, v.y);
            const BsdfEval there = evalBsdf(row.bsdf, wo, wi), back = evalBsdf(row.bsdf, wi, wo);
            CAPTURE(row.name);
            CHECK(there.eta * back.eta == Approx(1));
            for (const Event event : {Event::Diffuse, Event::Glossy}) {
                checkEqual(lobeOf(there, event).f, lobeOf(back, event).f * square(there.eta), 1e-4);
                CHECK(lobeOf(there, event).reversePdfW == Approx(lobeOf(back, event).pdfW).epsilon(1e-4));
            }
        }
}

TEST_CASE("who asks for less gets the same of it") {
    test::Random random(4);
    for (const BsdfRow& row : bsdfRows())
        for (int i = 0; i < 200; ++i) {
            const Vec2 u = random.uniform2D(), v = random.uniform2D();
            const Vec3 wo = test::sphereFromSquare(u.x, u.y), wi = test::sphereFromSquare(v.x, v.y);
            const BsdfEval all = evalBsdf(row.bsdf, wo, wi);
            CAPTURE(row.name);
            CHECK(evalBsdf(row.bsdf, wo, wi, Asked::DiffuseF).diffuse.f == all.diffuse.f);
            const BsdfEval f = evalBsdf(row.bsdf, wo, wi, Asked::F);
            CHECK(f.diffuse.f == all.diffuse.f);
            CHECK(f.glossy.f == all.glossy.f);
            CHECK(f.eta == all.eta);
        }
}

TEST_CASE("sampling and quadrature find the same reflectance" * doctest::test_suite("statistics")) {
    uint32_t seed = 4;
    forEachRow([&](const Bsdf& bsdf, Vec3 wo) {
        const MeanWeight sampled = sampledReflectance(bsdf, wo, sampleBsdf, seed++).total;
        const Rgb64 exact = rowReflectance(bsdf, wo) + deltaReflectance(bsdf, wo);
        for (int c = 0; c < 3; ++c)
            CHECK(std::fabs(sampled.mean()[c] - exact[c]) <= tolerance(sampled.standardError()[c]));
    });
}

TEST_CASE("no surface gives back more light than it gets, but for the glTF mix at a slant") {
    forEachRow([](const Bsdf& bsdf, Vec3 wo) {
        const float reflectance = maxComponent(Rgb(rowReflectance(bsdf, wo) + deltaReflectance(bsdf, wo)));
        // Where both lobes are there: see metal_rough.h; of sheen at a slant: see sheen.h.
        const bool mix = hasDiffuseLobe(bsdf) && (hasGlossyLobe(bsdf) || hasDelta(bsdf));
        CHECK(reflectance <= (mix && std::fabs(wo.z) < 0.3F ? 1.2F : 1.0005F));
    });
}

TEST_CASE("delta lobes and samples of the rest add up to samples of the whole, event by event" *
          doctest::test_suite("statistics")) {
    uint32_t seed = 5;
    forEachRow([&](const Bsdf& bsdf, Vec3 wo) {
        const SampledReflectance whole = sampledReflectance(bsdf, wo, sampleBsdf, seed++);
        const SampledReflectance rest = sampledReflectance(bsdf, wo, sampleNonDelta, seed++);
        constexpr auto kSpecular = static_cast<size_t>(Event::Specular);
        CHECK(rest.byEvent[kSpecular].sum == Rgb64(0));
        const Rgb64 delta = deltaReflectance(bsdf, wo);
        for (size_t e = 0; e < kEventCount; ++e)
            for (int c = 0; c < 3; ++c) {
                const double split = e == kSpecular ? delta[c] : rest.byEvent[e].mean()[c];
                const double error = whole.byEvent[e].standardError()[c] + rest.byEvent[e].standardError()[c];
                CHECK(std::fabs(whole.byEvent[e].mean()[c] - split) <= tolerance(error));
            }
    });
}

TEST_CASE("nothing is infinite, negative or not a number from the pole to the horizon and beyond") {
    const std::array<float, 9> heights = {1, 0.99999994F, 0.5F, 1e-3F, 1e-6F, 1e-20F, 1e-38F, 0.0F, -1e-6F};
    const std::array<float, 4> numbers = {0, 1e-7F, 0.5F, kOneMinusEpsilon};
    std::vector<BsdfRow> rows = bsdfRows();
    for (const float roughness : {1e-6F, 1e-3F, 0.05F})
        rows.push_back({"tiny roughness", MetalRoughBsdf{Rgb(0.5F), Rgb(0.04F), 1, 0.5F, roughness}});
    const auto sound = [](Rgb f) { return isFinite(f) && std::min({f.x, f.y, f.z}) >= 0; };
    const auto density = [](float pdf) { return std::isfinite(pdf) && pdf >= 0; };
    const auto along = [](float z, float azimuth) {
        const float r = safeSqrt(1 - z * z);
        return Vec3(r * std::cos(azimuth), r * std::sin(azimuth), z);
    };
    for (const BsdfRow& row : rows)
        for (const float z : heights) {
            const Vec3 wo = along(z, 0.3F);
            CAPTURE(row.name);
            CAPTURE(z);
            for (const float zi : heights)
                for (const float azimuth : {0.3F, 2.0F, 0.3F + kPi}) {
                    const BsdfEval e = evalBsdf(row.bsdf, wo, along(zi, azimuth));
                    for (const LobeEval& lobe : {e.diffuse, e.glossy}) {
                        REQUIRE(sound(lobe.f));
                        REQUIRE(density(lobe.pdfW));
                        REQUIRE(density(lobe.reversePdfW));
                        if (z == 0 || zi == 0) REQUIRE(isBlack(lobe.f));
                    }
                }
            for (const float uLobe : numbers)
                for (const float x : numbers)
                    for (const float y : numbers) {
                        BsdfSample s;
                        const bool drawn = sampleBsdf(row.bsdf, wo, uLobe, {x, y}, s);
                        if (z == 0) REQUIRE_FALSE(drawn);
                        if (!drawn) continue;
                        REQUIRE(sound(s.weight));
                        REQUIRE(density(s.pdfW));
                        REQUIRE(density(s.reversePdfW));
                        REQUIRE(glm::length(s.wi) == Approx(1).epsilon(1e-5));
                    }
            if (z == 0) REQUIRE(deltaLobes(row.bsdf, wo).count == 0);
        }
}

TEST_CASE("a Bsdf says what lobes it has") {
    struct Expected {
        bool delta, diffuse, glossy;
    };
    const auto lobes = [](const std::string& name) {
        for (const BsdfRow& row : bsdfRows())
            if (row.name == name)
                return Expected{hasDelta(row.bsdf), hasDiffuseLobe(row.bsdf), hasGlossyLobe(row.bsdf)};
        FAIL("no row ", name);
        return Expected{};
    };
    const auto check = [&](const std::string& name, Expected expected) {
        const Expected found = lobes(name);
        CAPTURE(name);
        CHECK(found.delta == expected.delta);
        CHECK(found.diffuse == expected.diffuse);
        CHECK(found.glossy == expected.glossy);
    };
    check("black", {false, false, false});
    check("Lambert", {false, true, false});
    check("mirror", {true, false, false});
    check("glass", {true, false, false});
    check("pane", {true, false, false});
    check("fine metal", {false, false, true});
    check("smooth metal", {true, false, false});
    check("glossy plastic", {false, true, true});
    check("smooth plastic", {true, true, false});
    check("coat on black", {false, false, true});
    check("no coat", {false, true, false});
}

TEST_CASE("a sample's class is that of its lobe: glossy below the threshold of roughness, diffuse from it on") {
    const auto metal = [](float roughness) { return Bsdf(MetalRoughBsdf{Rgb(1), Rgb(0.04F), 1, 1, roughness}); };
    CHECK(glossyClass(metal(0)) == VertexClass::Bend);
    CHECK(glossyClass(metal(kGlossyRoughness - 0.01F)) == VertexClass::Glossy);
    CHECK(glossyClass(metal(kGlossyRoughness)) == VertexClass::Diffuse);
    BsdfSample s;
    REQUIRE(sampleBsdf(metal(0.1F), {0, 0, 1}, 0.5F, {0.4F, 0.3F}, s));
    CHECK(s.event == Event::Glossy);
    CHECK(classOf(metal(0.1F), s) == VertexClass::Glossy);
    CHECK(classOf(metal(0.5F), s) == VertexClass::Diffuse);
    REQUIRE(sampleBsdf(DiffuseBsdf{Rgb(1)}, {0, 0, 1}, 0.5F, {0.4F, 0.3F}, s));
    CHECK(classOf(DiffuseBsdf{Rgb(1)}, s) == VertexClass::Diffuse);
    REQUIRE(sampleBsdf(metal(0), {0, 0, 1}, 0.5F, {0.4F, 0.3F}, s));
    CHECK(s.event == Event::Specular);
    CHECK(classOf(metal(0), s) == VertexClass::Bend);
    const Bsdf pane = ThinDielectricBsdf{};
    const DeltaLobes lobes = deltaLobes(pane, test::directionAt(30, 0));
    CHECK(classOf(pane, lobes.lobe[0]) == VertexClass::Bend);
    CHECK(classOf(pane, lobes.lobe[1]) == VertexClass::Straight);
}

TEST_CASE("albedo is what comes back from above, and never above 1") {
    for (const BsdfRow& row : bsdfRows()) {
        CAPTURE(row.name);
        const Rgb a = albedo(row.bsdf);
        CHECK(std::min({a.x, a.y, a.z}) >= 0);
        CHECK(maxComponent(a) <= 1);
        // Layers take more of the light that comes at a slant.
        if (!hasGlossyLobe(row.bsdf) && !std::holds_alternative<LayeredBsdf>(row.bsdf)) {
            const Rgb exact(reflectanceByQuadrature(row.bsdf, {0, 0, 1}) + deltaReflectance(row.bsdf, {0, 0, 1}));
            // The diffuse lobe's 1 - F(h) falls away from the normal.
            const bool mix = hasDiffuseLobe(row.bsdf) && hasDelta(row.bsdf);
            checkEqual(a, exact, mix ? 0.03 : 1e-4);
        }
    }
    CHECK(albedo(MetalRoughBsdf{Rgb(0.5F), Rgb(0.04F), 1, 0, 0.5F}).x == Approx(0.96 * 0.5 + 0.04));
    CHECK(albedo(MetalRoughBsdf{Rgb(0.5F), Rgb(0.04F), 1, 1, 0.5F}).x == Approx(0.5));
}
