// The bytes of a glTF file's buffers, and of whatever else lies behind its URIs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf_json.h"
#include "scene/gltf_validate.h"

namespace lsde {

// Where the bytes behind URIs come from. The root must outlive it.
struct GltfResources {
    const JsonObject& root;
    std::filesystem::path folder;
    bool allowOutside = false;

    // Of an object's uri, at most `limit`. Throws Error.
    std::string behindUri(const JsonObject& object, uint64_t limit) const;
};

// Cut to their byteLength. None: a buffer without data, which nothing reads.
using GltfBuffers = std::vector<std::optional<std::string>>;

// Reads all of them; takes the source's binary chunk. Throws Error.
GltfBuffers readBuffers(const GltfResources& resources, GltfSource& source);

}  // namespace lsde
