// Colour spaces.
#pragma once

#include "base/math.h"

namespace lsde {

// Linear Rec. 709 from CIE 1931 XYZ (ITU-R BT.709 primaries and white); colours beyond its border have negative
// channels.
template <typename T>
glm::vec<3, T> rec709FromXyz(const glm::vec<3, T>& xyz) {
    return {T(3.2404542) * xyz.x - T(1.5371385) * xyz.y - T(0.4985314) * xyz.z,
            T(-0.9692660) * xyz.x + T(1.8760108) * xyz.y + T(0.0415560) * xyz.z,
            T(0.0556434) * xyz.x - T(0.2040259) * xyz.y + T(1.0572252) * xyz.z};
}

}  // namespace lsde
