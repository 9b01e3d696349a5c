#include "scene/gltf_placement.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/gltf_instances.h"
#include "scene/gltf_limits.h"

namespace lsde {

namespace {

// A node of the scene that shows a mesh.
struct NodeMesh {
    const PlacedNode& placed;
    JsonObject node;
    size_t mesh;
};

std::vector<NodeMesh> meshesOf(const JsonObject& root, const std::vector<PlacedNode>& placed) {
    const std::vector<JsonObject> nodes = root.objects("nodes", "node");
    std::vector<NodeMesh> out;
    for (const PlacedNode& p : placed)
        if (const auto mesh = nodes[p.index].reference("mesh", "mesh", root.size("meshes")))
            out.push_back({p, nodes[p.index], *mesh});
    return out;
}

// Nodes cannot share children, but many may show one mesh, and one mesh may be large.
void checkSceneSize(const JsonObject& root, const std::vector<NodeMesh>& meshes, const GeometryLoader& geometry) {
    constexpr uint64_t kMany = std::max(kMaxPrimitives, kMaxTriangles) + 1;
    uint64_t primitives = 0, triangles = 0;
    for (const NodeMesh& m : meshes) {
        const uint64_t instances = std::min(kMany, instanceCount(m.node, geometry.model()));
        primitives += instances * std::min(kMany, geometry.primitives(m.mesh));
        triangles += instances * std::min(kMany, geometry.triangles(m.mesh));
        if (primitives > kMaxPrimitives)
            root.fail(fmt::format("the scene's nodes show more than {} primitives", kMaxPrimitives));
        if (triangles > kMaxTriangles)
            root.fail(fmt::format("the scene's nodes show more than {} triangles", kMaxTriangles));
    }
}

void checkTexCoords(const JsonObject& root, const Material& material, const PrimitiveData& data) {
    for (const TextureRef* ref : material.textures())
        if (*ref && data.texCoords[ref->texCoord].empty())
            root.fail(fmt::format("{}: no TEXCOORD_{}, which its material {} uses", data.where, ref->texCoord,
                                  shown(material.name)));
}

class MeshPlacer {
  public:
    MeshPlacer(const JsonObject& root, const std::vector<GltfMaterial>& materials, SceneDescription& scene,
               Warnings& warnings)
        : root_(root), materials_(materials), scene_(scene), warnings_(warnings) {}

    void place(const NodeMesh& nodeMesh, GeometryLoader& geometry) {
        const std::vector<glm::dmat4> instances = readInstances(nodeMesh.node, geometry.model());
        const std::vector<LoadedPrimitive>& primitives = geometry.mesh(nodeMesh.mesh, morphWeights(nodeMesh));
        for (const glm::dmat4& instance : instances) {
            // Instances bound solids of their own.
            const size_t id = instances.size() == 1 ? nodeMesh.placed.index : root_.size("nodes") + instances_++;
            placeInstance(nodeMesh, primitives, nodeMesh.placed.world * instance, static_cast<uint32_t>(id));
        }
    }

  private:
    // The node's own, else the mesh's.
    std::vector<double> morphWeights(const NodeMesh& m) const {
        const JsonObject mesh(root_.json()["meshes"][m.mesh], "", root_.file());
        const JsonObject& holder = m.node.has("weights") ? m.node : mesh;
        return holder.numbers("weights", holder.size("weights"), {});
    }
    void placeInstance(const NodeMesh& nodeMesh, const std::vector<LoadedPrimitive>& primitives,
                       const glm::dmat4& world, uint32_t id) {
        const auto& [placed, node, meshIndex] = nodeMesh;
        const CausticSwitches switches = readSwitches(node, warnings_);
        const std::optional<int> priority = readPriority(node);
        const std::string meshName = root_.json()["meshes"][meshIndex].value("name", "");
        if (glm::determinant(glm::dmat3(world)) == 0)
            warnings_.add("its matrix is singular: its mesh is flat or empty", node.where());
        for (const LoadedPrimitive& primitive : primitives) {
            const uint32_t material = materialOf(primitive.material);
            checkTexCoords(root_, scene_.materials[material], primitive.data);
            std::optional<Mesh> mesh = placePrimitive(primitive.data, world, warnings_);
            if (!mesh) continue;
            mesh->object = objectName(node, meshName, "node", placed.index);
            mesh->material = material;
            if (!scene_.materials[material].usesTangents()) mesh->tangents.clear();
            mesh->node = id;
            mesh->switches = switches;
            const std::optional<int> p = priority || primitive.material < 0
                                             ? priority
                                             : materials_[static_cast<size_t>(primitive.material)].priority;
            mesh->hasPriority = p.has_value();
            mesh->priority = p.value_or(0);
            scene_.meshes.push_back(std::move(*mesh));
        }
    }

    // The default material comes after the file's own, once a primitive needs it.
    uint32_t materialOf(int index) {
        if (index >= 0) return static_cast<uint32_t>(index);
        if (scene_.materials.size() == materials_.size()) scene_.materials.push_back({.name = "default"});
        return static_cast<uint32_t>(materials_.size());
    }

    const JsonObject& root_;
    const std::vector<GltfMaterial>& materials_;
    SceneDescription& scene_;
    Warnings& warnings_;
    size_t instances_ = 0;  // so far, of nodes that show several
};

}  // namespace

void placeMeshes(const JsonObject& root, const std::vector<PlacedNode>& placed,
                 const std::vector<GltfMaterial>& materials, GeometryLoader& geometry, SceneDescription& scene,
                 Warnings& warnings) {
    const std::vector<NodeMesh> meshes = meshesOf(root, placed);
    checkSceneSize(root, meshes, geometry);
    MeshPlacer placer(root, materials, scene, warnings);
    for (const NodeMesh& m : meshes) placer.place(m, geometry);
}

}  // namespace lsde
