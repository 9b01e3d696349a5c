// The CIE 1931 2 degree observer and illuminant D65 (data/SOURCES.md).
#pragma once

#include <array>
#include <cstddef>

#include "base/math.h"

namespace lsde {

struct CieRow {
    int nm;
    double x, y, z;  // the observer's
    double d65;      // relative power
};

inline constexpr size_t kCieRows = 85;
inline constexpr int kCieFirstNm = 360, kCieStepNm = 5;
extern const std::array<CieRow, kCieRows> kCie;

// The observer's x, y, z, linear between rows; none beyond them.
glm::dvec3 cieObserver(double nm);

}  // namespace lsde
