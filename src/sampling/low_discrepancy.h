// Sobol's sequence by index, and Owen's scramble of it.
//
// Binary fractions are 32 digits in reverse order: the first digit after the point is bit 0. Carries of integer
// arithmetic then run from the first digit to the last, as the scramble needs it.
#pragma once

#include <cstdint>

namespace lsde {

inline constexpr int kSobolTableDimensions = 9;

// Also turns reversed digits into the usual order, the first digit in bit 31, and back.
constexpr uint32_t reverseBits(uint32_t x) {
    x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
    return __builtin_bswap32(x);
}

// A coordinate of point `index` of Sobol's sequence (direction numbers of Joe & Kuo 2008), digits reversed. dimension
// is below kSobolTableDimensions. All 64 bits of the index count: points do not repeat after 2^32.
uint32_t sobolReversed(uint64_t index, int dimension);

// Nested uniform scramble (Owen 1995): flips each digit by a hash of the seed and of all digits before it, so that
// every elementary interval keeps its number of points. By hash (Laine & Karras 2011; Burley 2020) with the steps and
// constants of Vegdahl, "Building a Better LK Hash" (2021): multiplication by an even number passes digits on to later
// ones only.
constexpr uint32_t owenScrambleReversed(uint32_t x, uint64_t seed) {
    x ^= x * 0x3d20adeaU;
    x += static_cast<uint32_t>(seed);
    x *= static_cast<uint32_t>(seed >> 32) | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return x;
}

// A coordinate of the scrambled sequence, the first digit in bit 31.
inline uint32_t scrambledSobol(uint64_t index, int dimension, uint64_t seed) {
    return reverseBits(owenScrambleReversed(sobolReversed(index, dimension), seed));
}

// Permutes indices such that each aligned block of 2^k of them remains one, for k <= 32 (nested uniform shuffle, Burley
// 2020, section 4): sequences shuffled by different seeds can be used side by side as if independent.
constexpr uint64_t shuffledIndex(uint64_t index, uint64_t seed) {
    const uint64_t upper = index >> 32;
    const uint64_t blockSeed = seed + upper * 0x9e3779b97f4a7c15ULL;
    return (upper << 32) | reverseBits(owenScrambleReversed(reverseBits(static_cast<uint32_t>(index)), blockSeed));
}

}  // namespace lsde
