// EXT_lights_ies: lights with a measured distribution.
#pragma once

#include <vector>

#include "scene/description.h"
#include "scene/gltf_buffers.h"
#include "scene/gltf_model.h"
#include "scene/gltf_nodes.h"
#include "scene/warnings.h"

namespace lsde {

// Those of the placed nodes, in their order. Throws Error for a profile that cannot be read, and for a node whose
// matrix leaves no direction.
std::vector<PunctualLight> placeMeasuredLights(const GltfResources& resources, const GltfModel& model,
                                               const std::vector<PlacedNode>& placed, Warnings& warnings);

}  // namespace lsde
