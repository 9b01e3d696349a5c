// Ray queries against triangle meshes. accel.cpp is the one file that includes Embree.
#pragma once

#include <cstdint>
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

class Accel {
  public:
    // Copies positions and triangles. Throws Error if Embree cannot build (memory).
    explicit Accel(std::span<const Mesh> meshes);
    ~Accel();
    Accel(Accel&&) noexcept;

    // Nearest hit in (0, ray.tMax).
    bool intersect(const Ray& ray, Hit& hit) const;
    // Any hit in (0, ray.tMax).
    bool occluded(const Ray& ray) const;
    // All hits in (0, ray.tMax), sorted by t, then mesh, then triangle.
    void allHits(const Ray& ray, std::vector<Hit>& hits) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lsde
