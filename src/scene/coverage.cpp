#include "scene/coverage.h"

#include <algorithm>

namespace lsde {

namespace {

bool hasAlpha(const Texture& texture) {
    for (size_t i = 3; i < texture.rgba.size(); i += 4)
        if (texture.rgba[i] != 255) return true;
    return false;
}

}  // namespace

float coverage(const Mesh& mesh, const Material& material, const std::vector<Texture>& textures, uint32_t triangle,
               float u, float v) {
    if (material.alphaMode == AlphaMode::Opaque) return 1;
    const Triangle& t = mesh.triangles[triangle];
    float alpha = material.alpha;
    if (!mesh.colors.empty()) alpha *= interpolated(mesh.colors, t, u, v).w;
    if (const TextureRef& ref = material.baseColorTexture) {
        const auto& uvs = mesh.texCoords[ref.texCoord];
        const Vec2 uv = uvs.empty() ? Vec2(0) : interpolated(uvs, t, u, v);
        alpha *= textures[static_cast<size_t>(ref.texture)].sample(ref.transform(uv), true).w;
    }
    if (material.alphaMode == AlphaMode::Mask) return alpha >= material.alphaCutoff ? 1 : 0;
    return std::clamp(alpha, 0.0F, 1.0F);
}

bool coversPartly(const Mesh& mesh, const Material& material, const std::vector<Texture>& textures) {
    if (material.alphaMode == AlphaMode::Opaque) return false;
    const float least = material.alphaMode == AlphaMode::Mask ? material.alphaCutoff : 1;
    if (material.alpha < least) return true;
    const auto& colors = mesh.colors;
    if (std::any_of(colors.begin(), colors.end(), [](const Vec4& c) { return c.w < 1; })) return true;
    const TextureRef& ref = material.baseColorTexture;
    return ref && hasAlpha(textures[static_cast<size_t>(ref.texture)]);
}

}  // namespace lsde
