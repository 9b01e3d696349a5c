// Axis-aligned boxes, bounding spheres and segments.
#pragma once

#include "base/math.h"

namespace lsde {

struct Bounds {
    Vec3 lo{kInfinity};
    Vec3 hi{-kInfinity};

    bool empty() const { return lo.x > hi.x; }
    void grow(Vec3 p) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    void grow(const Bounds& b) {
        lo = glm::min(lo, b.lo);
        hi = glm::max(hi, b.hi);
    }
    Vec3 centre() const { return 0.5F * (lo + hi); }
    Vec3 extent() const { return hi - lo; }
    float radius() const { return 0.5F * glm::length(hi - lo); }
    bool overlaps(const Bounds& b) const {
        return lo.x <= b.hi.x && b.lo.x <= hi.x && lo.y <= b.hi.y && b.lo.y <= hi.y && lo.z <= b.hi.z && b.lo.z <= hi.z;
    }
};

struct Sphere {
    Vec3 centre{0};
    float radius = 0;
};

struct Segment {
    Vec3 a{0}, b{0};
};

}  // namespace lsde
