// Cameras and lights that hang on a scene's nodes. From the raw JSON of a validated file.
#pragma once

#include <optional>
#include <vector>

#include "scene/description.h"
#include "scene/gltf_json.h"
#include "scene/gltf_nodes.h"
#include "scene/warnings.h"

namespace lsde {

// As the file lists them, used or not: named, but not placed. No light where its type is unknown.
struct GltfAttachments {
    std::vector<CameraDescription> cameras;
    std::vector<std::optional<PunctualLight>> lights;
};

// Throws Error for a property outside its range.
GltfAttachments readAttachments(const JsonObject& root, Warnings& warnings);

// Those of the placed nodes, in their order. Throws Error for a node whose matrix leaves no direction.
std::vector<CameraDescription> placeCameras(const GltfAttachments& attachments, const JsonObject& root,
                                            const std::vector<PlacedNode>& placed);
// Sets the light's position and directions. Throws Error likewise.
void placeLight(const JsonObject& node, const glm::dmat4& frame, PunctualLight& light);
std::vector<PunctualLight> placeLights(const GltfAttachments& attachments, const JsonObject& root,
                                       const std::vector<PlacedNode>& placed);

}  // namespace lsde
