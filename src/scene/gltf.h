// Loads glTF 2.0 (.gltf, .glb): validates, reads, decodes, places.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/description.h"

namespace lsde {

struct GltfOptions {
    std::string scene;                // name or index; empty: the file's default scene, else the first
    std::string variant;              // of KHR_materials_variants, by name; empty: the file's own materials
    std::optional<double> atSeconds;  // where its animations have the scene at this time; none: at rest
    bool allowOutside = false;        // buffers and images outside the scene's folder
    // Gets the warnings of a file that is then refused; those of a file that loads are in the result.
    std::function<void(const std::string&)> onWarning;
};

// Throws Error "FILE: OBJECT: value, expected ..." for whatever render would refuse. No light or no camera is not an
// error here.
SceneDescription loadGltf(const std::filesystem::path& file, const GltfOptions& options = {});

}  // namespace lsde
