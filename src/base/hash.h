// Integer hashes for counter-based random numbers.
#pragma once

#include <cstdint>

namespace lsde {

// Finaliser of SplitMix64 (Steele, Lea & Flood 2014): a bijection of 64 bits.
constexpr uint64_t mix64(uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

constexpr uint64_t hashCombine(uint64_t a, uint64_t b) { return mix64(a ^ mix64(b)); }

// Uniform in [0,1) from the upper 24 bits.
constexpr float toUnitFloat(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }

}  // namespace lsde
