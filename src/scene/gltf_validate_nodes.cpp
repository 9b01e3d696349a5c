// Nodes and scenes: references, and the shape of the hierarchy.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scene/gltf_limits.h"
#include "scene/gltf_validate_parts.h"

namespace lsde {

namespace {

constexpr size_t kNone = std::numeric_limits<size_t>::max();

size_t lightCount(const GltfChecks& checks, const char* extension) {
    const auto lights = checks.root.extension(extension);
    return lights ? lights->size("lights") : 0;
}

void checkTransform(const JsonObject& node) {
    const std::vector<double> matrix = node.numbers("matrix", 16, {});
    if (!matrix.empty()) {
        for (const char* key : {"translation", "rotation", "scale"})
            if (node.has(key)) node.fail(fmt::format("both matrix and {}, expected one of them", key));
        if (matrix[3] != 0 || matrix[7] != 0 || matrix[11] != 0 || matrix[15] != 1)
            node.fail(fmt::format("matrix with last row {} {} {} {}, expected 0 0 0 1", matrix[3], matrix[7],
                                  matrix[11], matrix[15]));
    }
    node.numbers("translation", 3, {});
    node.numbers("scale", 3, {});
    const std::vector<double> q = node.numbers("rotation", 4, {0, 0, 0, 1});
    if (q == std::vector<double>(4, 0.0)) node.fail("rotation [0,0,0,0], expected a unit quaternion");
}

// The formats are the extension's: floats, or normalised signed integers for rotations.
void checkInstances(const GltfChecks& checks, const JsonObject& node) {
    const auto extension = node.extension("EXT_mesh_gpu_instancing");
    if (!extension) return;
    extension->require("attributes");
    const JsonObject attributes = extension->object("attributes").value();
    std::optional<size_t> first;
    for (const auto& [name, value] : attributes.json().items()) {
        const size_t index = attributes.reference(name.c_str(), "accessor", checks.accessors.size()).value();
        const AccessorInfo& a = checks.accessors[index];
        if (!first) first = index;
        if (a.count != checks.accessors[*first].count)
            attributes.fail(fmt::format("{} has {} elements, others have {}", shown(name), a.count,
                                        checks.accessors[*first].count));
        const bool isRotation = name == "ROTATION";
        if (!isRotation && name != "TRANSLATION" && name != "SCALE") continue;
        const bool isSmall = isRotation && a.normalized && (a.componentType == 5120 || a.componentType == 5122);
        if (a.type != (isRotation ? "VEC4" : "VEC3") || !(a.componentType == 5126 || isSmall))
            attributes.fail(fmt::format("{}: accessor {} is {} of componentType {}, expected {} of float", name, index,
                                        a.type, a.componentType, isRotation ? "VEC4" : "VEC3"));
        if (!a.hasData) attributes.fail(fmt::format("accessor {} is in a buffer without data", index));
    }
}

void checkNode(const GltfChecks& checks, const JsonObject& node) {
    checkTransform(node);
    node.reference("mesh", "mesh", checks.root.size("meshes"));
    node.numbers("weights", node.size("weights"), {});
    node.reference("camera", "camera", checks.root.size("cameras"));
    if (node.reference("skin", "skin", checks.root.size("skins")))
        checks.warnings.add("skinning is not rendered: the mesh is shown at rest", node.where());
    checkInstances(checks, node);
    for (const char* extension : {"KHR_lights_punctual", "EXT_lights_ies"})
        if (const auto light = node.extension(extension)) {
            light->require("light");
            light->reference("light", "light", lightCount(checks, extension));
        }
}

// Each node's parent, kNone for roots.
std::vector<size_t> parentsOf(const std::vector<JsonObject>& nodes) {
    std::vector<size_t> parents(nodes.size(), kNone);
    for (size_t i = 0; i < nodes.size(); ++i)
        for (const size_t child : nodes[i].references("children", "node", nodes.size())) {
            if (parents[child] != kNone)
                nodes[child].fail(fmt::format("has two parents, nodes {} and {}", parents[child], i));
            parents[child] = i;
        }
    return parents;
}

// Follows each node's parents up, once; no node has two.
void checkAncestors(const JsonObject& root, const std::vector<size_t>& parents) {
    constexpr size_t kUnknown = kNone, kBelow = kNone - 1;  // kBelow: on the way up now
    std::vector<size_t> depth(parents.size(), kUnknown);
    std::vector<size_t> way;
    for (size_t start = 0; start < parents.size(); ++start) {
        way.clear();
        size_t node = start;
        for (; node != kNone && depth[node] == kUnknown; node = parents[node]) {
            depth[node] = kBelow;
            way.push_back(node);
        }
        if (node != kNone && depth[node] == kBelow) root.fail(fmt::format("node {} is its own ancestor", node));
        size_t above = node == kNone ? 0 : depth[node] + 1;
        for (auto at = way.rbegin(); at != way.rend(); ++at) depth[*at] = above++;
        if (above > kMaxNodeDepth + 1)
            root.fail(fmt::format("node {} has {} nodes above it, limit {}", start, above - 1, kMaxNodeDepth));
    }
}

void checkScene(const JsonObject& scene, const std::vector<size_t>& parents) {
    std::vector<size_t> nodes = scene.references("nodes", "node", parents.size());
    for (const size_t node : nodes)
        if (parents[node] != kNone)
            scene.fail(fmt::format("node {} has parent node {}, expected a root", node, parents[node]));
    std::sort(nodes.begin(), nodes.end());
    if (const auto twice = std::adjacent_find(nodes.begin(), nodes.end()); twice != nodes.end())
        scene.fail(fmt::format("node {} is listed twice", *twice));
}

}  // namespace

void checkNodes(const GltfChecks& checks) {
    checks.root.objects("skins", "skin");
    const std::vector<JsonObject> nodes = checks.root.objects("nodes", "node");
    for (const JsonObject& node : nodes) checkNode(checks, node);
    const std::vector<size_t> parents = parentsOf(nodes);
    checkAncestors(checks.root, parents);
    for (const JsonObject& scene : checks.root.objects("scenes", "scene")) checkScene(scene, parents);
    checks.root.reference("scene", "scene", checks.root.size("scenes"));
}

}  // namespace lsde
