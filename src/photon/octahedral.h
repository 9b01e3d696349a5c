// The unit sphere on a square by way of an octahedron (Cigolle et al. 2014, "A Survey of Efficient Representations for
// Independent Unit Vectors").
#pragma once

#include <cmath>
#include <cstdint>

#include "base/math.h"

namespace lsde {

// kBits for each of two coordinates, which are whole multiples of 1 / kSteps, so that the axes are exact.
template <int kBits>
struct Octahedral {
    static constexpr uint32_t kMask = (1U << kBits) - 1;
    static constexpr int kSteps = (1 << (kBits - 1)) - 1;
    static constexpr int kBias = 1 << (kBits - 1);

    // v: any length but zero.
    static uint32_t pack(Vec3 v) {
        const Vec3 onFace = v / (std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z));
        // The lower half's triangles are folded outwards.
        const float fold = std::max(-onFace.z, 0.0F);
        return quantised(onFace.x + std::copysign(fold, onFace.x)) | quantised(onFace.y + std::copysign(fold, onFace.y))
                                                                         << kBits;
    }

    // Any bits give a direction.
    static Vec3 unpack(uint32_t bits) {
        const float x = coordinate(bits), y = coordinate(bits >> kBits);
        const float z = 1 - std::fabs(x) - std::fabs(y);
        const float fold = std::max(-z, 0.0F);
        return glm::normalize(Vec3(x - std::copysign(fold, x), y - std::copysign(fold, y), z));
    }

  private:
    // To the nearest step, halves away from zero.
    static uint32_t quantised(float x) {
        const double steps = static_cast<double>(x * kSteps);
        return static_cast<uint32_t>(static_cast<int>(steps + std::copysign(0.5, steps)) + kBias) & kMask;
    }
    static float coordinate(uint32_t bits) {
        return static_cast<float>(static_cast<int>(bits & kMask) - kBias) * (1.0F / kSteps);
    }
};

}  // namespace lsde
