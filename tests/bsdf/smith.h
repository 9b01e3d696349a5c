// Smith's masking for GGX, written for tests from the paper.
#pragma once

#include <cmath>

#include "base/math.h"

namespace lsde::test {

// Walter et al. 2007, eq. 34.
inline double smithG1(double cosTheta, double alpha) {
    return 2 / (1 + std::sqrt(1 + square(alpha) * (1 / square(cosTheta) - 1)));
}

}  // namespace lsde::test
