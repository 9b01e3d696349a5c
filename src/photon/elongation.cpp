#include "photon/elongation.h"

#include <algorithm>
#include <array>

#include "photon/denser_blocks.h"
#include "photon/power_moments.h"

namespace lsde {

namespace {

// Of more photons an estimate is no longer noisy enough for the search to pay (of 1000, it took a third of the camera
// pass and left as much error).
constexpr uint32_t kMostInDisc = 300;
constexpr float kMostStretch = 4;
constexpr size_t kSteps = 5;  // to that, each by this factor:
constexpr double kStep = 1.4142135623730950;
constexpr float kSpreadRadii = 3;  // of the disc in which the direction is looked for
// Standard errors by which what an ellipse takes in may differ from what it had. Beyond narrow light it takes in dark,
// and the dark there does not take in light: with 3, a prism's streak lost .23% of its light, with 2 it loses .13%.
constexpr double kTolerance = 2;

// Sums over photons at a distance of q across an axis and t along it (m).
struct AxisMoments {
    double p = 0, pq2 = 0, pt2 = 0;     // of power
    double pp = 0, ppq2 = 0, ppt2 = 0;  // of power^2
    double ppq4 = 0, ppq2t2 = 0, ppt4 = 0;

    void add(double power, double q2, double t2) {
        p += power;
        pq2 += power * q2;
        pt2 += power * t2;
        const double squared = power * power;
        pp += squared;
        ppq2 += squared * q2;
        ppt2 += squared * t2;
        ppq4 += squared * q2 * q2;
        ppq2t2 += squared * q2 * t2;
        ppt4 += squared * t2 * t2;
    }
    void add(const AxisMoments& m) {
        p += m.p;
        pq2 += m.pq2;
        pt2 += m.pt2;
        pp += m.pp;
        ppq2 += m.ppq2;
        ppt2 += m.ppt2;
        ppq4 += m.ppq4;
        ppq2t2 += m.ppq2t2;
        ppt4 += m.ppt4;
    }
    // By Epanechnikov's kernel on an ellipse of half width r, `stretch` times as long: estimateOf with distances^2 of
    // q^2 + (t / stretch)^2.
    Estimate estimate(double r2, double stretch) const {
        const double s2 = square(stretch);
        return estimateOf({p, pq2 + pt2 / s2, pp, ppq2 + ppt2 / s2, ppq4 + (2 * ppq2t2 + ppt4 / s2) / s2}, r2, stretch);
    }
};

// Photons of one ellipse that are not in the next shorter one.
struct Ends {
    uint32_t count = 0, dense = 0;
    AxisMoments power;

    void add(const Ends& e) {
        count += e.count;
        dense += e.dense;
        power.add(e.power);
    }
};

class Elongation {
  public:
    Elongation(const PhotonSource& source, uint32_t photon, const Bandwidth& disc, const BandwidthRule& rule,
               BandwidthScratch& scratch)
        : source_(source),
          photon_(photon),
          disc_(disc),
          rule_(rule),
          scratch_(scratch),
          query_(queryAt(source, photon)),
          reach_(std::min(kMostStretch * disc.radius, query_.maxRadius)) {}

    Bandwidth run() {
        Bandwidth longest = disc_;
        // A kernel that creases cut has a share of a disc, not of an ellipse.
        if (!scratch_.surface.whole() && scratch_.surface.creaseNear(query_.point.position, reach_)) return longest;
        std::visit([&](const auto& index) { find(index); }, source_.index);
        if (!flat() || !findDirection()) return longest;
        sortPhotons();
        Ends within = ends_[0];
        estimate(0, within);
        for (size_t step = 1; step < kSteps; ++step) {
            const float stretch = stretchAt(step);
            if (stretch * disc_.radius > 1.001F * reach_ || !like(ends_[step], within)) break;
            within.add(ends_[step]);
            estimate(step, within);
            if (within.count > rule_.mostCount || !consistent(step)) break;
            longest.count = within.count;
            longest.along = std::sqrt(1 - 1 / square(stretch)) * direction_;
        }
        return longest;
    }

  private:
    static float stretchAt(size_t step) { return std::sqrt(static_cast<float>(1 << step)); }

    template <typename Index>
    void find(const Index& index) {
        index.within(query_.point.position, reach_, scratch_.density.found);
        acceptPhotons(index.tree(), query_, reach_, scratch_.density.found, scratch_.density.accepted);
    }
    // Whether all that was found met one plane. Of a bent surface chords give a disc its area, but not an ellipse.
    bool flat() const {
        const auto& payload = source_.photons().payload;
        return std::all_of(
            scratch_.density.accepted.begin(), scratch_.density.accepted.end(),
            [&](const DensityScratch::Candidate& c) { return payload[c.index].normal == payload[photon_].normal; });
    }
    bool counts(const DensityScratch::Candidate& c) const {
        return c.index != photon_ && source_.groups[c.index] < source_.groupCount;
    }
    Vec3 offsetOf(const DensityScratch::Candidate& c) const {
        return source_.photons().position(c.index) - query_.point.position;
    }
    double powerOf(const DensityScratch::Candidate& c) const {
        return static_cast<double>(signalsOf<1>(source_.photons().payload[c.index])[0]);
    }

    // The main axis of the power's second moments about its centroid, in the tangent plane. False: there is no power.
    bool findDirection() {
        const Frame frame(query_.point.ng);
        double p = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
        for (const DensityScratch::Candidate& c : scratch_.density.accepted) {
            if (!counts(c) || !(c.distanceSquared < square(kSpreadRadii * disc_.radius))) continue;
            const double power = powerOf(c);
            const Vec3 offset = offsetOf(c);
            const auto u = static_cast<double>(glm::dot(offset, frame.x));
            const auto v = static_cast<double>(glm::dot(offset, frame.y));
            p += power;
            x += power * u;
            y += power * v;
            xx += power * u * u;
            xy += power * u * v;
            yy += power * v * v;
        }
        if (!(p > 0)) return false;
        const double difference = (xx - yy) - (x * x - y * y) / p, mixed = xy - x * y / p;
        const auto angle = static_cast<float>(0.5 * std::atan2(2 * mixed, difference));
        direction_ = std::cos(angle) * frame.x + std::sin(angle) * frame.y;
        return true;
    }

    // Each to the shortest ellipse that holds it.
    void sortPhotons() {
        const float r2 = square(disc_.radius);
        DenserBlocks isDense(source_.photons(), query_.sideNormal, disc_.count, disc_.radius);
        for (const DensityScratch::Candidate& c : scratch_.density.accepted) {
            if (!counts(c)) continue;
            const float t2 = square(glm::dot(direction_, offsetOf(c))), q2 = std::max(0.0F, c.distanceSquared - t2);
            if (!(std::max(q2, c.planeSquared) < r2)) continue;
            // q^2 + (t / s)^2 < r^2, of the least s^2, a power of 2
            const auto step = static_cast<size_t>(octaveOf(t2 / (r2 - q2)));
            if (step >= kSteps) continue;
            Ends& ends = ends_[step];
            ++ends.count;
            ends.dense += isDense(c.index / kBlockSize) ? 1 : 0;
            ends.power.add(powerOf(c), static_cast<double>(q2), static_cast<double>(t2));
        }
    }

    // Whether the ends hold light like that within, in power, and in how much of it lies far more densely.
    static bool like(const Ends& ends, const Ends& within) {
        constexpr double kShare = kStep - 1;  // of the area within
        const AxisMoments &outer = ends.power, &inner = within.power;
        if (square(outer.p - kShare * inner.p) > square(kTolerance) * (outer.pp + square(kShare) * inner.pp))
            return false;
        const double expected = kShare * within.dense;
        return ends.dense < expected + kFewDense + kTolerance * std::sqrt((1 + kShare) * expected);
    }
    void estimate(size_t step, const Ends& within) {
        const auto r2 = static_cast<double>(square(disc_.radius)), stretch = static_cast<double>(stretchAt(step));
        estimates_[step] = within.power.estimate(r2, stretch);
    }
    // With those of all shorter ellipses, as discs are with smaller ones.
    bool consistent(size_t step) const {
        const Estimate& e = estimates_[step];
        for (size_t shorter = 0; shorter < step; ++shorter) {
            const double variance = e.variance * static_cast<double>(stretchAt(step) / stretchAt(shorter));
            if (square(e.value - estimates_[shorter].value) > square(static_cast<double>(rule_.tolerance)) * variance)
                return false;
        }
        return true;
    }

    const PhotonSource& source_;
    uint32_t photon_;
    const Bandwidth& disc_;
    const BandwidthRule& rule_;
    BandwidthScratch& scratch_;
    DensityQuery query_;
    float reach_;        // m
    Vec3 direction_{0};  // unit
    std::array<Ends, kSteps> ends_{};
    std::array<Estimate, kSteps> estimates_;
};

}  // namespace

Bandwidth elongated(const PhotonSource& source, uint32_t photon, const Bandwidth& disc, const BandwidthRule& rule,
                    BandwidthScratch& scratch) {
    if (disc.count > kMostInDisc || 2 * disc.count > rule.mostCount) return disc;
    return Elongation(source, photon, disc, rule, scratch).run();
}

}  // namespace lsde
