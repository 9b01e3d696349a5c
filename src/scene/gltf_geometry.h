// Triangles of a glTF file's meshes, each decoded once however many nodes show it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/gltf_model.h"
#include "scene/mesh_builder.h"
#include "scene/warnings.h"

namespace lsde {

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

    const GltfModel& model() const { return model_; }
    // Of a mesh, known before any is decoded.
    uint64_t primitives(size_t mesh) const { return model_.meshes[mesh].size(); }
    uint64_t triangles(size_t mesh) const;
    // The mesh's primitives that make triangles; the others get a warning. Throws Error for an index beyond the
    // vertices, a value that is not finite, or a sparse index out of order.
    // Morphed by the weights of its targets, if there are any.
    const std::vector<LoadedPrimitive>& mesh(size_t index, const std::vector<double>& weights);

  private:
    const GltfAccessor& accessor(int index) const { return model_.accessors[static_cast<size_t>(index)]; }
    void addPrimitive(std::vector<LoadedPrimitive>& out, const GltfPrimitive& primitive,
                      const std::vector<double>& weights, const std::string& where);
    std::vector<uint32_t> readCorners(const GltfPrimitive& primitive, const std::string& where) const;
    void readVertices(const GltfPrimitive& primitive, const std::vector<double>& weights, PrimitiveData& data);

    void morph(const std::map<std::string, int>& target, float weight, const std::vector<uint32_t>& vertices,
               PrimitiveData& data);

    std::string file_;
    const GltfModel& model_;
    Warnings& warnings_;
    VertexSelector selector_;
    std::map<std::pair<size_t, std::vector<double>>, std::vector<LoadedPrimitive>> meshes_;  // by mesh and weights
};

}  // namespace lsde
