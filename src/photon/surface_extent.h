// How far a surface reaches around a point: which part of a density kernel lies on it, and which photons do.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/bounds.h"

namespace lsde {

// The surface around one point, as its creases (edges at which it ends) cut it in the tangent plane. A crease hides
// what lies behind it, seen from the point along the surface: exact where the surface is convex, an approximation where
// it is not (around the inner corner of an L the hidden part counts neither as area nor with its photons).
class SurfaceAround {
  public:
    // No crease near: the kernel and all photons lie on the surface.
    bool whole() const { return cuts_ == 0; }
    // Of an Epanechnikov kernel's mass, in (0, 1]. Radii as large as the one asked for in SurfaceExtent::around, or
    // less.
    float share(float radius) const;
    // Whether a crease lies between the point and p.
    bool hides(Vec3 p) const;

  private:
    friend class SurfaceExtent;
    static constexpr size_t kLanes = 8;
    // Cuts from a to b, in m, in the tangent plane about the centre; beyond the last one segments of no length.
    struct Cuts {
        std::array<float, kLanes> ax{}, ay{}, bx{}, by{};
        std::array<float, kLanes> area{};  // twice that of the triangle with the centre, signed
    };
    void clear();
    void add(Vec2 a, Vec2 b);

    Frame frame_;
    Vec3 centre_{0};
    size_t cuts_ = 0;
    std::vector<Cuts> lanes_;
    float nearestSquared_ = 0;  // m2: of all cuts
};

// An estimate that leaves hidden photons out and divides by the kernel's share neither darkens along edges (without,
// pool loses 1% of its light there) nor leaks below a wall that stands on the floor.
class SurfaceExtent {
  public:
    SurfaceExtent() = default;
    // No radius will exceed maxRadius (m).
    SurfaceExtent(std::span<const Segment> creases, float maxRadius);

    // normal: of the tangent plane, unit. The result is overwritten, its memory used again.
    void around(Vec3 centre, Vec3 normal, float radius, SurfaceAround& out) const;

  private:
    struct Range {
        uint32_t begin = 0, end = 0;
    };
    uint64_t cellOf(Vec3 p) const;
    // Cells within maxRadius of the crease, perhaps some more.
    void cellsNear(const Segment& crease, float maxRadius, std::vector<uint64_t>& out) const;

    std::vector<Segment> creases_;
    float cell_ = 0;                             // m; 0: there are no creases
    std::unordered_map<uint64_t, Range> cells_;  // ranges of near_
    // Creases within maxRadius of a cell, each within a sphere.
    struct Near {
        Vec3 middle{0};
        float halfLength = 0;
        uint32_t crease = 0;
    };
    std::vector<Near> near_;
};

}  // namespace lsde
