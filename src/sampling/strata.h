// One point of the unit cube shared out into many: samples of the lights at one vertex.
#pragma once

#include <bit>
#include <cstdint>

#include "base/math.h"
#include "sampling/low_discrepancy.h"

namespace lsde {

// A number of [0,1) shifted round it by `by` of [0,1) (Cranley & Patterson 1976).
inline float rotated(float u, float by) { return u + by < 1 ? u + by : u + by - 1; }

struct LightNumbers {
    float which = 0;  // chooses the light
    Vec2 on{0};       // and the point on it
};

// The i-th of `count` (a power of four, at most 2^30): one in each cell of a square grid over the unit square, at the
// same place in each, so that a pixel's points, well distributed in a cell, are so together as well. Cells follow each
// other as points of Sobol's sequence do, a (0,2)-sequence in base 2, while `which` goes evenly round [0,1): a light
// that is chosen by a quarter of all gets points from everywhere on it.
inline LightNumbers lightStratum(LightNumbers u, uint32_t i, uint32_t count) {
    if (count == 1) return u;
    const int digits = std::countr_zero(count) / 2;
    const auto cell = [&](int dimension) {
        return static_cast<float>(reverseBits(sobolReversed(i, dimension)) >> (32 - digits));
    };
    const Vec2 on = (Vec2(cell(0), cell(1)) + u.on) / static_cast<float>(1U << digits);
    return {rotated(u.which, static_cast<float>(i) / static_cast<float>(count)), glm::min(on, Vec2(kOneMinusEpsilon))};
}

}  // namespace lsde
