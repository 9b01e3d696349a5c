// Rays, and origins moved off the surface that they leave.
#pragma once

#include "base/math.h"

namespace lsde {

struct Ray {
    Vec3 origin{0};
    Vec3 direction{0, 0, 1};  // unit length
    float tMax = kInfinity;   // m

    Vec3 at(float t) const { return origin + t * direction; }
};

// Distance (m) by which a ray's origin must leave a triangle so that it cannot meet it again, from the triangle's
// largest coordinates and the travel (m) of the ray that hit it. Points on a triangle, and distances to it,
// are off its plane by at most two units in the last place of its coordinates (measured for triangles of any size,
// place and tilt); the travel's rounding slides a point along the triangle, hence past its edges. Eight units leave a
// margin.
inline float surfaceEpsilon(Vec3 coordinates, float travel) {
    return 1e-6F * std::max(maxComponent(glm::abs(coordinates)), 0.125F * travel);
}

// Largest absolute coordinates of a triangle.
inline Vec3 largestCoordinates(Vec3 a, Vec3 b, Vec3 c) {
    return glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
}

// p moved along the geometric normal to the side into which `direction` points.
inline Vec3 offsetOrigin(Vec3 p, Vec3 ng, Vec3 direction, float epsilon) {
    return p + (glm::dot(ng, direction) < 0 ? -epsilon : epsilon) * ng;
}

}  // namespace lsde
