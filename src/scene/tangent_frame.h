// Tangents of textured surfaces, for normal textures.
#pragma once

#include "scene/mesh.h"

namespace lsde {

// Unit, at right angles to the normal and to each other.
struct TangentFrame {
    Vec3 tangent, bitangent;
};

// At a point of a triangle (barycentric u, v), about a unit normal there: by TANGENT if the mesh has it, else by the
// triangle's own texture coordinates: along the rise of u and the fall of v, as MikkTSpace has them but for its
// smoothing across triangles. Any tangent where texture coordinates do not tell.
TangentFrame tangentFrame(const Mesh& mesh, const Triangle& t, float u, float v, Vec3 normal, int texCoord);

}  // namespace lsde
