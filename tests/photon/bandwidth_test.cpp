#include "photon/bandwidth.h"

#include <doctest/doctest.h>

#include "photon/square.h"
#include "support/statistics.h"

using namespace lsde;
using test::kSquareRule;
using test::Random;
using test::Square;

namespace {

Vec3 positionOf(const Square& square, uint32_t photon) { return view(square.tree).position(photon); }

}  // namespace

TEST_CASE("where light is even the bandwidth grows as far as it may") {
    const Square square(1, 20'000, 1);
    BandwidthScratch scratch;
    Random random(2);
    int wide = 0;
    for (int i = 0; i < 200; ++i) {
        const auto photon = static_cast<uint32_t>(random.uniform() * static_cast<float>(square.tree.count));
        const Vec3 p = positionOf(square, photon);
        if (std::max(std::fabs(p.x), std::fabs(p.y)) > 0.8F) continue;
        const Bandwidth b = consistentBandwidth(square.source(), photon, kSquareRule, scratch);
        CHECK(b.count <= 1200);
        CHECK(b.count == doctest::Approx(20'000 * b.area()).epsilon(0.5));
        wide += b.count >= 450 ? 1 : 0;
    }
    CHECK(wide > 90);
}

TEST_CASE("clumps of a few photons end a bandwidth, or do not where the rule says so") {
    // Copies of paths that met again: a millimetre wide, one clump among five hundred photons.
    const auto meanRadius = [](bool clumps, float denseTolerance) {
        Square square(15, 20'000, 1);
        Random random(16);
        std::vector<Photon> photons;
        for (uint32_t i = 0; i < square.tree.count; ++i) photons.push_back(test::photonAt(positionOf(square, i), i));
        for (int clump = 0; clumps && clump < 160; ++clump) {
            const Vec3 at(random.between(-1, 1), random.between(-1, 1), 0);
            for (uint32_t i = 0; i < kBlockSize; ++i) {
                const Vec3 beside(random.uniform(), random.uniform(), 0);
                photons.push_back(test::photonAt(at + 1e-3F * beside, random.bits()));
                photons.back().light = 1;
            }
        }
        square.tree = test::treeOf(photons);
        square.index = AnyIndex(KdIndex(view(square.tree)));
        square.groups.assign(square.tree.count, 0);
        square.sumBlocks();
        BandwidthRule rule = kSquareRule;
        rule.denseTolerance = denseTolerance;
        BandwidthScratch scratch;
        test::Mean radius;
        for (uint32_t i = 0; i < square.tree.count; i += 31) {
            const Vec3 p = positionOf(square, i);
            if (std::max(std::fabs(p.x), std::fabs(p.y)) > 0.8F || square.tree.payload[i].light == 1) continue;
            radius.add(static_cast<double>(consistentBandwidth(square.source(), i, rule, scratch).radius));
        }
        return radius.value();
    };
    const double even = meanRadius(false, 0);
    const double ended = meanRadius(true, 0) / even, goesOn = meanRadius(true, 1) / even;
    MESSAGE("of even light's radius ", ended, ", tolerant ", goesOn);
    CHECK(ended < 0.75);
    CHECK(goesOn > 0.8);
}

TEST_CASE("beside a crease even light has bandwidths as wide as in the open") {
    Square square(14, 20'000, 1);
    BandwidthScratch scratch;
    const auto widths = [&] {
        test::Mean radius;
        for (uint32_t i = 0; i < square.tree.count; i += 3) {
            const Vec3 p = positionOf(square, i);
            if (p.x > -0.01F || p.x < -0.06F || std::fabs(p.y) > 0.8F) continue;
            radius.add(static_cast<double>(consistentBandwidth(square.source(), i, kSquareRule, scratch).radius));
        }
        return radius.value();
    };
    const double open = widths();
    const std::vector<Segment> crease = {{{0, -1, 0}, {0, 1, 0}}};
    square.extent = SurfaceExtent(crease);
    CHECK(widths() > open);  // it takes more for as many photons
}

TEST_CASE("a bandwidth ends at an edge, on its dark side as well") {
    const Square square(3, 2000, 50);
    BandwidthScratch scratch;
    double beyond = 0;
    int dark = 0;
    for (uint32_t i = 0; i < square.tree.count; ++i) {
        const Vec3 p = positionOf(square, i);
        if (p.x > 0 || p.x < -0.2F || std::fabs(p.y) > 0.7F) continue;
        const Bandwidth b = consistentBandwidth(square.source(), i, kSquareRule, scratch);
        beyond += std::max(0.0F, b.radius + p.x);
        ++dark;
    }
    MESSAGE("beyond the edge on average: ", beyond / dark, " m");
    // The least disc holds 20 photons, on the dark side within 6 cm, and there reaches a little into the bright one.
    CHECK(beyond / dark < 0.002);
}

TEST_CASE("no bandwidth on the dark side reaches far beyond an edge") {
    float most = 0;
    for (uint32_t seed = 3; seed < 6; ++seed) {
        const Square square(seed, 2000, 50);
        BandwidthScratch scratch;
        for (uint32_t i = 0; i < square.tree.count; ++i) {
            const Vec3 p = positionOf(square, i);
            if (p.x > 0 || p.x < -0.2F || std::fabs(p.y) > 0.7F) continue;
            most = std::max(most, consistentBandwidth(square.source(), i, kSquareRule, scratch).radius + p.x);
        }
    }
    MESSAGE("beyond the edge at most: ", most, " m");
    // Least discs on the edge have 20 photons, of the bright half: 1.1 cm. Twice that, and the next radius: 3.1 cm.
    CHECK(most < 0.032F);
}

TEST_CASE("photons of no group do not count") {
    const Square square(8, 20'000, 1);
    BandwidthScratch scratch;
    int wide = 0;
    for (uint32_t i = 0; i < square.tree.count; i += 400) {
        const Vec3 p = positionOf(square, i);
        if (std::max(std::fabs(p.x), std::fabs(p.y)) > 0.8F) continue;
        const Bandwidth b = consistentBandwidth(square.source(1), i, kSquareRule, scratch);
        if (b.count < 200) continue;
        CHECK(b.count == doctest::Approx(10'000 * b.area()).epsilon(0.35));
        ++wide;
    }
    CHECK(wide > 50);
}

TEST_CASE("a bandwidth ends where the power of the photons changes and not their number") {
    Square square(9, 20'000, 1);
    for (uint32_t i = 0; i < square.tree.count; ++i)
        if (positionOf(square, i).x > 0) square.tree.payload[i].power = packPower(Rgb(50, 100, 150), i);
    square.sumBlocks();
    BandwidthScratch scratch;
    double reaching = 0, there = 0;
    for (uint32_t i = 0; i < square.tree.count; i += 10) {
        const Vec3 p = positionOf(square, i);
        // Far enough for a least disc to be dark; the largest, of 1000 photons, would reach 12 cm.
        if (p.x > -0.03F || p.x < -0.06F || std::fabs(p.y) > 0.7F) continue;
        ++there;
        reaching += consistentBandwidth(square.source(), i, kSquareRule, scratch).radius + p.x > 0.02F ? 1 : 0;
    }
    REQUIRE(there > 50);
    CHECK(reaching / there < 0.05);
}

TEST_CASE("a bandwidth does not depend on what its memory was used for before") {
    const Square square(10, 5000, 20);
    BandwidthScratch used;
    Random random(11);
    for (int i = 0; i < 1000; ++i) {
        const uint32_t photon = random.bits() % static_cast<uint32_t>(square.tree.count);
        BandwidthScratch fresh;
        const Bandwidth a = consistentBandwidth(square.source(), photon, kSquareRule, used);
        const Bandwidth b = consistentBandwidth(square.source(), photon, kSquareRule, fresh);
        REQUIRE(a.radius == b.radius);
        REQUIRE(a.count == b.count);
    }
}

TEST_CASE("where there are fewer photons than the least disc holds the bandwidth is the largest radius") {
    const Square square(12, 5, 1);
    REQUIRE(square.tree.count > 5);
    BandwidthScratch scratch;
    for (uint32_t i = 0; i < square.tree.count; ++i)
        CHECK(consistentBandwidth(square.source(), i, kSquareRule, scratch).radius == 0.5F);
}

TEST_CASE("a bandwidth ends where the colour of dispersed light changes, though its brightness does not") {
    // Two wavelengths with weights that sum to the same, one either side of the edge.
    Square square(9, 20'000, 1);
    constexpr WavelengthId kBlue = 400, kRed = 3600;
    const auto sum = [](Rgb c) { return c.x + c.y + c.z; };
    WavelengthId red = kRed;
    while (std::fabs(sum(wavelengthWeight(red)) - sum(wavelengthWeight(kBlue))) > 0.02F) --red;
    for (uint32_t i = 0; i < square.tree.count; ++i)
        square.tree.payload[i].wavelength = positionOf(square, i).x < 0 ? kBlue : red;
    square.index = AnyIndex(KdIndex(view(square.tree)));
    square.sumBlocks();
    BandwidthScratch scratch;
    float beyond[2] = {0, 0};
    for (const bool dispersed : {false, true})
        for (uint32_t i = 0; i < square.tree.count; i += 7) {
            const Vec3 p = positionOf(square, i);
            if (p.x > -0.02F || p.x < -0.1F || std::fabs(p.y) > 0.8F) continue;
            PhotonSource source = square.source();
            source.dispersed = dispersed;
            beyond[dispersed ? 1 : 0] =
                std::max(beyond[dispersed ? 1 : 0], consistentBandwidth(source, i, kSquareRule, scratch).radius + p.x);
        }
    MESSAGE("beyond the edge at most: ", beyond[0], " and ", beyond[1], " m");
    CHECK(beyond[0] > 0.05F);
    CHECK(beyond[1] < 0.02F);
}

TEST_CASE("block by block bandwidths are as wide as photon by photon") {
    constexpr BandwidthRule kWide{20, 8000, 2.5F};
    for (const float contrast : {1.0F, 1.4F}) {
        test::Mean ratio, count;
        int same = 0, compared = 0;
        for (uint32_t seed = 20; seed < 25; ++seed) {
            const Square square(seed, 40'000, contrast);
            BandwidthScratch scratch;
            for (uint32_t i = 0; i < square.tree.count; i += 100) {
                const Vec3 p = positionOf(square, i);
                if (std::max(std::fabs(p.x), std::fabs(p.y)) > 0.6F) continue;
                const Bandwidth a = consistentBandwidth(square.source(2, true), i, kWide, scratch);
                const Bandwidth b = consistentBandwidth(square.source(2, false), i, kWide, scratch);
                ratio.add(std::log2(static_cast<double>(a.radius / b.radius)));
                same += a.radius == b.radius ? 1 : 0;
                ++compared;
                if (a.radius == b.radius) count.add(static_cast<double>(a.count) / std::max(1U, b.count));
            }
        }
        MESSAGE("contrast ", contrast, ": log2 of the ratio ", ratio.value(), ", the same ", same, " of ", compared);
        CHECK(compared > 1000);
        CHECK(std::fabs(ratio.value()) < 0.015);
        CHECK(same > 0.85 * compared);
        CHECK(count.value() == doctest::Approx(1).epsilon(0.003));
    }
}
