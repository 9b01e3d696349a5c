#include "scene/gltf_material.h"

#include <fmt/format.h>

namespace lsde {

namespace {

Rgb toRgb(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

float factor(const JsonObject& object, const char* key, double fallback, Range range = kUnitInterval) {
    return static_cast<float>(object.number(key, fallback, range));
}

Rgb colorFactor(const JsonObject& object, const char* key, double fallback, Range range = kUnitInterval) {
    return toRgb(object.numbers(key, 3, std::vector<double>(3, fallback), range));
}

// KHR_texture_transform: matrices T R S. With v downwards the rotation has this sign, by the extension's own example
// (the lower left quadrant turned by 90 degrees) and as viewers have it; its GLSL shows the transpose.
void readTextureTransform(const JsonObject& transform, TextureRef& ref) {
    const std::vector<double> offset = transform.numbers("offset", 2, {0, 0});
    const std::vector<double> scale = transform.numbers("scale", 2, {1, 1});
    const double rotation = transform.number("rotation", 0);
    const double c = std::cos(rotation), s = std::sin(rotation);
    ref.matrix = Vec4(c * scale[0], s * scale[1], -s * scale[0], c * scale[1]);
    ref.offset = Vec2(offset[0], offset[1]);
}

TextureRef readTexture(const JsonObject& root, const JsonObject& object, const char* key) {
    TextureRef ref;
    const auto use = object.object(key);
    if (!use) return ref;
    use->require("index");
    ref.texture = static_cast<int>(use->reference("index", "texture", root.size("textures")).value());
    ref.texCoord = static_cast<int>(use->integer("texCoord", 0, 0, 1));
    if (const auto transform = use->extension("KHR_texture_transform")) {
        readTextureTransform(*transform, ref);
        ref.texCoord = static_cast<int>(transform->integer("texCoord", ref.texCoord, 0, 1));
    }
    return ref;
}

void readMetallicRoughness(const JsonObject& root, const JsonObject& pbr, Material& m) {
    const std::vector<double> baseColor = pbr.numbers("baseColorFactor", 4, {1, 1, 1, 1}, kUnitInterval);
    m.baseColor = toRgb(baseColor);
    m.alpha = static_cast<float>(baseColor[3]);
    m.baseColorTexture = readTexture(root, pbr, "baseColorTexture");
    m.metallic = factor(pbr, "metallicFactor", 1);
    m.roughness = factor(pbr, "roughnessFactor", 1);
    m.metallicRoughnessTexture = readTexture(root, pbr, "metallicRoughnessTexture");
}

void readSpecular(const JsonObject& root, const JsonObject& object, Material& m) {
    if (const auto ior = object.extension("KHR_materials_ior")) {
        m.ior = factor(*ior, "ior", 1.5, kAnyNumber);
        if (m.ior < 1 && m.ior != 0) object.fail(fmt::format("ior {}, expected 0 or >= 1", shown(ior->json()["ior"])));
    }
    if (const auto specular = object.extension("KHR_materials_specular")) {
        m.specular = factor(*specular, "specularFactor", 1);
        m.specularTexture = readTexture(root, *specular, "specularTexture");
        m.specularColor = colorFactor(*specular, "specularColorFactor", 1, kNotNegative);
        m.specularColorTexture = readTexture(root, *specular, "specularColorTexture");
    }
}

void readVolume(const JsonObject& root, const JsonObject& object, Material& m) {
    const auto volume = object.extension("KHR_materials_volume");
    if (!volume) return;
    VolumeProperties v;
    const float thickness = factor(*volume, "thicknessFactor", 0, kNotNegative);
    if (volume->has("attenuationDistance"))
        v.attenuationDistance = factor(*volume, "attenuationDistance", 0, kPositive);
    v.attenuationColor = colorFactor(*volume, "attenuationColor", 1);
    // Read for its checks alone: the extension asks ray tracers to ignore it.
    readTexture(root, *volume, "thicknessTexture");
    if (thickness > 0) m.volume = v;
}

void readDispersion(const JsonObject& object, Material& m, Warnings& warnings) {
    const auto dispersion = object.extension("KHR_materials_dispersion");
    if (!dispersion) return;
    m.dispersion = factor(*dispersion, "dispersion", 0, kNotNegative);
    if (m.dispersion > 0 && !m.isSolid())
        warnings.add("dispersion has no effect on what is not a solid (KHR_materials_transmission and _volume)",
                     object.where());
}

// What is rendered otherwise than the extension says goes into a warning.
void readTransmission(const JsonObject& root, const JsonObject& object, Material& m, Warnings& warnings) {
    if (const auto transmission = object.extension("KHR_materials_transmission")) {
        m.transmission = factor(*transmission, "transmissionFactor", 0);
        m.transmissionTexture = readTexture(root, *transmission, "transmissionTexture");
    }
    readVolume(root, object, m);
    if (m.transmission > 0 && m.metallic == 1 && !m.metallicRoughnessTexture) {
        warnings.add("transmission has no effect on a metal (metallicFactor is 1 unless given)", object.where());
        m.transmission = 0;
    }
}

std::optional<AnisotropyProperties> readAnisotropy(const JsonObject& root, const JsonObject& object) {
    const auto extension = object.extension("KHR_materials_anisotropy");
    if (!extension) return {};
    AnisotropyProperties a;
    a.strength = factor(*extension, "anisotropyStrength", 0);
    a.rotation = factor(*extension, "anisotropyRotation", 0, kAnyNumber);
    a.texture = readTexture(root, *extension, "anisotropyTexture");
    if (a.strength == 0) return {};
    return a;
}

std::optional<IridescenceProperties> readIridescence(const JsonObject& root, const JsonObject& object) {
    const auto extension = object.extension("KHR_materials_iridescence");
    if (!extension) return {};
    constexpr float kNanometre = 1e-9F;
    IridescenceProperties i;
    i.factor = factor(*extension, "iridescenceFactor", 0);
    i.ior = factor(*extension, "iridescenceIor", 1.3, kPositive);
    i.thicknessMinimum = kNanometre * factor(*extension, "iridescenceThicknessMinimum", 100, kNotNegative);
    i.thicknessMaximum = kNanometre * factor(*extension, "iridescenceThicknessMaximum", 400, kNotNegative);
    i.texture = readTexture(root, *extension, "iridescenceTexture");
    i.thicknessTexture = readTexture(root, *extension, "iridescenceThicknessTexture");
    if (i.factor == 0) return {};
    return i;
}

std::optional<SheenProperties> readSheen(const JsonObject& root, const JsonObject& object) {
    const auto extension = object.extension("KHR_materials_sheen");
    if (!extension) return {};
    SheenProperties s;
    s.color = colorFactor(*extension, "sheenColorFactor", 0);
    s.roughness = factor(*extension, "sheenRoughnessFactor", 0);
    s.colorTexture = readTexture(root, *extension, "sheenColorTexture");
    s.roughnessTexture = readTexture(root, *extension, "sheenRoughnessTexture");
    if (isBlack(s.color)) return {};
    return s;
}

std::optional<ClearcoatProperties> readClearcoat(const JsonObject& root, const JsonObject& object) {
    const auto extension = object.extension("KHR_materials_clearcoat");
    if (!extension) return {};
    ClearcoatProperties c;
    c.factor = factor(*extension, "clearcoatFactor", 0);
    c.roughness = factor(*extension, "clearcoatRoughnessFactor", 0);
    c.texture = readTexture(root, *extension, "clearcoatTexture");
    c.roughnessTexture = readTexture(root, *extension, "clearcoatRoughnessTexture");
    c.normalTexture = readTexture(root, *extension, "clearcoatNormalTexture");
    if (c.normalTexture) c.normalScale = factor(*extension->object("clearcoatNormalTexture"), "scale", 1, kAnyNumber);
    if (c.factor == 0) return {};
    return c;
}

// Layers of opaque materials. Glass that has them is rendered without, and a coat does not dim what lies under it
// shines.
void readLayers(const JsonObject& root, const JsonObject& object, Material& m, Warnings& warnings) {
    m.anisotropy = readAnisotropy(root, object);
    m.iridescence = readIridescence(root, object);
    m.sheen = readSheen(root, object);
    m.clearcoat = readClearcoat(root, object);
    if (m.clearcoat && m.emissive()) warnings.add("a clearcoat does not dim the emission below it", object.where());
    if (!(m.transmission > 0) || !m.hasLayers()) return;
    warnings.add("anisotropy, iridescence, sheen and clearcoat are not rendered on glass", object.where());
    m.removeLayers();
}

void readEmission(const JsonObject& root, const JsonObject& object, Material& m) {
    const Rgb emissive = colorFactor(object, "emissiveFactor", 0);
    const auto extension = object.extension("KHR_materials_emissive_strength");
    const float strength = extension ? factor(*extension, "emissiveStrength", 1, kNotNegative) : 1;
    m.emission = emissive * strength;
    m.emissiveTexture = readTexture(root, object, "emissiveTexture");
}

// A colour that no light makes has no place among light paths: it becomes what is nearest to it.
void readUnlit(const JsonObject& object, Material& m, Warnings& warnings) {
    if (!object.extension("KHR_materials_unlit")) return;
    warnings.add("KHR_materials_unlit is rendered as a matte surface of its colour, lit as everything else",
                 object.where());
    m.metallic = m.specular = m.transmission = 0;
    m.roughness = 1;
    m.metallicRoughnessTexture = m.specularTexture = m.transmissionTexture = m.normalTexture = {};
    m.emission = Rgb(0);
    m.volume.reset();
    m.removeLayers();
}

void readAlpha(const JsonObject& object, Material& m, Warnings& warnings) {
    const std::string mode = object.has("alphaMode") ? object.string("alphaMode") : "OPAQUE";
    if (mode == "MASK")
        m.alphaMode = AlphaMode::Mask;
    else if (mode == "BLEND")
        m.alphaMode = AlphaMode::Blend;
    else if (mode != "OPAQUE")
        object.fail(fmt::format("alphaMode {}, expected OPAQUE, MASK or BLEND", shown(mode)));
    m.alphaCutoff = factor(object, "alphaCutoff", 0.5, kNotNegative);
    // Many exporters write glass so.
    constexpr float kMostlyOpen = 0.5F;
    if (m.alphaMode == AlphaMode::Blend && m.alpha < kMostlyOpen && !(m.transmission > 0))
        warnings.add(
            "alphaMode BLEND with little alpha is not glass: light passes it unbent (glass has "
            "KHR_materials_transmission)",
            object.where());
}

GltfMaterial readMaterial(const JsonObject& root, const JsonObject& object, Warnings& warnings) {
    GltfMaterial out;
    Material& m = out.material;
    m.name = object.string("name");
    m.doubleSided = object.boolean("doubleSided", false);
    if (const auto pbr = object.object("pbrMetallicRoughness")) readMetallicRoughness(root, *pbr, m);
    readSpecular(root, object, m);
    readTransmission(root, object, m, warnings);
    readDispersion(object, m, warnings);
    readEmission(root, object, m);
    m.normalTexture = readTexture(root, object, "normalTexture");
    if (m.normalTexture) m.normalScale = factor(*object.object("normalTexture"), "scale", 1, kAnyNumber);
    readLayers(root, object, m, warnings);
    readUnlit(object, m, warnings);
    readAlpha(object, m, warnings);
    out.priority = readPriority(object);
    return out;
}

}  // namespace

std::optional<int> readPriority(const JsonObject& object) {
    const auto extras = object.extras();
    if (!extras || !extras->has("priority")) return {};
    constexpr int64_t kLargest = 1'000'000;
    return static_cast<int>(extras->integer("priority", 0, -kLargest, kLargest));
}

std::vector<GltfMaterial> readMaterials(const JsonObject& root, Warnings& warnings) {
    std::vector<GltfMaterial> out;
    for (const JsonObject& object : root.objects("materials", "material", true))
        out.push_back(readMaterial(root, object, warnings));
    return out;
}

}  // namespace lsde
