// EXT_mesh_gpu_instancing: one node that shows its mesh at many places.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "scene/gltf_json.h"
#include "scene/gltf_model.h"

namespace lsde {

// What places instances; other attributes are an application's own.
inline constexpr std::array<const char*, 3> kInstanceAttributes = {"TRANSLATION", "ROTATION", "SCALE"};

// How many times a node of a validated file shows its mesh: 1 without the extension.
uint64_t instanceCount(const JsonObject& node, const GltfModel& model);

// The matrix of each, within the node's space: T R S. The identity without the extension. Throws Error for a rotation
// that is none, and for what is not finite.
std::vector<glm::dmat4> readInstances(const JsonObject& node, const GltfModel& model);

}  // namespace lsde
