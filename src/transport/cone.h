// The cone in which a bounding sphere is seen: what emission and diffuse surfaces aim at.
#pragma once

#include "base/bounds.h"

namespace lsde {

struct Cone {
    Vec3 axis{0, 0, 1};
    float oneMinusCos = 2;   // of the half angle
    bool everything = true;  // the point lies in the sphere
};

inline Cone coneTo(const Sphere& s, Vec3 p) {
    const Vec3 d = s.centre - p;
    const float d2 = lengthSquared(d), r2 = square(s.radius);
    if (d2 <= r2 * 1.0002F) return {};
    const float sin2 = r2 / d2;
    // 1 - cos without cancellation for narrow cones.
    return {d / std::sqrt(d2), sin2 / (1 + std::sqrt(1 - sin2)), false};
}

inline bool within(const Cone& cone, Vec3 direction) {
    // |direction - axis|^2 / 2 = 1 - cos, exact for narrow cones as well.
    return cone.everything || 0.5F * lengthSquared(direction - cone.axis) <= cone.oneMinusCos;
}

// Roughly the share of a cosine-weighted hemisphere about `normal` that the cone takes; 0 only if it lies below the
// horizon.
inline float cosineShare(const Cone& cone, Vec3 normal) {
    const float sine = cone.everything ? 1 : safeSqrt(cone.oneMinusCos * (2 - cone.oneMinusCos));
    const float cosine = cone.everything ? 1 : glm::dot(normal, cone.axis);
    return cone.oneMinusCos * std::clamp(cosine + sine, 0.0F, 1.0F);
}

}  // namespace lsde
