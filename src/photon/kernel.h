// The kernel of all density estimates.
#pragma once

#include "base/math.h"

namespace lsde {

// Epanechnikov's on a disc: 2 / (pi r^2) (1 - d^2 / r^2), in 1/m2; its integral over the disc is 1.
inline float epanechnikov(float distanceSquared, float radiusSquared) {
    return 2 * kInvPi / radiusSquared * (1 - distanceSquared / radiusSquared);
}

// Share of the kernel's mass within x radii of the centre: the integral of (2 / pi)(1 - s^2) 2 pi s from 0 to x.
inline float epanechnikovWithin(float x) {
    const float x2 = x * x;
    return x2 * (2 - x2);
}

// What lies further from the tangent plane than this share of the radius is another surface. A disc at rest on a sphere
// meets its own surface everywhere as long as the sphere's radius is above 2.5 of the disc's.
inline constexpr float kPlaneThickness = 0.2F;

}  // namespace lsde
