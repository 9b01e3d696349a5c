// Animations, frozen at a time.
#pragma once

#include "scene/gltf_json.h"
#include "scene/gltf_model.h"
#include "scene/warnings.h"

namespace lsde {

// Puts the nodes of a validated file where its animations have them at this time (glTF 2.0, section 3.11, appendix C):
// rewrites their translation, rotation, scale and weights. Before the first key and after the last one these hold. All
// animations of the file are taken; where several move the same property of a node, the first. Throws Error for keys
// that are not in order.
void applyAnimations(Json& json, const std::string& file, const GltfModel& model, double seconds, Warnings& warnings);

}  // namespace lsde
