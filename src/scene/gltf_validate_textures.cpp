// Images, samplers and textures, and every material's use of one.
#include <fmt/format.h>

#include <array>

#include "scene/gltf_limits.h"
#include "scene/gltf_validate_parts.h"

namespace lsde {

namespace {

// Every texture that a material of glTF 2.0 itself may use: {object within the material, property}.
constexpr std::array<std::array<const char*, 2>, 5> kCoreTextures = {
    {{"pbrMetallicRoughness", "baseColorTexture"},
     {"pbrMetallicRoughness", "metallicRoughnessTexture"},
     {nullptr, "normalTexture"},
     {nullptr, "occlusionTexture"},
     {nullptr, "emissiveTexture"}}};

void checkImage(const GltfChecks& checks, const JsonObject& image) {
    if (image.has("uri") == image.has("bufferView")) image.fail("expected either uri or bufferView");
    image.string("mimeType");
    uint64_t bytes = 0;
    if (const auto index = image.reference("bufferView", "buffer view", checks.views.size())) {
        const ViewInfo& view = checks.views[*index];
        if (!view.hasData) image.fail(fmt::format("buffer {} has no data", view.buffer));
        bytes = view.bytes;
    } else {
        bytes = bytesBehindUri(checks, image);
    }
    if (bytes == 0 || bytes > kMaxImageBytes)
        image.fail(fmt::format("{} bytes, expected 1 to {}", bytes, kMaxImageBytes));
}

void checkSampler(const JsonObject& sampler) {
    for (const char* key : {"wrapS", "wrapT"}) {
        const int64_t wrap = sampler.integer(key, 10497, 0, 1 << 16);
        if (wrap != 10497 && wrap != 33648 && wrap != 33071)
            sampler.fail(fmt::format("{} {}, expected 10497 (repeat), 33648 (mirror) or 33071 (clamp)", key, wrap));
    }
    const int64_t filter = sampler.integer("magFilter", 9729, 0, 1 << 16);
    if (filter != 9728 && filter != 9729)
        sampler.fail(fmt::format("magFilter {}, expected 9728 (nearest) or 9729 (linear)", filter));
    sampler.integer("minFilter", 9729, 9728, 9987);
}

}  // namespace

void checkTextures(const GltfChecks& checks) {
    for (const JsonObject& image : checks.root.objects("images", "image")) checkImage(checks, image);
    for (const JsonObject& sampler : checks.root.objects("samplers", "sampler")) checkSampler(sampler);
    for (const JsonObject& texture : checks.root.objects("textures", "texture")) {
        texture.reference("source", "image", checks.root.size("images"));
        for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu"})
            if (const auto extension = texture.extension(name))
                extension->reference("source", "image", checks.root.size("images"));
        texture.reference("sampler", "sampler", checks.root.size("samplers"));
    }
    for (const JsonObject& material : checks.root.objects("materials", "material", true))
        for (const auto& [within, key] : kCoreTextures) {
            const auto holder = within == nullptr ? std::optional(material) : material.object(within);
            const auto use = holder ? holder->object(key) : std::nullopt;
            if (!use) continue;
            use->require("index");
            use->reference("index", "texture", checks.root.size("textures"));
        }
}

}  // namespace lsde
