// Pearson's chi-squared test: do samples have the density that they claim?
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "base/math.h"

namespace lsde::test {

inline constexpr double kSignificance = 0.01;  // of a whole family of tests: the chance that sound code fails one
inline constexpr double kMinExpected = 5;      // Cochran's rule: rarer cells are pooled

struct ChiSquaredResult {
    double statistic = 0;
    int degreesOfFreedom = 0;
    double p = 1;  // chance of a statistic as large as this if the samples are sound

    // tests: how many belong to the family (Bonferroni).
    bool accepted(int tests) const { return p >= kSignificance / tests; }
};

// Upper tail of the chi-squared distribution (Wilson & Hilferty 1931).
inline double chiSquaredTail(double statistic, int degreesOfFreedom) {
    const double variance = 2 / (9.0 * degreesOfFreedom);
    const double z = (std::cbrt(statistic / degreesOfFreedom) - (1 - variance)) / std::sqrt(variance);
    return 0.5 * std::erfc(z / std::sqrt(2.0));
}

// Counts against expected counts (same order). Rare cells are pooled, from the rarest up, those included where nothing
// is expected: quadrature may miss a sliver.
inline ChiSquaredResult chiSquared(std::span<const double> observed, std::span<const double> expected) {
    std::vector<size_t> order(observed.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
    ChiSquaredResult result;
    double o = 0, e = 0;
    int cells = 0;
    for (const size_t i : order) {
        o += observed[i];
        e += expected[i];
        if (e < kMinExpected) continue;
        result.statistic += square(o - e) / e;
        ++cells;
        o = e = 0;
    }
    result.degreesOfFreedom = std::max(1, cells - 1);
    result.p = chiSquaredTail(result.statistic, result.degreesOfFreedom);
    return result;
}

// A grid over the unit square on which samples are counted. The density (per unit of the square's area) is integrated
// over each cell by Gauss' two-point rule on quadrature x quadrature parts.
struct SquareGrid {
    int width = 40;
    int height = 40;
    int quadrature = 2;
    int samples = 200'000;
};

// The i-th node of Gauss' two-point rule on `parts` parts of [0,1].
inline double gaussNode(int i, int parts) {
    constexpr double kFromEnd = 0.21132486540518713;  // (1 - 1/sqrt(3)) / 2
    const int part = i / 2;
    return (part + (i % 2 == 0 ? kFromEnd : 1 - kFromEnd)) / parts;
}

// The density gives doubles or vectors of them.
template <typename Density>
auto integrateCell(const SquareGrid& grid, int x, int y, const Density& density) {
    const int nodes = 2 * grid.quadrature;
    decltype(density(0.0, 0.0)) sum{};
    for (int j = 0; j < nodes; ++j)
        for (int i = 0; i < nodes; ++i)
            sum += density((x + gaussNode(i, grid.quadrature)) / grid.width,
                           (y + gaussNode(j, grid.quadrature)) / grid.height);
    return sum / (static_cast<double>(nodes) * nodes * grid.width * grid.height);
}

// sample() gives a std::optional<Vec2> in the unit square; what is empty counts towards the probability that the
// density leaves out.
template <typename Sample, typename Density>
ChiSquaredResult chiSquaredOnSquare(const SquareGrid& grid, const Sample& sample, const Density& density) {
    const auto cells = static_cast<size_t>(grid.width) * static_cast<size_t>(grid.height);
    std::vector<double> observed(cells + 1), expected(cells + 1);
    for (int i = 0; i < grid.samples; ++i) {
        const std::optional<Vec2> s = sample();
        size_t cell = cells;
        if (s) {
            const int x = std::clamp(static_cast<int>(s->x * static_cast<float>(grid.width)), 0, grid.width - 1);
            const int y = std::clamp(static_cast<int>(s->y * static_cast<float>(grid.height)), 0, grid.height - 1);
            cell = static_cast<size_t>(y) * static_cast<size_t>(grid.width) + static_cast<size_t>(x);
        }
        ++observed[cell];
    }
    double total = 0;
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) {
            const double p = integrateCell(grid, x, y, density);
            expected[static_cast<size_t>(y) * static_cast<size_t>(grid.width) + static_cast<size_t>(x)] =
                p * grid.samples;
            total += p;
        }
    // Of a density that integrates to 1, what quadrature misses is no probability of an empty sample.
    const double rest = 1 - total;
    REQUIRE(rest > -1e-3);
    expected[cells] = rest < 1e-3 && observed[cells] == 0 ? 0 : std::max(0.0, rest) * grid.samples;
    return chiSquared(observed, expected);
}

// Directions in cylindrical coordinates about x, which keep areas: (x + 1) / 2 and the azimuth over 2 pi, from z. The
// slivers at the axis lie on the horizon, away from lobes about z, and the horizon runs along cells (height % 4 == 0).
inline Vec2 squareFromSphere(Vec3 v) {
    const float azimuth = std::atan2(v.y, v.z) / (2 * kPi);
    return {0.5F * (v.x + 1), azimuth < 0 ? azimuth + 1 : azimuth};
}

inline Vec3 sphereFromSquare(double s, double t) {
    const double x = 2 * s - 1, r = std::sqrt(std::max(0.0, 1 - x * x)), azimuth = 2 * std::numbers::pi * t;
    return {static_cast<float>(x), static_cast<float>(r * std::sin(azimuth)),
            static_cast<float>(r * std::cos(azimuth))};
}

// sample() gives a std::optional<Vec3>, a unit vector; pdfW(Vec3) is per steradian.
template <typename Sample, typename Pdf>
ChiSquaredResult chiSquaredOnSphere(const SquareGrid& grid, const Sample& sample, const Pdf& pdfW) {
    return chiSquaredOnSquare(
        grid,
        [&]() -> std::optional<Vec2> {
            const std::optional<Vec3> v = sample();
            return v ? std::optional(squareFromSphere(*v)) : std::nullopt;
        },
        [&](double x, double y) { return 4 * std::numbers::pi * pdfW(sphereFromSquare(x, y)); });
}

}  // namespace lsde::test
