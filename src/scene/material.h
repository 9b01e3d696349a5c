// Materials as glTF states them. Scene turns one into a Bsdf value at each hit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "scene/texture.h"

namespace lsde {

// KHR_materials_volume with thicknessFactor > 0: a solid.
struct VolumeProperties {
    Rgb attenuationColor{1};
    float attenuationDistance = kInfinity;  // m
};

struct AnisotropyProperties {  // KHR_materials_anisotropy
    float strength = 0;
    float rotation = 0;  // rad, from the tangent towards the bitangent
    TextureRef texture;  // rg: direction, b: strength
};

struct IridescenceProperties {  // KHR_materials_iridescence
    float factor = 0;
    float ior = 1.3F;
    float thicknessMinimum = 1e-7F, thicknessMaximum = 4e-7F;  // m
    TextureRef texture;                                        // r: factor
    TextureRef thicknessTexture;                               // g: from minimum to maximum; without it the maximum
};

struct SheenProperties {  // KHR_materials_sheen
    Rgb color{0};
    float roughness = 0;
    TextureRef colorTexture;      // sRGB
    TextureRef roughnessTexture;  // alpha
};

struct ClearcoatProperties {  // KHR_materials_clearcoat
    float factor = 0;
    float roughness = 0;
    TextureRef texture;           // r: factor
    TextureRef roughnessTexture;  // g
    TextureRef normalTexture;     // its own; without it the normals of the mesh
    float normalScale = 1;
};

// Whether alpha counts (glTF 2.0, section 3.9.4), by coverage.h.
enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

struct Material {
    std::string name;
    bool doubleSided = false;

    AlphaMode alphaMode = AlphaMode::Opaque;
    float alpha = 1;           // of baseColorFactor
    float alphaCutoff = 0.5F;  // Mask: covers from this alpha on

    Rgb baseColor{1};  // linear
    TextureRef baseColorTexture;
    float metallic = 1;
    float roughness = 1;                  // glTF's; alpha = roughness^2
    TextureRef metallicRoughnessTexture;  // g: roughness, b: metallic; linear

    float ior = 1.5F;            // KHR_materials_ior; 0 means F0 = 1 (the extension's special case)
    float specular = 1;          // KHR_materials_specular.specularFactor
    TextureRef specularTexture;  // alpha
    Rgb specularColor{1};
    TextureRef specularColorTexture;

    float transmission = 0;          // KHR_materials_transmission.transmissionFactor
    TextureRef transmissionTexture;  // r
    std::optional<VolumeProperties> volume;
    float dispersion = 0;  // KHR_materials_dispersion: 20 / Abbe number; of solids

    TextureRef normalTexture;  // x along the tangent, y along the bitangent, z along the normal, from [0,1] to [-1,1]
    float normalScale = 1;     // of x and y

    std::optional<AnisotropyProperties> anisotropy;
    std::optional<IridescenceProperties> iridescence;
    std::optional<SheenProperties> sheen;
    std::optional<ClearcoatProperties> clearcoat;

    Rgb emission{0};             // emissiveFactor x emissiveStrength, W/(m2 sr)
    TextureRef emissiveTexture;  // sRGB

    // All of its textures, used or not.
    std::vector<const TextureRef*> textures() const {
        std::vector<const TextureRef*> out = {&baseColorTexture,     &metallicRoughnessTexture, &specularTexture,
                                              &specularColorTexture, &transmissionTexture,      &emissiveTexture};
        if (normalTexture) out.push_back(&normalTexture);
        if (anisotropy) out.push_back(&anisotropy->texture);
        if (iridescence) out.insert(out.end(), {&iridescence->texture, &iridescence->thicknessTexture});
        if (sheen) out.insert(out.end(), {&sheen->colorTexture, &sheen->roughnessTexture});
        if (clearcoat)
            out.insert(out.end(), {&clearcoat->texture, &clearcoat->roughnessTexture, &clearcoat->normalTexture});
        return out;
    }
    // What is beyond metallic-roughness on opaque materials.
    bool hasLayers() const { return anisotropy || iridescence || sheen || clearcoat; }
    void removeLayers() {
        anisotropy.reset();
        iridescence.reset();
        sheen.reset();
        clearcoat.reset();
    }
    bool usesTangents() const { return normalTexture || anisotropy || (clearcoat && clearcoat->normalTexture); }
    bool emissive() const { return maxComponent(emission) > 0; }
    bool isSolid() const { return transmission > 0 && volume.has_value(); }
    bool isThinWall() const { return transmission > 0 && !volume.has_value(); }
};

}  // namespace lsde
