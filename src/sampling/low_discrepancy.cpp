#include "sampling/low_discrepancy.h"

#include <array>
#include <bit>
#include <cstddef>

namespace lsde {

namespace {

// Primitive polynomial x^degree + c_1 x^(degree-1) + ... + 1, its inner coefficients as the bits of `inner` (c_1
// first), and the odd numbers m_1 .. m_degree that start the recurrence.
struct SobolSeed {
    int degree;
    uint32_t inner;
    std::array<uint32_t, 5> m;
};

// Dimensions 1 to 8 (0 is van der Corput's), from new-joe-kuo-6 (Joe & Kuo 2008, "Constructing Sobol sequences with
// better two-dimensional projections").
constexpr std::array<SobolSeed, kSobolTableDimensions - 1> kSeeds = {{{1, 0, {1}},
                                                                      {2, 1, {1, 3}},
                                                                      {3, 1, {1, 3, 1}},
                                                                      {3, 2, {1, 1, 1}},
                                                                      {4, 1, {1, 1, 3, 3}},
                                                                      {4, 4, {1, 3, 5, 13}},
                                                                      {5, 2, {1, 1, 5, 5, 17}},
                                                                      {5, 4, {1, 1, 5, 5, 5}}}};

using Columns = std::array<uint64_t, 64>;  // direction numbers as binary fractions, the first digit in bit 63

constexpr Columns directionNumbers(int dimension) {
    Columns v{};
    if (dimension == 0) {
        for (size_t k = 0; k < 64; ++k) v[k] = uint64_t{1} << (63 - k);
        return v;
    }
    const SobolSeed& seed = kSeeds[static_cast<size_t>(dimension) - 1];
    const auto degree = static_cast<size_t>(seed.degree);
    for (size_t k = 0; k < degree; ++k) v[k] = static_cast<uint64_t>(seed.m[k]) << (63 - k);
    for (size_t k = degree; k < 64; ++k) {
        v[k] = v[k - degree] ^ (v[k - degree] >> degree);
        for (size_t j = 1; j < degree; ++j)
            if (((seed.inner >> (degree - 1 - j)) & 1) != 0) v[k] ^= v[k - j];
    }
    return v;
}

// For each byte of the index what its 256 values contribute: the cost of a coordinate is one look-up a byte.
using ByteTables = std::array<std::array<uint32_t, 256>, 8>;

constexpr ByteTables byteTables(int dimension) {
    const Columns v = directionNumbers(dimension);
    ByteTables tables{};
    for (size_t byte = 0; byte < 8; ++byte)
        for (uint32_t b = 1; b < 256; ++b) {
            const uint64_t column = v[8 * byte + static_cast<size_t>(std::countr_zero(b))];
            tables[byte][b] = tables[byte][b & (b - 1)] ^ reverseBits(static_cast<uint32_t>(column >> 32));
        }
    return tables;
}

constexpr std::array<ByteTables, kSobolTableDimensions> kTables = {byteTables(0), byteTables(1), byteTables(2),
                                                                   byteTables(3), byteTables(4), byteTables(5),
                                                                   byteTables(6), byteTables(7), byteTables(8)};

}  // namespace

uint32_t sobolReversed(uint64_t index, int dimension) {
    const ByteTables& tables = kTables[static_cast<size_t>(dimension)];
    uint32_t x = tables[0][index & 255] ^ tables[1][index >> 8 & 255] ^ tables[2][index >> 16 & 255];
    index >>= 24;
    for (size_t byte = 3; index != 0; index >>= 8, ++byte) x ^= tables[byte][index & 255];
    return x;
}

}  // namespace lsde
