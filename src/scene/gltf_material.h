// Materials from the raw JSON: all of pbrMetallicRoughness and KHR_materials_* is read here.
#pragma once

#include <optional>
#include <vector>

#include "scene/gltf_json.h"
#include "scene/material.h"
#include "scene/warnings.h"

namespace lsde {

struct GltfMaterial {
    Material material;            // textures by their index in the file
    std::optional<int> priority;  // extras.priority
};

// All materials of a validated file. Throws Error for a property outside its range. Adds a warning for what is rendered
// otherwise than the file says.
std::vector<GltfMaterial> readMaterials(const JsonObject& root, Warnings& warnings);

// extras.priority of a node or a material: which solid wins where two overlap.
std::optional<int> readPriority(const JsonObject& object);

}  // namespace lsde
