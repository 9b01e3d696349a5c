// Ray queries against triangle meshes. accel.cpp is the one file that includes Embree.
//
// A surface that covers only part of what lies behind it is there or not for each ray: by a number that is a hash of
// ray and triangle, so that a path meets the same surfaces whenever it is followed. Scenes without such surfaces pay
// nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/ray.h"
#include "scene/mesh.h"

namespace lsde {

struct Hit {
    float t = 0;  // m along the ray
    uint32_t mesh = 0;
    uint32_t triangle = 0;
    float u = 0, v = 0;  // barycentric weights of the second and third vertex
};

// Which meshes may cover less than all, and how much they cover at a hit, in [0,1].
struct PartialCoverage {
    std::vector<bool> partial;
    std::function<float(const Hit&)> at;
};

class Accel {
  public:
    // Copies positions and triangles. Throws Error if Embree cannot build (memory).
    Accel(std::span<const Mesh> meshes, PartialCoverage coverage);
    ~Accel();
    Accel(Accel&&) noexcept;

    // Nearest hit in (0, ray.tMax).
    bool intersect(const Ray& ray, Hit& hit) const;
    // Any hit in (0, ray.tMax).
    bool occluded(const Ray& ray) const;
    // What is left of light along (0, ray.tMax), expected over all choices of surfaces that are there or not: the
    // product of 1 - coverage. `hits` is scratch.
    float transmittance(const Ray& ray, std::vector<Hit>& hits) const;
    // All hits in (0, ray.tMax), whatever they cover, sorted by t, then mesh, then triangle.
    void allHits(const Ray& ray, std::vector<Hit>& hits) const;
    // Whether the surface at a hit is there for this ray.
    bool isThere(const Ray& ray, const Hit& hit) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lsde
