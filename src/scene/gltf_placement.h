// Meshes of a scene's nodes, in world space.
#pragma once

#include <vector>

#include "scene/description.h"
#include "scene/gltf_geometry.h"
#include "scene/gltf_json.h"
#include "scene/gltf_material.h"
#include "scene/gltf_nodes.h"
#include "scene/warnings.h"

namespace lsde {

// Adds a mesh to the scene for each primitive of each node that makes triangles, and the default material if one needs
// it. Throws Error for a scene beyond kMaxPrimitives or kMaxTriangles before any is decoded, for what GeometryLoader
// refuses, and for a primitive without the texture coordinates that its material uses.
void placeMeshes(const JsonObject& root, const std::vector<PlacedNode>& placed,
                 const std::vector<GltfMaterial>& materials, GeometryLoader& geometry, SceneDescription& scene,
                 Warnings& warnings);

}  // namespace lsde
