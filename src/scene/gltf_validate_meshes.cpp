// Meshes: what each primitive refers to, and whether its accessors are of the kinds that it may use.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string_view>

#include "scene/gltf_compression.h"
#include "scene/gltf_validate_parts.h"

namespace lsde {

namespace {

constexpr int kFloat = 5126, kUint32 = 5125;

bool isIndexType(int componentType) {
    return componentType == 5121 || componentType == 5123 || componentType == kUint32;
}

// "TEXCOORD_1" to "TEXCOORD".
std::string_view semanticOf(std::string_view attribute) {
    return attribute.starts_with('_') ? attribute : attribute.substr(0, attribute.find('_'));
}

// What is wrong with the format of an attribute that is read here; nothing if it is sound, or not read.
// The formats are those of glTF 2.0, section 3.7.2.1, and with KHR_mesh_quantization any 8 or 16 bits.
std::string wrongFormat(std::string_view semantic, const AccessorInfo& a, bool quantized) {
    const bool isNormalizedUnsigned = a.normalized && (a.componentType == 5121 || a.componentType == 5123);
    const bool isSmall = a.componentType < kUint32;
    if (semantic == "POSITION") {
        if (a.type != "VEC3" || !(a.componentType == kFloat || (quantized && isSmall))) return "VEC3 of float";
    } else if (semantic == "NORMAL" || semantic == "TANGENT") {
        const bool isSigned = a.componentType == 5120 || a.componentType == 5122;
        const std::string_view type = semantic == "NORMAL" ? "VEC3" : "VEC4";
        if (a.type != type || !(a.componentType == kFloat || (quantized && a.normalized && isSigned)))
            return fmt::format("{} of float", type);
    } else if (semantic == "TEXCOORD") {
        if (a.type != "VEC2" || !(a.componentType == kFloat || isNormalizedUnsigned || (quantized && isSmall)))
            return "VEC2 of float or normalized unsigned";
    } else if (semantic == "COLOR") {
        if ((a.type != "VEC3" && a.type != "VEC4") || !(a.componentType == kFloat || isNormalizedUnsigned))
            return "VEC3 or VEC4 of float or normalized unsigned";
    }
    return {};
}

void checkHasData(const GltfChecks& checks, const JsonObject& primitive, size_t accessor) {
    if (!checks.accessors[accessor].hasData)
        primitive.fail(fmt::format("accessor {} is in a buffer without data, expected a uri or a BIN chunk", accessor));
}

// Attributes by name. Counts must be equal; formats are checked of those that are read.
std::map<std::string, size_t> checkAttributes(const GltfChecks& checks, const JsonObject& primitive) {
    std::map<std::string, size_t> attributes;
    const JsonObject object = primitive.object("attributes").value();
    for (const auto& [name, value] : object.json().items())
        attributes[name] = object.reference(name.c_str(), "accessor", checks.accessors.size()).value();
    for (const auto& [name, index] : attributes) {
        const AccessorInfo& a = checks.accessors[index];
        const std::string expected = wrongFormat(semanticOf(name), a, checks.uses("KHR_mesh_quantization"));
        if (!expected.empty())
            primitive.fail(fmt::format("{}: accessor {} is {} of componentType {}{}, expected {}", name, index, a.type,
                                       a.componentType, a.normalized ? " normalized" : "", expected));
        const auto& [firstName, first] = *attributes.begin();
        if (a.count != checks.accessors[first].count)
            primitive.fail(fmt::format("{} has {} elements, but {} has {}", name, a.count, firstName,
                                       checks.accessors[first].count));
        checkHasData(checks, primitive, index);
    }
    return attributes;
}

void checkIndices(const GltfChecks& checks, const JsonObject& primitive, size_t index, bool compressed) {
    const AccessorInfo& a = checks.accessors[index];
    if (a.type != "SCALAR" || !isIndexType(a.componentType) || a.normalized)
        primitive.fail(
            fmt::format("indices: accessor {} is {} of componentType {}, expected SCALAR of 5121, 5123 or 5125", index,
                        a.type, a.componentType));
    if (!a.view && compressed) return;
    if (!a.view) primitive.fail(fmt::format("indices: accessor {} has no buffer view", index));
    if (checks.views[*a.view].stride != 0)
        primitive.fail(fmt::format("indices: buffer view {} has a byteStride, expected none for indices", *a.view));
    checkHasData(checks, primitive, index);
}

// Of what is there in Draco's form alone: that it is there, and names what it holds.
void checkDraco(const GltfChecks& checks, const JsonObject& primitive, const JsonObject& draco) {
    for (const char* key : {"bufferView", "attributes"}) draco.require(key);
    const size_t view = draco.reference("bufferView", "buffer view", checks.views.size()).value();
    if (!checks.views[view].hasData) draco.fail(fmt::format("{}: buffer view {} has no data", kDraco, view));
    if (const int64_t mode = primitive.integer("mode", 4, 0, 6); mode != 4 && mode != 5)
        draco.fail(fmt::format("{}: mode {}, expected 4 or 5", kDraco, mode));
    const JsonObject attributes = primitive.object("attributes").value(), ids = draco.object("attributes").value();
    if (!ids.has("POSITION")) ids.fail("no POSITION");
    for (const auto& [name, id] : ids.json().items()) {
        ids.integer(name.c_str(), 0, 0, std::numeric_limits<uint32_t>::max());
        if (!attributes.has(name.c_str()))
            ids.fail(fmt::format("{} is not among the primitive's attributes", shown(name)));
        const AccessorInfo& a =
            checks.accessors[attributes.reference(name.c_str(), "accessor", checks.accessors.size()).value()];
        if (a.type != "SCALAR" && !a.type.starts_with("VEC"))
            ids.fail(fmt::format("{}: accessor of type {}", shown(name), a.type));
    }
}

// Which accessors use a buffer view for vertices: with more than one, the view must say its stride (section 3.6.2.1).
using ViewUsers = std::map<size_t, size_t>;

void checkShared(const GltfChecks& checks, const JsonObject& primitive, const std::map<std::string, size_t>& attributes,
                 ViewUsers& users) {
    for (const auto& [name, index] : attributes) {
        const AccessorInfo& a = checks.accessors[index];
        if (!a.view) continue;
        const auto [at, added] = users.try_emplace(*a.view, index);
        if (at->second != index && checks.views[*a.view].stride == 0)
            primitive.fail(fmt::format("{}: accessors {} and {} share buffer view {}, which has no byteStride", name,
                                       at->second, index, *a.view));
    }
}

// Morph targets: what is added to positions and normals, one element for each vertex.
void checkTargets(const GltfChecks& checks, const JsonObject& primitive,
                  const std::map<std::string, size_t>& attributes) {
    for (const JsonObject& target : primitive.objects("targets", "target"))
        for (const auto& [name, value] : target.json().items()) {
            const size_t index = target.reference(name.c_str(), "accessor", checks.accessors.size()).value();
            const AccessorInfo& a = checks.accessors[index];
            if (name != "POSITION" && name != "NORMAL") continue;
            const std::string expected = wrongFormat(name, a, checks.uses("KHR_mesh_quantization"));
            if (!expected.empty())
                target.fail(fmt::format("{}: accessor {} is {} of componentType {}, expected {}", name, index, a.type,
                                        a.componentType, expected));
            const auto base = attributes.find("POSITION");
            if (base != attributes.end() && a.count != checks.accessors[base->second].count)
                target.fail(fmt::format("{} has {} elements, but POSITION has {}", name, a.count,
                                        checks.accessors[base->second].count));
            checkHasData(checks, primitive, index);
        }
}

void checkPrimitive(const GltfChecks& checks, const JsonObject& primitive, ViewUsers& users) {
    primitive.require("attributes");
    primitive.integer("mode", 4, 0, 6);
    primitive.reference("material", "material", checks.root.size("materials"));
    const std::map<std::string, size_t> attributes = checkAttributes(checks, primitive);
    const auto draco = neededDraco(checks.root, primitive);
    if (draco) checkDraco(checks, primitive, *draco);
    checkShared(checks, primitive, attributes, users);
    if (const auto indices = primitive.reference("indices", "accessor", checks.accessors.size()))
        checkIndices(checks, primitive, *indices, draco.has_value());
    checkTargets(checks, primitive, attributes);
}

}  // namespace

void checkMeshes(const GltfChecks& checks) {
    ViewUsers users;
    for (const JsonObject& mesh : checks.root.objects("meshes", "mesh")) {
        mesh.require("primitives");
        for (const JsonObject& primitive : mesh.objects("primitives", "primitive"))
            checkPrimitive(checks, primitive, users);
        mesh.numbers("weights", mesh.size("weights"), {});
    }
}

}  // namespace lsde
