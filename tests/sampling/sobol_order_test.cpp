#include "sampling/sobol_order.h"

#include <doctest/doctest.h>

#include <set>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "sampling/low_discrepancy.h"

using namespace lsde;

namespace {

// Cells of 2^-digits by 2^-digits that some of the points along the curve lie in.
size_t cellsOf(const std::vector<std::pair<uint32_t, uint32_t>>& points, size_t from, size_t to, int digits) {
    std::set<std::pair<uint32_t, uint32_t>> cells;
    for (size_t k = from; k < to; ++k)
        cells.insert({points[k].first >> (32 - digits), points[k].second >> (32 - digits)});
    return cells.size();
}

}  // namespace

TEST_CASE("an order of a block holds each of its points once") {
    for (const int digits : {0, 1, 2, 5, 13}) {
        const SobolOrder order(digits, 2, 3);
        const uint64_t count = uint64_t{1} << digits;
        std::set<uint64_t> seen;
        for (uint64_t k = 0; k < count; ++k) {
            REQUIRE(order.index(k) < count);
            seen.insert(order.index(k));
        }
        CHECK(seen.size() == count);
    }
    CHECK(SobolOrder().index(12345678901) == 12345678901);
}

TEST_CASE(
    "points of a block lie along a Z-curve, cell by cell, wherever the block starts and however it is scrambled") {
    constexpr int kDigits = 12, kLevels = 4;
    constexpr size_t kCount = size_t{1} << kDigits;
    for (const int first : {0, 2})
        for (const uint64_t block : {uint64_t{0}, uint64_t{7}, uint64_t{1234567}}) {
            const SobolOrder order(kDigits, first, first + 1);
            std::vector<std::pair<uint32_t, uint32_t>> points;
            for (uint64_t k = 0; k < kCount; ++k) {
                const uint64_t index = block * kCount + order.index(k);
                points.emplace_back(scrambledSobol(index, first, mix64(1)), scrambledSobol(index, first + 1, mix64(2)));
            }
            for (int level = 1; level <= kLevels; ++level) {
                const size_t inCell = kCount >> (2 * level);
                for (size_t from = 0; from < kCount; from += inCell)
                    REQUIRE(cellsOf(points, from, from + inCell, level) == 1);
            }
        }
}
