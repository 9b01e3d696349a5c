// A point of a surface as photon maps see it: no scene, no material.
#pragma once

#include "base/math.h"

namespace lsde {

struct SurfacePoint {
    Vec3 position{0};
    Vec3 ng{0, 0, 1};     // geometric normal, unit, on the mesh's front side
    Vec3 ns{0, 0, 1};     // shading normal, unit, same side as ng
    float footprint = 0;  // m: short side of the pixel's footprint here
    float curvature = 0;  // 1/m, largest of its triangle; 0 also where that is not known
};

}  // namespace lsde
