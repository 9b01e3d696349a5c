// Random numbers for tests, of another make than the sampler under test.
#pragma once

#include <random>

#include "base/math.h"

namespace lsde::test {

class Random {
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    // In [0,1), on the sampler's grid of 2^-24.
    float uniform() { return static_cast<float>(engine_() >> 8) * 0x1p-24F; }
    Vec2 uniform2D() {
        const float x = uniform();
        return {x, uniform()};
    }
    uint64_t bits64() {
        const uint64_t upper = engine_();
        return upper << 32 | engine_();
    }

  private:
    std::mt19937 engine_;
};

}  // namespace lsde::test
