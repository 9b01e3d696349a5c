// What emission by low-discrepancy points leaves of the variance that independent light paths would have.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "photon/kd_index.h"

namespace lsde {

// The variance of the number of photons in a place where `count` of them are expected, over that number: 1 if paths
// were independent (Poisson's). Scrambled Sobol points leave the less of it the more photons there are (Owen 1997; in d
// dimensions by count^(-1/d) where the place has a sharp edge), several photons of one path more.
struct Dispersion {
    static constexpr float kLeastCount = 4;
    static constexpr size_t kCounts = 8;

    std::array<float, kCounts> at4TimesPowersOf2{1, 1, 1, 1, 1, 1, 1, 1};

    // Between the measured counts by their logarithm, beyond them that of the nearest.
    float at(float count) const;
    friend bool operator==(const Dispersion&, const Dispersion&) = default;
};

// Of each count the larger: what is known of shards that machines of several kinds measured.
Dispersion larger(const Dispersion& a, const Dispersion& b);

// From the photons of successive parts of one sequence of paths, all as long as a power of two: by how much their
// numbers differ in discs, around photons and held full by all parts together. What of one part lies in a disc is as
// well distributed as photons of a whole emission as long. (Cells of a kd-tree would not do: most of their edges are
// those of the boxes in which Sobol's points are exactly even.)
Dispersion measureDispersion(std::span<const std::vector<PackedPhoton>> parts, ThreadPool& pool);

}  // namespace lsde
