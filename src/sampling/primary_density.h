// A learnt density over the random numbers that a path starts with: its primary sample space.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lsde {

// Up to four random numbers, each in [0,1).
using PrimaryPoint = std::array<float, 4>;

// Piecewise constant on the boxes of a tree that halves the unit cube, finer where it pays (as the trees of Mueller,
// Gross & Novak 2017, "Practical Path Guiding", over primary sample space, as in Guo, Bauszat, Bikker & Eisemann 2018).
// A default one is even.
class PrimaryDensity {
  public:
    // A path that was tried, and what it would be worth to have many like it.
    struct Trial {
        PrimaryPoint u{};
        float worth = 0;
    };

    PrimaryDensity() = default;
    // From trials spread evenly over the cube, in any order; too few give an even density. The density of a box is the
    // root of its trials' mean square of worth, which gives least variance (Rath et al. 2020), at least kFloor of the
    // mean. Only the first `dimensions` are told apart.
    PrimaryDensity(std::vector<Trial> trials, int dimensions);

    bool even() const { return nodes_.empty(); }
    // Maps an even point to one of this density, so that each box keeps its strata.
    PrimaryPoint sample(PrimaryPoint u, float& pdf) const;
    float pdf(PrimaryPoint u) const;  // its mean over the cube is 1

    static constexpr float kFloor = 0.1F;

  private:
    struct Node {
        uint32_t children = 0;  // of the first of two, which lie side by side; 0: a box
        uint32_t dimension = 0;
        float first = 0.5F;  // share of the first
    };

    struct Build;
    std::vector<Node> nodes_;
};

}  // namespace lsde
