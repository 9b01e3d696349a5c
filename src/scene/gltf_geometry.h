// Triangles of a glTF file's meshes, each decoded once however many nodes show it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/gltf_accessor.h"
#include "scene/mesh_builder.h"
#include "scene/warnings.h"

namespace lsde {

struct GltfPrimitive {
    int mode = 4;                           // 0-3: points and lines; 4-6: PrimitiveMode
    int indices = -1;                       // accessor; -1: vertices in their order
    int material = -1;                      // -1: the default material
    std::map<std::string, int> attributes;  // accessor of each
};

// The binary part of a file, as its JSON describes it.
struct GltfModel {
    std::vector<GltfAccessor> accessors;
    std::vector<std::vector<GltfPrimitive>> meshes;
};

// A primitive that makes triangles, and its material.
struct LoadedPrimitive {
    PrimitiveData data;
    int material = -1;
};

class GeometryLoader {
  public:
    // The model must outlive this.
    GeometryLoader(std::string file, const GltfModel& model, Warnings& warnings)
        : file_(std::move(file)), model_(model), warnings_(warnings) {}

    // Of a mesh, known before any is decoded.
    uint64_t primitives(size_t mesh) const { return model_.meshes[mesh].size(); }
    uint64_t triangles(size_t mesh) const;
    // The mesh's primitives that make triangles; the others get a warning. Throws Error for an index beyond the
    // vertices, a value that is not finite, or a sparse index out of order.
    const std::vector<LoadedPrimitive>& mesh(size_t index);

  private:
    const GltfAccessor& accessor(int index) const { return model_.accessors[static_cast<size_t>(index)]; }
    void addPrimitive(std::vector<LoadedPrimitive>& out, const GltfPrimitive& primitive, const std::string& where);
    std::vector<uint32_t> readCorners(const GltfPrimitive& primitive, const std::string& where) const;
    void readVertices(const GltfPrimitive& primitive, PrimitiveData& data);

    std::string file_;
    const GltfModel& model_;
    Warnings& warnings_;
    VertexSelector selector_;
    std::map<size_t, std::vector<LoadedPrimitive>> meshes_;
};

}  // namespace lsde
