#include "sampling/primary_density.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace lsde {

namespace {

constexpr size_t kLeastTrials = 24;  // in a half
constexpr int kMostHalvings = 24;
// Share of its mass that a halving must take away, times its trials: what chance shows is less.
constexpr double kLeastGain = 8;
// So many trials are halved even if nothing is gained at once: what is symmetric shows only in the next halving.
constexpr size_t kManyTrials = 1024;
// Trials that a box takes to have had with the mean square of what it was halved from.
constexpr double kPriorTrials = 2;

double sumOfSquares(std::span<const PrimaryDensity::Trial> trials) {
    double sum = 0;
    for (const PrimaryDensity::Trial& t : trials) sum += square(static_cast<double>(t.worth));
    return sum;
}

}  // namespace

struct PrimaryDensity::Build {
    std::vector<Node>& nodes;
    int dimensions;

    struct Box {
        std::span<Trial> trials;
        PrimaryPoint lo{}, size{1, 1, 1, 1};
        double volume = 1;
        int halvings = 0;

        double meanSquare(double prior) const {
            return (sumOfSquares(trials) + kPriorTrials * prior) / (static_cast<double>(trials.size()) + kPriorTrials);
        }
        // Integral of the density that suits this box best if it is not halved: volume sqrt(mean worth^2), up to a
        // factor that all boxes share.
        double mass() const { return std::sqrt(volume * sumOfSquares(trials)); }
    };

    static std::span<Trial>::iterator divide(const Box& box, size_t dimension) {
        const float middle = box.lo[dimension] + 0.5F * box.size[dimension];
        return std::partition(box.trials.begin(), box.trials.end(),
                              [&](const Trial& t) { return t.u[dimension] < middle; });
    }

    static std::array<Box, 2> halves(const Box& box, size_t dimension) {
        const auto middle = static_cast<size_t>(divide(box, dimension) - box.trials.begin());
        Box first = box;
        first.size[dimension] *= 0.5F;
        first.volume *= 0.5;
        ++first.halvings;
        Box second = first;
        second.lo[dimension] += first.size[dimension];
        first.trials = box.trials.first(middle);
        second.trials = box.trials.subspan(middle);
        return {first, second};
    }

    // The dimension along which halving gains most, or `dimensions`.
    size_t bestDimension(const Box& box) const {
        const auto none = static_cast<size_t>(dimensions);
        const size_t count = box.trials.size();
        if (count < 2 * kLeastTrials || box.halvings == kMostHalvings) return none;
        double best = (1 - kLeastGain / static_cast<double>(count)) * box.mass();
        size_t found = none;
        for (size_t d = 0; d < none; ++d) {
            const auto [first, second] = halves(box, d);
            if (std::min(first.trials.size(), second.trials.size()) < kLeastTrials) continue;
            const double mass = first.mass() + second.mass();
            if (mass >= best) continue;
            best = mass;
            found = d;
        }
        if (found < none || count < kManyTrials) return found;
        return static_cast<size_t>(std::max_element(box.size.begin(), box.size.begin() + dimensions) -
                                   box.size.begin());
    }

    // Fills the node of a box and those below it; returns the mass of its parts.
    double grow(uint32_t node, const Box& box, double prior, std::vector<double>& masses) {
        const size_t dimension = bestDimension(box);
        const double meanSquare = box.meanSquare(prior);
        if (dimension == static_cast<size_t>(dimensions)) return masses[node] = box.volume * std::sqrt(meanSquare);
        const auto children = static_cast<uint32_t>(nodes.size());
        nodes[node].children = children;
        nodes[node].dimension = static_cast<uint32_t>(dimension);
        nodes.resize(children + 2);
        masses.resize(children + 2);
        const auto [first, second] = halves(box, dimension);
        const double a = grow(children, first, meanSquare, masses);
        return masses[node] = a + grow(children + 1, second, meanSquare, masses);
    }

    // Lifts boxes to the floor and sets the shares of halves; returns the mass of the node's parts.
    double share(uint32_t node, double volume, const std::vector<double>& masses) {
        const uint32_t children = nodes[node].children;
        if (children == 0) return std::max(masses[node], kFloor * volume * masses[0]);
        const double a = share(children, 0.5 * volume, masses);
        const double b = share(children + 1, 0.5 * volume, masses);
        nodes[node].first = static_cast<float>(a / (a + b));
        return a + b;
    }
};

PrimaryDensity::PrimaryDensity(std::vector<Trial> trials, int dimensions) {
    Build build{nodes_, dimensions};
    nodes_.resize(1);
    std::vector<double> masses(1);
    if (build.grow(0, {trials}, 0, masses) > 0 && nodes_.size() > 1)
        build.share(0, 1, masses);
    else
        nodes_.clear();
}

PrimaryPoint PrimaryDensity::sample(PrimaryPoint u, float& pdf) const {
    pdf = 1;
    if (even()) return u;
    PrimaryPoint lo{}, size{1, 1, 1, 1};
    for (const Node* node = nodes_.data(); node->children != 0;) {
        float& x = u[node->dimension];
        float& length = size[node->dimension];
        const bool second = x >= node->first;
        const float share = second ? 1 - node->first : node->first;
        x = std::min((second ? x - node->first : x) / share, kOneMinusEpsilon);
        length *= 0.5F;
        if (second) lo[node->dimension] += length;
        pdf *= 2 * share;
        node = &nodes_[node->children + (second ? 1 : 0)];
    }
    for (size_t d = 0; d < u.size(); ++d) u[d] = std::min(lo[d] + u[d] * size[d], kOneMinusEpsilon);
    return u;
}

float PrimaryDensity::pdf(PrimaryPoint u) const {
    if (even()) return 1;
    float pdf = 1;
    for (const Node* node = nodes_.data(); node->children != 0;) {
        float& x = u[node->dimension];
        x *= 2;
        const bool second = x >= 1;
        if (second) x -= 1;
        pdf *= 2 * (second ? 1 - node->first : node->first);
        node = &nodes_[node->children + (second ? 1 : 0)];
    }
    return pdf;
}

}  // namespace lsde
