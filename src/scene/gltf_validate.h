// Checks the raw JSON of a glTF file before any other code sees it: own limits on depth, size and counts; types;
// references, used or not; cycles; existence of files. Materials, lights and cameras are checked where they are read
// (gltf_material.h, gltf_attachments.h), which comes before tinygltf too.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/warnings.h"

namespace lsde {

struct GltfSource {
    std::string json;    // text of the JSON chunk or file
    std::string binary;  // the GLB's BIN chunk
    bool isGlb = false;
    bool hasBinary = false;
};

// Reads .gltf or .glb (told apart by content). Throws Error: missing, empty, truncated, bad magic or version, chunks
// beyond the file, JSON chunk not first, byte-order mark.
GltfSource readGltfSource(const std::filesystem::path& file, Warnings& warnings);

// Throws Error naming file, object ("mesh 2 primitive 0"), value and what was expected: not JSON, too deep (limit
// named), or not valid glTF that this program can render. Adds warnings.
nlohmann::json validateGltf(const std::filesystem::path& file, const GltfSource& source, bool allowOutside,
                            Warnings& warnings);

}  // namespace lsde
