// Discrete and piecewise constant distributions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/math.h"

namespace lsde {

// Chooses index i with probability weight[i] / sum by inversion of the cumulative sum (monotone, so that
// low-discrepancy numbers stay so).
class DiscreteDistribution {
  public:
    DiscreteDistribution() = default;
    // Throws Error on a negative or non-finite weight. All-zero weights give an empty distribution.
    explicit DiscreteDistribution(std::span<const double> weights);

    size_t size() const { return pmf_.size(); }
    bool empty() const { return total_ <= 0; }
    double total() const { return total_; }
    float pmf(size_t i) const { return pmf_[i]; }
    // u in [0,1); u is rescaled to [0,1) within the choice, for use as a further random number.
    size_t sample(float& u) const;

  private:
    std::vector<double> cdf_;  // size()+1 entries, 0 .. 1
    std::vector<float> pmf_;
    double total_ = 0;
};

// Piecewise constant density over the unit square on a width x height grid, row by row.
class Distribution2D {
  public:
    Distribution2D() = default;
    Distribution2D(std::span<const float> values, int width, int height);
    Vec2 sample(Vec2 u, float& pdf) const;
    float pdf(Vec2 uv) const;
    bool empty() const { return rows_.empty(); }

  private:
    DiscreteDistribution marginal_;
    std::vector<DiscreteDistribution> rows_;
    int width_ = 0, height_ = 0;
};

}  // namespace lsde
