// Vectors that are to be the same but for rounding.
#pragma once

#include <doctest/doctest.h>

#include "base/math.h"

namespace lsde::test {

inline void checkNear(Vec3 a, Vec3 b) {
    CHECK_MESSAGE(glm::length(a - b) < 1e-6F,
                  a.x << ' ' << a.y << ' ' << a.z << " for " << b.x << ' ' << b.y << ' ' << b.z);
}

}  // namespace lsde::test
