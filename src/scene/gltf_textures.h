// Textures of a glTF file: samplers, and pictures decoded to texels.
#pragma once

#include <set>
#include <vector>

#include "scene/gltf_model.h"
#include "scene/material.h"
#include "scene/warnings.h"

namespace lsde {

// The file's textures; those that no material in use refers to stay empty. Throws Error for a picture that is damaged,
// of another format or too large, and for all of them together beyond kMaxScenePixels.
std::vector<Texture> loadTextures(const GltfResources& resources, const GltfModel& model,
                                  const std::vector<Material>& materials, const std::set<uint32_t>& used,
                                  Warnings& warnings);

}  // namespace lsde
