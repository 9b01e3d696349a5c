// How far a surface reaches around a point: which part of a density kernel lies on it, and which photons do.
#pragma once

#include <array>
#include <cstdint>
#include <span>
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
    // Of a disc's area, in (0, 1].
    float areaShare(float radius) const;
    // Whether a crease lies between the point and p.
    bool hides(Vec3 p) const;
    // Whether a crease comes within the distance (m) of p. Of creases only what lies within the radius asked for
    // counts.
    bool creaseNear(Vec3 p, float distance) const;

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
    // Mean of part(reach) over the directions, reach being how far the surface goes there, in radii, at most 1.
    template <typename Part>
    float meanOver(float radius, const Part& part) const;

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
    explicit SurfaceExtent(std::span<const Segment> creases);

    // normal: of the tangent plane, unit. The result is overwritten, its memory used again.
    void around(Vec3 centre, Vec3 normal, float radius, SurfaceAround& out) const;
    // Whether a crease lies between the points: what around() as far as the radius would say that it hides.
    bool separates(Vec3 centre, Vec3 normal, Vec3 p, float radius) const;
    // In m, from p to the nearest crease; infinite if there is none.
    float clearance(Vec3 p) const;

  private:
    struct Crease {
        Segment segment;
        Vec3 middle{0};
        float halfLength = 0;
    };
    static constexpr size_t kLanes = 8;
    // The creases of a leaf, for their distance from a point; beyond the last one the lanes mean nothing.
    struct Lanes {
        std::array<float, kLanes> ax{}, ay{}, az{}, dx{}, dy{}, dz{};  // from a, d on to b
        std::array<float, kLanes> inverse{};                           // 1 / d^2
        explicit Lanes(std::span<const Crease> creases);
        std::array<float, kLanes> distancesSquared(Vec3 p) const;
        // Whether one has its ends on different sides of the plane through p across `normal`.
        bool anyCrosses(Vec3 p, Vec3 normal) const;
    };
    // A tree of boxes over the creases: a node's first child follows it, the second is at `next`; a leaf's lanes are.
    struct Node {
        Bounds bounds;
        uint32_t begin = 0, end = 0;  // of creases_
        uint32_t next = 0;
        bool leaf = false;
    };
    void build(uint32_t begin, uint32_t end);
    // Calls visit(leaf) until one call is true, for the leaves below boxes for which reaches(bounds).
    template <typename Reaches, typename Visit>
    void visitLeaves(const Reaches& reaches, const Visit& visit) const;

    std::vector<Crease> creases_;
    std::vector<Lanes> lanes_;
    std::vector<Node> nodes_;
};

}  // namespace lsde
