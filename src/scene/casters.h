// What emission aims at: a few spheres that hold all casters.
#pragma once

#include <vector>

#include "base/bounds.h"
#include "scene/mesh.h"

namespace lsde {

// Something light is aimed at: a bounding sphere around one or more casters.
struct Caster {
    Sphere bounds;
};

// Of a scene: aiming looks at every one of them for every path.
inline constexpr size_t kMaxCasters = 16;

Sphere boundingSphereOf(const Mesh& mesh);

// At most `limit` spheres around groups of casters: the largest group is halved across its longest side until there are
// enough.
std::vector<Caster> groupCasters(std::vector<Sphere> spheres, size_t limit);

}  // namespace lsde
