#include "photon/elongation.h"

#include <doctest/doctest.h>

#include "photon/square.h"
#include "support/statistics.h"

using namespace lsde;
using test::kSquareRule;
using test::photonAt;
using test::Random;
using test::Square;

namespace {

// Half of the ellipse's extent along x.
float extentAlongX(const Bandwidth& b) {
    const float share = b.along == Vec3(0) ? 0 : glm::normalize(b.along).x;
    return b.radius * std::sqrt(1 + share * share * (b.stretch() * b.stretch() - 1));
}

}  // namespace

TEST_CASE("discs that end at an edge grow on along it, and do not turn across it") {
    // Bright where x > 0, dark where x < 0; there discs of 20 photons have a radius of 4 cm.
    int ended = 0, longer = 0, reaching = 0, all = 0;
    test::Mean stretch, aligned;
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        const Square square(seed, 4000, 20);
        BandwidthScratch scratch;
        for (uint32_t i = 0; i < square.tree.count; ++i) {
            const Vec3 p = view(square.tree).position(i);
            if (p.x > 0 || p.x < -0.08F || std::fabs(p.y) > 0.6F) continue;
            ++all;
            const Bandwidth b = consistentBandwidth(square.source(), i, kSquareRule, scratch);
            if (b.radius > 2 * -p.x || b.radius > 0.1F) continue;
            ++ended;
            stretch.add(static_cast<double>(b.stretch()));
            reaching += extentAlongX(b) > -p.x + 0.02F ? 1 : 0;
            if (b.along == Vec3(0)) continue;
            ++longer;
            aligned.add(static_cast<double>(std::fabs(glm::normalize(b.along).y)));
        }
    }
    MESSAGE(longer, " of ", ended, " longer, ", all, " in all; stretch ", stretch.value(), ", along the edge ",
            aligned.value(), "; ", reaching, " reach over it");
    CHECK(stretch.value() > 2);
    CHECK(aligned.value() > 0.95);
    CHECK(reaching < ended / 50);
}

TEST_CASE("an ellipse ends where the edge bends away from it") {
    // A bright disc of 10 cm in the dark. Outside of it light is even along its rim for a part of its circumference.
    test::Mean dark;
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        Random random(seed);
        std::vector<Photon> photons;
        for (uint32_t n = random.poisson(4.0 * 2000); n-- > 0;)
            photons.push_back(photonAt({random.between(-1, 1), random.between(-1, 1), 0}, random.bits()));
        for (uint32_t n = random.poisson(4000); n-- > 0;) {
            const float r = 0.1F * std::sqrt(random.uniform()), angle = 2 * kPi * random.uniform();
            photons.push_back(photonAt({r * std::cos(angle), r * std::sin(angle), 0}, random.bits()));
        }
        const PhotonTree tree = test::treeOf(photons);
        const AnyIndex index = KdIndex(view(tree));
        const SurfaceExtent extent;
        const std::vector<uint16_t> groups(tree.count, 0);
        const PhotonSource source{index, extent, groups, 1, 1, 0.5F};
        BandwidthScratch scratch;
        for (uint32_t i = 0; i < tree.count; ++i) {
            const Vec3 p = view(tree).position(i);
            if (glm::length(p) < 0.14F || glm::length(p) > 0.25F) continue;
            const Bandwidth b = consistentBandwidth(source, i, kSquareRule, scratch);
            int within = 0, bright = 0;
            for (uint32_t k = 0; k < tree.count; ++k) {
                const Vec3 q = view(tree).position(k);
                if (!(b.distance(q - p) < b.radius)) continue;
                ++within;
                bright += glm::length(q) < 0.1F ? 1 : 0;
            }
            dark.add(static_cast<double>(bright) / within);
        }
    }
    MESSAGE("share of photons of the bright disc: ", dark.value(), " +- ", dark.standardError());
    // 2.0% if all are discs.
    CHECK(dark.value() < 0.025);
}
