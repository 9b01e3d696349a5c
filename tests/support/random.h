// Random numbers for tests, of another make than the sampler under test.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "base/math.h"

namespace lsde::test {

class Random {
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    // In [0,1), on the sampler's grid of 2^-24.
    float uniform() { return static_cast<float>(engine_() >> 8) * 0x1p-24F; }
    float between(float lo, float hi) { return lo + (hi - lo) * uniform(); }
    Vec2 uniform2D() {
        const float x = uniform();
        return {x, uniform()};
    }
    Vec3 inCube() { return {uniform(), uniform(), uniform()}; }
    Vec3 onSphere() {
        const float z = between(-1, 1), angle = between(0, 2 * kPi), r = std::sqrt(std::max(0.0F, 1 - z * z));
        return {r * std::cos(angle), r * std::sin(angle), z};
    }
    uint32_t poisson(double mean) { return std::poisson_distribution<uint32_t>(mean)(engine_); }
    uint32_t bits() { return static_cast<uint32_t>(engine_()); }
    uint64_t bits64() {
        const uint64_t upper = engine_();
        return upper << 32 | engine_();
    }

  private:
    std::mt19937 engine_;
};

}  // namespace lsde::test
