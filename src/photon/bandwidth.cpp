#include "photon/bandwidth.h"

#include <array>

#include "photon/denser_blocks.h"
#include "photon/elongation.h"
#include "photon/power_moments.h"

namespace lsde {

namespace {

constexpr int kMostLevels = 24;
// Standard errors by which the power in a ring may differ from that in the disc of equal area within it.
constexpr double kRingTolerance = 3;
// And by which the power in a disc may lie to one side. Brightness that rises steadily lies there as well, without
// harm; half a disc in the dark is plainer than that. Where colours meet, each channel changes by a part only.
constexpr double balanceTolerance(size_t signals) { return signals == 1 ? 5 : 3; }

// The photons between one radius and the next smaller one.
template <size_t kSignals>
struct Ring {
    double count = 0;
    uint32_t dense = 0;  // photons among many more than the estimate has, see DenserBlocks
    std::array<Moments, kSignals> signals;

    void add(const std::array<float, kSignals>& powers, Vec3 offset, double d2) {
        ++count;
        for (size_t s = 0; s < kSignals; ++s)
            signals[s].add(static_cast<double>(powers[s]), square(static_cast<double>(powers[s])), offset, d2);
    }
    // A part of a block. d2: mean, by power.
    void add(const BlockSums& b, float part, Vec3 offset, float d2) {
        count += static_cast<double>(part * static_cast<float>(b.count));
        const float power = part * b.total;
        signals[0].add(static_cast<double>(power), static_cast<double>(part * b.totalSquared), offset,
                       static_cast<double>(d2));
    }
    void add(const Ring& r) {
        count += r.count;
        for (size_t s = 0; s < kSignals; ++s) signals[s].add(r.signals[s]);
    }
};

template <size_t kSignals>
class RadiusSearch {
  public:
    RadiusSearch(const PhotonSource& source, uint32_t photon, const BandwidthRule& rule, BandwidthScratch& scratch)
        : source_(source), photon_(photon), rule_(rule), scratch_(scratch), query_(queryAt(source, photon)) {}

    // Whether what ended the search was the light.
    bool atEdge() const { return atEdge_; }

    Bandwidth run() {
        source_.extent.around(query_.point.position, query_.point.ng, query_.maxRadius, scratch_.surface);
        r0_ = std::visit([&](const auto& index) { return distanceTo(index, rule_.leastCount); }, source_.index);
        isDense_ = DenserBlocks(source_.photons(), query_.sideNormal, rule_.leastCount, r0_);
        if (r0_ >= query_.maxRadius) return {query_.maxRadius, static_cast<uint32_t>(scratch_.density.accepted.size())};
        atEdge_ = true;
        int known = 0;
        Ring<kSignals> within;
        double areaWithin = 0;
        for (int level = 0;; ++level) {
            if (level == known) {
                const int more = std::min(known + (4 * within.count > rule_.mostCount ? 1 : 2), kMostLevels);
                if (within.count < kLeastOfBlocks || !fillByBlocks(known, more))
                    std::visit([&](const auto& index) { fillRings(index, known, more); }, source_.index);
                known = more;
            }
            const float r2 = r0_ * r0_ * static_cast<float>(1 << level);
            const Ring<kSignals>& ring = rings_[static_cast<size_t>(level)];
            // Light that sets in at an edge is plain in the ring, long before the kernel, which ends there, takes it
            // in.
            if (level > 0 && reachesDenser(ring, within)) return atLevel(level - 1, within.count);
            const double area = discArea(level);
            if (level > 0 && anotherPower(ring, within, std::max(0.0, area / areaWithin - 1)))
                return atLevel(level - 1, within.count);
            areaWithin = area;
            within.add(ring);
            // On an edge discs agree with each other at whatever radius: each is half lit.
            if (level > 0 && scratch_.surface.whole() && toOneSide(within))
                return atLevel(level - 1, within.count - ring.count);
            estimate(level, within, r2);
            if (!consistent(level)) return atLevel(level - 1, within.count - ring.count);
            const bool last = level + 1 == kMostLevels || 2 * r2 > square(query_.maxRadius) ||
                              2 * within.count > static_cast<double>(rule_.mostCount);
            if (last) {
                atEdge_ = false;
                return atLevel(level, within.count);
            }
        }
    }

  private:
    // Of what creases leave of a level's disc, in those of the least disc.
    double discArea(int level) const {
        const float share = scratch_.surface.areaShare(std::min(radiusOf(level), query_.maxRadius));
        return static_cast<double>(share * static_cast<float>(1 << level));
    }
    bool reachesDenser(const Ring<kSignals>& ring, const Ring<kSignals>& within) const {
        return ring.dense >= kFewDense + static_cast<double>(rule_.denseTolerance) * std::sqrt(within.count);
    }
    // area: of the ring, over the disc's.
    static bool anotherPower(const Ring<kSignals>& ring, const Ring<kSignals>& within, double area) {
        for (size_t s = 0; s < kSignals; ++s) {
            const Moments &outer = ring.signals[s], &inner = within.signals[s];
            if (square(outer.p - area * inner.p) > square(kRingTolerance) * (outer.pp + square(area) * inner.pp))
                return true;
        }
        return false;
    }
    static bool toOneSide(const Ring<kSignals>& within) {
        return std::any_of(within.signals.begin(), within.signals.end(), [](const Moments& m) {
            return liesToOneSide(m.moment, m.ppd2, balanceTolerance(kSignals));
        });
    }
    void estimate(int level, const Ring<kSignals>& within, float r2) {
        const float share = scratch_.surface.share(std::min(std::sqrt(r2), query_.maxRadius));
        for (size_t s = 0; s < kSignals; ++s)
            estimates_[s][static_cast<size_t>(level)] = estimateOf(within.signals[s], r2, share);
    }
    // With the estimates of all smaller levels.
    bool consistent(int level) const {
        for (const auto& estimates : estimates_) {
            const Estimate& e = estimates[static_cast<size_t>(level)];
            for (int smaller = 0; smaller < level; ++smaller) {
                // The difference's variance if light were as even as the larger one has it. The smaller one's own would
                // be low where it is too low itself, which would choose radii by their error's sign.
                const double variance = e.variance * static_cast<double>(1 << (level - smaller));
                if (square(e.value - estimates[static_cast<size_t>(smaller)].value) >
                    square(rule_.tolerance) * variance)
                    return false;
            }
        }
        return true;
    }

    Bandwidth atLevel(int level, double count) const { return {radiusOf(level), static_cast<uint32_t>(count)}; }

    template <typename Index>
    float distanceTo(const Index& index, uint32_t count) {
        DensityQuery query = query_;
        query.minCount = count + 1;  // the photon itself is one
        return gatherPhotons(index, query, scratch_.density, [](uint32_t, float) {}).radius;
    }

    float radiusOf(int level) const { return r0_ * std::sqrt(static_cast<float>(1 << level)); }
    // 0: within r0; l: between r0 2^((l-1)/2) and r0 2^(l/2).
    int levelOf(float entrySquared) const { return octaveOf(entrySquared / (r0_ * r0_)); }

    // Levels [from, to).
    template <typename Index>
    void fillRings(const Index& index, int from, int to) {
        const float radius = std::min(radiusOf(to - 1), query_.maxRadius);
        index.within(query_.point.position, radius, scratch_.density.found);
        acceptPhotons(index.tree(), query_, radius, scratch_.density.found, scratch_.density.accepted);
        addPhotons(from, to);
    }

    // What was filled before photon by photon ends at a circle; blocks that it cuts are filled so as well.
    bool fillByBlocks(int from, int to) {
        constexpr float kLargest = 0.45F;  // so that those reach into the next ring at most
        const bool first = firstByBlocks_ < 0;
        const int start = first ? from : firstByBlocks_;
        const float radius = std::min(radiusOf(to - 1), query_.maxRadius), inner = radiusOf(start - 1);
        const auto countsAsOne = [&](const BlockSums& sums, float distance) {
            return sums.radius <= kLargest * inner && (!first || std::fabs(distance - inner) > sums.radius);
        };
        if (!acceptByBlocks(source_, photon_, query_, radius, scratch_, countsAsOne)) return false;
        firstByBlocks_ = start;
        for (const DensityScratch::Candidate& c : scratch_.acceptedBlocks) addBlock(c, from, to);
        addPhotons(from, to);
        return true;
    }

    // To each ring that it reaches the part that lies there, as if its photons were even between two circles.
    void addBlock(const DensityScratch::Candidate& c, int from, int to) {
        const uint32_t block = c.index / kBlockSize;
        const BlockSums& sums = (*source_.blocks)[block];
        if (!scratch_.surface.whole() && scratch_.surface.hides(sums.centre)) return;
        const float distance = std::sqrt(c.entrySquared()), offPlane = c.entrySquared() - c.distanceSquared;
        // Of a square of that spread, half along the way from the middle, half across it. What is off the plane enters
        // as a whole.
        const float wide = offPlane > 0 ? 0 : std::min(std::sqrt(1.5F * sums.spread), sums.radius);
        const float half = std::max(wide, 1e-6F * distance), last = distance + half;
        float begin = std::max(0.0F, distance - half);
        for (int level = levelOf(square(begin)); level < to && begin < last; ++level) {
            const float end = std::min(radiusOf(level), last);
            if (level >= from && end > begin) {
                const float middle = 0.5F * (begin + end), part = (end - begin) / (2 * half);
                const float d2 = square(middle) - offPlane + square(end - begin) / 12 + 0.5F * sums.spread;
                Ring<kSignals>& ring = rings_[static_cast<size_t>(level)];
                ring.add(sums, part, (middle / distance) * (sums.centre - query_.point.position), d2);
                if (part > 0.5F && isDense_(block)) ring.dense += sums.count;
            }
            begin = std::max(begin, end);
        }
    }

    void addPhotons(int from, int to) {
        const PhotonTreeView& tree = source_.photons();
        for (const DensityScratch::Candidate& c : scratch_.density.accepted) {
            const int level = levelOf(c.entrySquared());
            if (level < from || level >= to || c.index == photon_) continue;
            if (source_.groups[c.index] >= source_.groupCount) continue;
            if (!scratch_.surface.whole() && scratch_.surface.hides(tree.position(c.index))) continue;
            Ring<kSignals>& ring = rings_[static_cast<size_t>(level)];
            ring.add(signalsOf<kSignals>(tree.payload[c.index]), tree.position(c.index) - query_.point.position,
                     c.distanceSquared);
            if (level > 0 && isDense_(c.index / kBlockSize)) ++ring.dense;
        }
    }

    const PhotonSource& source_;
    uint32_t photon_;
    const BandwidthRule& rule_;
    BandwidthScratch& scratch_;
    DensityQuery query_;
    float r0_ = 0;  // m
    bool atEdge_ = false;
    DenserBlocks isDense_;
    int firstByBlocks_ = -1;  // the first level that was filled by blocks
    std::array<Ring<kSignals>, kMostLevels> rings_{};
    std::array<std::array<Estimate, kMostLevels>, kSignals> estimates_;
};

}  // namespace

DensityQuery queryAt(const PhotonSource& source, uint32_t photon) {
    const PhotonTreeView& photons = source.photons();
    const PhotonPayload& at = photons.payload[photon];
    DensityQuery query;
    query.point.position = photons.position(photon);
    query.point.ng = query.point.ns = unpackNormal(at.normal);
    query.sideNormal = landedSide(at);
    query.medium = at.medium;
    query.maxRadius = source.maxRadius;
    query.minRadius = leastRadius(query.point.position);
    return query;
}

Bandwidth consistentBandwidth(const PhotonSource& source, uint32_t photon, const BandwidthRule& rule,
                              BandwidthScratch& scratch) {
    if (source.dispersed) return RadiusSearch<3>(source, photon, rule, scratch).run();
    RadiusSearch<1> radii(source, photon, rule, scratch);
    const Bandwidth disc = radii.run();
    return radii.atEdge() ? elongated(source, photon, disc, rule, scratch) : disc;
}

}  // namespace lsde
