// Directions towards a triangle, evenly by solid angle (Arvo 1995, "Stratified Sampling of Spherical Triangles").
#pragma once

#include <optional>

#include "base/math.h"

namespace lsde {

// The triangle as it is seen from one point: its corners on the unit sphere about it.
class SphericalTriangle {
  public:
    // Corners relative to the point, in m. None if they cover too little of the sphere to be told from flat, where
    // rounding would show, or nearly half of it.
    static std::optional<SphericalTriangle> seen(Vec3 a, Vec3 b, Vec3 c);

    float solidAngle() const { return solidAngle_; }  // sr; 1 / pdfW
    Vec3 sample(Vec2 u) const;                        // unit

  private:
    SphericalTriangle(Vec3 a, Vec3 b, Vec3 c, float solidAngle) : a_(a), b_(b), c_(c), solidAngle_(solidAngle) {}

    Vec3 a_, b_, c_;
    float solidAngle_;
};

}  // namespace lsde
