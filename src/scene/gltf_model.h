// The binary part of a glTF file, as its JSON describes it. gltf_model.cpp is the one file that includes tinygltf; it
// sees only what gltf_validate passed.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_accessor.h"
#include "scene/gltf_buffers.h"
#include "scene/texture.h"

namespace lsde {

struct GltfPrimitive {
    int mode = 4;                                     // 0-3: points and lines; 4-6: PrimitiveMode
    int indices = -1;                                 // accessor; -1: vertices in their order
    int material = -1;                                // -1: the default material
    std::map<std::string, int> attributes;            // accessor of each
    std::vector<std::map<std::string, int>> targets;  // morph targets: accessor of what is added to each attribute
};

// Accessors and views point into the buffers.
struct GltfModel {
    std::vector<std::vector<unsigned char>> buffers;
    std::vector<std::span<const unsigned char>> views;  // empty: in a buffer without data
    std::vector<GltfAccessor> accessors;
    std::vector<std::vector<GltfPrimitive>> meshes;
};

// Throws Error. Consumes the buffers.
GltfModel parseModel(const JsonObject& root, GltfBuffers buffers);

// Decodes a PNG or JPEG of the texture's width and height, known from its header, to 8 bits RGBA. False if its data are
// damaged.
bool decodePngOrJpeg(std::span<const unsigned char> bytes, Texture& texture);

}  // namespace lsde
