// The parts of gltf_validate, in the order in which they run; each may use what those before it found.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/gltf_json.h"
#include "scene/gltf_validate.h"

namespace lsde {

struct BufferInfo {
    uint64_t bytes = 0;
    bool hasData = true;  // false: neither uri nor BIN chunk (a fallback that an extension replaces)
};

struct ViewInfo {
    size_t buffer = 0;
    uint64_t offset = 0, bytes = 0;
    uint64_t stride = 0;  // 0: tightly packed
    bool hasData = true;  // false: in a buffer without data
};

struct AccessorInfo {
    std::optional<size_t> view;
    uint64_t offset = 0, count = 0;
    int componentType = 0;  // of OpenGL: 5120 i8, 5121 u8, 5122 i16, 5123 u16, 5125 u32, 5126 f32
    std::string type;       // "VEC3"
    bool normalized = false;
    bool hasData = true;  // false: in a buffer without data
};

// What validation knows of the file so far.
struct GltfChecks {
    JsonObject root;
    std::filesystem::path folder;
    bool allowOutside = false;
    const GltfSource& source;
    Warnings& warnings;
    std::set<std::string> extensionsUsed;
    std::vector<BufferInfo> buffers;
    std::vector<ViewInfo> views;
    std::vector<AccessorInfo> accessors;

    bool uses(const std::string& extension) const { return extensionsUsed.count(extension) > 0; }
};

// asset, extensionsUsed and extensionsRequired.
void checkAsset(const GltfChecks& checks);
void checkExtensions(GltfChecks& checks);

// Size of what an object's uri stands for; of a file no more than its size is looked at.
uint64_t bytesBehindUri(const GltfChecks& checks, const JsonObject& object);

// buffers, bufferViews and accessors: sizes, offsets, strides and alignment; that the buffers' files exist.
void checkBuffers(GltfChecks& checks);
void checkBufferViews(GltfChecks& checks);
void checkAccessors(GltfChecks& checks);

// images, samplers, textures, and every material's use of one.
void checkTextures(const GltfChecks& checks);

// meshes: each primitive's references, and that its accessors are of the kinds that attributes and indices may be.
void checkMeshes(const GltfChecks& checks);

// nodes and scenes: references, and that each node has one parent and is not its own ancestor.
void checkNodes(const GltfChecks& checks);

// animations: references, and that samplers have as many values of the right kind as their keys ask for.
void checkAnimations(const GltfChecks& checks);

}  // namespace lsde
