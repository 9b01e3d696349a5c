// Edges at which a surface ends: where a density kernel may not count on more of it.
#pragma once

#include <vector>

#include "base/bounds.h"
#include "scene/scene.h"

namespace lsde {

// Two faces belong to one surface, as far as photons on them go, if the cosine between their normals exceeds this.
inline constexpr float kSameSurfaceCosine = 0.7F;

// The edges of all meshes beyond which no face goes on within kSameSurfaceCosine: rims, corners, and where an open
// sheet (water) meets a wall. Edges are matched by position across meshes; an edge without a match is probed with rays,
// so that tiles of different sizes side by side make no crease.
std::vector<Segment> findCreases(const Scene& scene);

}  // namespace lsde
