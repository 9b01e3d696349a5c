#include "scene/gltf_variants.h"

#include <fmt/format.h>

#include <algorithm>

namespace lsde {

namespace {

constexpr const char* kExtension = "KHR_materials_variants";

size_t variantByName(const JsonObject& root, const std::string& wanted) {
    const std::vector<std::string> names = readVariants(root);
    const auto at = std::find(names.begin(), names.end(), wanted);
    if (at != names.end()) return static_cast<size_t>(at - names.begin());
    std::string there;
    for (const std::string& name : names) there += (there.empty() ? "" : ", ") + shown(name);
    root.fail(fmt::format("variant {}: does not exist, expected one of: {}", shown(wanted),
                          there.empty() ? "(the file has none)" : there));
}

// The material that a variant maps the primitive to, if it maps it at all.
std::optional<size_t> materialIn(const JsonObject& root, const JsonObject& primitive, size_t variant) {
    const auto extension = primitive.extension(kExtension);
    if (!extension) return {};
    const size_t variants = readVariants(root).size();
    std::optional<size_t> material;
    for (const JsonObject& mapping : extension->objects("mappings", "mapping")) {
        mapping.require("material");
        const auto target = mapping.reference("material", "material", root.size("materials"));
        const std::vector<size_t> of = mapping.references("variants", "variant", variants);
        if (!material && std::find(of.begin(), of.end(), variant) != of.end()) material = target;
    }
    return material;
}

}  // namespace

std::vector<std::string> readVariants(const JsonObject& root) {
    std::vector<std::string> names;
    const auto extension = root.extension(kExtension);
    if (!extension) return names;
    for (const JsonObject& variant : extension->objects("variants", "variant")) {
        variant.require("name");
        names.push_back(variant.string("name"));
    }
    return names;
}

void chooseVariant(Json& json, const std::string& file, const std::string& variant) {
    const JsonObject root(json, "", file);
    const size_t chosen = variantByName(root, variant);
    size_t mesh = 0;
    for (const JsonObject& object : root.objects("meshes", "mesh")) {
        Json& primitives = json["meshes"][mesh++]["primitives"];
        size_t index = 0;
        for (const JsonObject& primitive : object.objects("primitives", "primitive")) {
            if (const auto material = materialIn(root, primitive, chosen)) primitives[index]["material"] = *material;
            ++index;
        }
    }
}

}  // namespace lsde
