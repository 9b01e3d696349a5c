// Eight boxes or photons at a time: the inner loops of the packed kd-tree, in AVX2. For kd_index.cpp alone.
#pragma once

#include <immintrin.h>

#include <array>
#include <bit>
#include <cstdint>

#include "photon/kd_index.h"

#ifndef __AVX2__
#error "lsde needs AVX2: compile with -march=x86-64-v3 or above"
#endif

namespace lsde::lanes {

static_assert(sizeof(Neighbour) == 8);

struct Sphere8 {
    __m256 x, y, z, radiusSquared;

    Sphere8(float cx, float cy, float cz, float r2)
        : x(_mm256_set1_ps(cx)), y(_mm256_set1_ps(cy)), z(_mm256_set1_ps(cz)), radiusSquared(_mm256_set1_ps(r2)) {}
};

// Rounded in this order everywhere, so that every index agrees bit by bit (and never fused: -ffp-contract=off).
inline __m256 lengthSquared(__m256 dx, __m256 dy, __m256 dz) {
    return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
}

// Distance from the interval [lo, hi] to c; 0 inside.
inline __m256 outside(const float* lo, const float* hi, __m256 c) {
    const __m256 below = _mm256_sub_ps(_mm256_load_ps(lo), c), above = _mm256_sub_ps(c, _mm256_load_ps(hi));
    return _mm256_max_ps(_mm256_max_ps(below, above), _mm256_setzero_ps());
}

// Squared distances from the centre to the boxes of 8 children, never above that of a photon inside as it is computed:
// every step rounds monotonically. Infinite for empty boxes.
inline __m256 distanceToBoxes(const KdNode& node, const Sphere8& s) {
    return lengthSquared(outside(node.loX, node.hiX, s.x), outside(node.loY, node.hiY, s.y),
                         outside(node.loZ, node.hiZ, s.z));
}

// To the photons first to first + 7 of a block.
inline __m256 distanceToPhotons(const PhotonBlock& block, uint32_t first, const Sphere8& s) {
    return lengthSquared(_mm256_sub_ps(_mm256_load_ps(block.x + first), s.x),
                         _mm256_sub_ps(_mm256_load_ps(block.y + first), s.y),
                         _mm256_sub_ps(_mm256_load_ps(block.z + first), s.z));
}

// One bit for each lane below the sphere's radius.
inline uint32_t below(__m256 distanceSquared, const Sphere8& s) {
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(distanceSquared, s.radiusSquared, _CMP_LT_OQ)));
}

// Byte i of entry m: the i-th lane whose bit is set in m.
inline constexpr std::array<uint64_t, 256> kSetLanes = [] {
    std::array<uint64_t, 256> table{};
    for (uint32_t mask = 0; mask < 256; ++mask)
        for (uint64_t lane = 0, at = 0; lane < 8; ++lane)
            if ((mask >> lane & 1) != 0) table[mask] |= lane << (8 * at++);
    return table;
}();

inline __m256i setLanes(uint32_t mask) {
    return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(kSetLanes[mask])));
}

// Appends base + lane for each set bit. Writes eight elements, whatever the mask.
inline uint32_t* append(uint32_t* out, uint32_t base, uint32_t mask) {
    const __m256i numbers = _mm256_add_epi32(setLanes(mask), _mm256_set1_epi32(static_cast<int>(base)));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), numbers);
    return out + std::popcount(mask);
}

// The same for photons and their distances.
inline Neighbour* append(Neighbour* out, uint32_t base, __m256 distanceSquared, uint32_t mask) {
    const __m256i selected = setLanes(mask);
    const __m256i number = _mm256_add_epi32(selected, _mm256_set1_epi32(static_cast<int>(base)));
    const __m256i distance = _mm256_castps_si256(_mm256_permutevar8x32_ps(distanceSquared, selected));
    const __m256i even = _mm256_unpacklo_epi32(number, distance);  // photons 0 1 4 5
    const __m256i odd = _mm256_unpackhi_epi32(number, distance);   // photons 2 3 6 7
    auto* to = reinterpret_cast<__m256i*>(out);
    _mm256_storeu_si256(to, _mm256_permute2x128_si256(even, odd, 0x20));
    _mm256_storeu_si256(to + 1, _mm256_permute2x128_si256(even, odd, 0x31));
    return out + std::popcount(mask);
}

// The first lane that holds the least value.
inline uint32_t leastLane(__m256 values) {
    __m256 least = _mm256_min_ps(values, _mm256_permute2f128_ps(values, values, 1));
    least = _mm256_min_ps(least, _mm256_shuffle_ps(least, least, 0b01'00'11'10));
    least = _mm256_min_ps(least, _mm256_shuffle_ps(least, least, 0b10'11'00'01));
    const int mask = _mm256_movemask_ps(_mm256_cmp_ps(values, least, _CMP_EQ_OQ));
    return static_cast<uint32_t>(std::countr_zero(static_cast<uint32_t>(mask)));
}

inline void prefetch(const PhotonBlock& block) {
    for (const float* line : {block.x, block.y, block.z})
        _mm_prefetch(reinterpret_cast<const char*>(line), _MM_HINT_T0);
}
inline void prefetch(const KdNode& node) {
    for (const float* line : {node.loX, node.loZ, node.hiY})
        _mm_prefetch(reinterpret_cast<const char*>(line), _MM_HINT_T0);
}

}  // namespace lsde::lanes
