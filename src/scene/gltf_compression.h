// Compressed geometry: EXT_meshopt_compression of buffer views, KHR_draco_mesh_compression of primitives. Decoded into
// plain buffer views and accessors before the file is parsed any further. Where the file holds the same data
// uncompressed, too, these are read and nothing is decoded.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_buffers.h"
#include "scene/gltf_json.h"

namespace lsde {

inline constexpr const char* kMeshopt = "EXT_meshopt_compression";
inline constexpr const char* kDraco = "KHR_draco_mesh_compression";

// What a compressed buffer view says of itself, checked.
struct MeshoptView {
    size_t buffer = 0, offset = 0, bytes = 0;  // of the compressed data
    size_t count = 0, stride = 0;              // elements, and bytes of each, once decoded
    std::string mode, filter;
};

// The view's extension, if it has one. Throws Error for what the extension forbids.
std::optional<MeshoptView> readMeshoptView(const JsonObject& view, size_t buffers);

// The primitive's Draco extension, if some of its vertices or indices are there in no other way.
std::optional<JsonObject> neededDraco(const JsonObject& root, const JsonObject& primitive);

// Rewrites a validated file's JSON so that it has no compressed geometry, and appends to the buffers what was decoded.
// Throws Error for data that are damaged.
void decodeCompressed(Json& json, const std::string& file, GltfBuffers& buffers);

// ---- the two libraries

// count x stride bytes. Throws Error, without the object's name.
std::string decodeMeshopt(const MeshoptView& view, std::span<const unsigned char> bytes);

// An accessor that a Draco mesh is to fill: its elements in the accessor's own format.
struct DracoTarget {
    uint32_t attribute = 0;  // unique id within the Draco mesh; of no meaning for indices
    int componentType = 5126;
    size_t components = 1;
    size_t count = 0;
    std::string bytes{};  // decoded, tightly packed
};

// Fills the targets, and indices if there are any. Throws Error, without the primitive's name.
void decodeDraco(std::span<const unsigned char> bytes, std::span<DracoTarget> attributes, DracoTarget* indices);

}  // namespace lsde
