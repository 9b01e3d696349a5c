// Materials as the file states them.
#include <doctest/doctest.h>

#include "scene/gltf_file.h"

using namespace lsde;
using namespace lsde::test;

namespace {

Json withExtension(const std::string& name, Json properties) {
    return {{"name", "water"}, {"extensions", {{"KHR_materials_" + name, std::move(properties)}}}};
}

Material materialOf(const Json& json) { return load(triangleFileWith(json)).materials[0]; }

void checkMaterialRefusals(const std::vector<std::pair<Json, const char*>>& rows) {
    for (const auto& [material, message] : rows) {
        CAPTURE(material.dump());
        const std::string said = refusalOf(triangleFileWith(material));
        CHECK_MESSAGE(contains(said, message), said);
    }
}

}  // namespace

TEST_CASE("a material without properties has the specification's defaults, and so has a primitive without material") {
    const SceneDescription none = load(triangleFile());
    REQUIRE(none.materials.size() == 1);
    CHECK(none.materials[0].name == "default");
    for (const Material& m : {none.materials[0], materialOf(Json::object())}) {
        CHECK(m.baseColor == Rgb(1));
        CHECK(m.metallic == 1);
        CHECK(m.roughness == 1);
        CHECK(m.ior == 1.5F);
        CHECK(m.specular == 1);
        CHECK(m.transmission == 0);
        CHECK(!m.volume);
        CHECK(!m.emissive());
        CHECK(!m.doubleSided);
        CHECK(m.alphaMode == AlphaMode::Opaque);
        CHECK(m.alphaCutoff == 0.5F);
    }
    GltfFile both = triangleFileWith({{"name", "own"}});
    both.add("meshes", triangleFile()["/meshes/0"]);
    both.node({{"mesh", 1}});
    const SceneDescription scene = load(both);
    REQUIRE(scene.materials.size() == 2);
    CHECK(scene.meshes[0].material == 0);
    CHECK(scene.meshes[1].material == 1);
}

TEST_CASE("every property of a material is read") {
    const Material m =
        materialOf({{"name", "all"},
                    {"doubleSided", true},
                    {"emissiveFactor", {0.5, 0.25, 1}},
                    {"alphaMode", "MASK"},
                    {"alphaCutoff", 0.75},
                    {"pbrMetallicRoughness",
                     {{"baseColorFactor", {0.1, 0.2, 0.3, 0.875}}, {"metallicFactor", 0}, {"roughnessFactor", 0}}},
                    {"extensions",
                     {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                      {"KHR_materials_dispersion", {{"dispersion", 0.5}}},
                      {"KHR_materials_ior", {{"ior", 1.33}}},
                      {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {2, 1, 0}}}},
                      {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                      {"KHR_materials_volume",
                       {{"thicknessFactor", 0.1}, {"attenuationDistance", 3}, {"attenuationColor", {0.5, 1, 0}}}}}}});
    CHECK(m.name == "all");
    CHECK(m.doubleSided);
    CHECK(m.emission == Rgb(4, 2, 8));
    CHECK(m.baseColor == Rgb(0.1F, 0.2F, 0.3F));
    CHECK(m.alphaMode == AlphaMode::Mask);
    CHECK(m.alpha == 0.875F);
    CHECK(m.alphaCutoff == 0.75F);
    CHECK(m.metallic == 0);
    CHECK(m.roughness == 0);
    CHECK(m.ior == 1.33F);
    CHECK(m.dispersion == 0.5F);
    CHECK(m.specular == 0.5F);
    CHECK(m.specularColor == Rgb(2, 1, 0));
    CHECK(m.transmission == 1);
    REQUIRE(m.volume);
    CHECK(m.volume->attenuationDistance == 3);
    CHECK(m.volume->attenuationColor == Rgb(0.5F, 1, 0));
    CHECK(m.isSolid());
}

TEST_CASE("anisotropy, iridescence, sheen and clearcoat are read, lengths in metres; factors of 0 are as none") {
    Json json = {{"extensions",
                  {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 1.5}}},
                   {"KHR_materials_iridescence",
                    {{"iridescenceFactor", 0.5}, {"iridescenceIor", 1.4}, {"iridescenceThicknessMaximum", 800}}},
                   {"KHR_materials_sheen", {{"sheenColorFactor", {0.1, 0.2, 0.3}}, {"sheenRoughnessFactor", 0.7}}},
                   {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.9}, {"clearcoatRoughnessFactor", 0.1}}}}}};
    const Material m = materialOf(json);
    REQUIRE(m.anisotropy);
    CHECK(m.anisotropy->strength == 0.6F);
    CHECK(m.anisotropy->rotation == 1.5F);
    REQUIRE(m.iridescence);
    CHECK(m.iridescence->factor == 0.5F);
    CHECK(m.iridescence->ior == 1.4F);
    CHECK(m.iridescence->thicknessMinimum == doctest::Approx(1e-7));
    CHECK(m.iridescence->thicknessMaximum == doctest::Approx(8e-7));
    REQUIRE(m.sheen);
    CHECK(m.sheen->color == Rgb(0.1F, 0.2F, 0.3F));
    CHECK(m.sheen->roughness == 0.7F);
    REQUIRE(m.clearcoat);
    CHECK(m.clearcoat->factor == 0.9F);
    CHECK(m.clearcoat->roughness == 0.1F);
    for (auto& [name, extension] : json["extensions"].items()) extension = Json::object();
    const Material none = materialOf(json);
    CHECK_FALSE((none.anisotropy || none.iridescence || none.sheen || none.clearcoat));
}

TEST_CASE("thickness tells a solid from a thin wall, and transmission either from an opaque body") {
    const auto with = [](double transmission, double thickness, double metallic) {
        Json json = withExtension("volume", {{"thicknessFactor", thickness}});
        json["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", transmission}};
        json["pbrMetallicRoughness"] = {{"metallicFactor", metallic}, {"roughnessFactor", 0}};
        return materialOf(json);
    };
    CHECK(with(1, 1, 0).isSolid());
    CHECK(with(1, 0, 0).isThinWall());
    CHECK(!with(0, 1, 0).isSolid());
    CHECK(!with(0, 1, 0).isThinWall());
    // A metal lets nothing through.
    CHECK(!with(1, 1, 1).isSolid());
}

TEST_CASE("a property outside its range is refused by material, property, value and range") {
    const auto pbr = [](const char* key, const Json& value) {
        return Json{{"name", "water"}, {"pbrMetallicRoughness", {{key, value}}}};
    };
    checkMaterialRefusals({
        {withExtension("ior", {{"ior", 0.2}}), "material \"water\": ior 0.2, expected 0 or >= 1"},
        {withExtension("ior", {{"ior", -1}}), "material \"water\": ior -1, expected 0 or >= 1"},
        {withExtension("ior", {{"ior", "glass"}}), "material \"water\": ior \"glass\", expected a number"},
        {withExtension("volume", {{"attenuationDistance", 0}}),
         "material \"water\": attenuationDistance 0, expected a number > 0"},
        {withExtension("volume", {{"thicknessFactor", -1}}), "thicknessFactor -1, expected a number >= 0"},
        {withExtension("volume", {{"attenuationColor", {0.5, 0.5, 1.5}}}),
         "attenuationColor[2] 1.5, expected a number in [0, 1]"},
        {withExtension("emissive_strength", {{"emissiveStrength", -2}}), "emissiveStrength -2, expected a number >= 0"},
        {withExtension("emissive_strength", {{"emissiveStrength", 1e200}}),
         "emissiveStrength 1e+200, expected a number >= 0"},
        {withExtension("dispersion", {{"dispersion", -0.1}}),
         "material \"water\": dispersion -0.1, expected a number >= 0"},
        {withExtension("specular", {{"specularFactor", 1.01}}), "specularFactor 1.01, expected a number in [0, 1]"},
        {withExtension("specular", {{"specularColorFactor", {1, -1, 1}}}),
         "specularColorFactor[1] -1, expected a number >= 0"},
        {withExtension("transmission", {{"transmissionFactor", 2}}),
         "transmissionFactor 2, expected a number in [0, 1]"},
        {pbr("metallicFactor", -0.1),
         "material \"water\" pbrMetallicRoughness: metallicFactor -0.1, expected a number in [0, 1]"},
        {pbr("roughnessFactor", 2), "roughnessFactor 2, expected a number in [0, 1]"},
        {pbr("baseColorFactor", {1, 1, 1}), "baseColorFactor has 3 numbers, expected 4"},
        {pbr("baseColorFactor", {1, 1, 1, 2}), "baseColorFactor[3] 2, expected a number in [0, 1]"},
        {{{"emissiveFactor", {0, 0, 2}}}, "material 0: emissiveFactor[2] 2, expected a number in [0, 1]"},
        {{{"alphaMode", "GLASS"}}, "alphaMode \"GLASS\", expected OPAQUE, MASK or BLEND"},
    });
    CHECK(materialOf(withExtension("ior", {{"ior", 0}})).ior == 0);
}

TEST_CASE("what is rendered otherwise than the file says gets one warning, with its count") {
    const auto warned = [](const Json& material, const char* text) {
        return warnsOnce(load(triangleFileWith(material)), text);
    };
    CHECK(warned(withExtension("transmission", {{"transmissionFactor", 1}}), "transmission has no effect on a metal"));
    Json glass = withExtension("transmission", {{"transmissionFactor", 1}});
    glass["pbrMetallicRoughness"] = {{"metallicFactor", 0}};
    glass["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}};
    CHECK(warned(glass, "anisotropy, iridescence, sheen and clearcoat are not rendered on glass"));
    CHECK_FALSE(materialOf(glass).clearcoat);
    Json lamp = withExtension("clearcoat", {{"clearcoatFactor", 1}});
    lamp["emissiveFactor"] = {1, 1, 1};
    CHECK(warned(lamp, "a clearcoat does not dim the emission below it"));
    CHECK(warned(withExtension("dispersion", {{"dispersion", 1}}), "dispersion has no effect on what is not a solid"));
    const Json gauze = {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.1}}}}};
    CHECK(warned(gauze, "material 0: alphaMode BLEND with little alpha is not glass"));
    CHECK(load(triangleFileWith({{"alphaMode", "BLEND"}})).warnings.empty());
    GltfFile file = triangleFile();
    file.json["extensionsUsed"] = {"KHR_materials_made_up", "KHR_materials_pbrSpecularGlossiness",
                                   "KHR_materials_volume"};
    file.json["materials"] = {gauze, gauze, gauze};
    file.json["animations"] = {Json::object()};
    const SceneDescription scene = load(file);
    CHECK(scene.warnings.size() == 4);
    CHECK(warnsOnce(scene, "scene.gltf: extension \"KHR_materials_made_up\" is ignored"));
    CHECK(warnsOnce(scene, "extension \"KHR_materials_pbrSpecularGlossiness\" is ignored"));
    CHECK(warnsOnce(scene,
                    "material 0: alphaMode BLEND with little alpha is not glass: light passes it unbent (glass "
                    "has KHR_materials_transmission) (3 in all)"));
    CHECK(warnsOnce(scene, "animations: shown at rest (--at SEC shows a time)"));
}

TEST_CASE("an unlit material is a matte surface of its colour, and says so") {
    Json unlit = withExtension("unlit", Json::object());
    unlit["pbrMetallicRoughness"] = {{"baseColorFactor", {0.25, 0.5, 1, 1}}};
    unlit["emissiveFactor"] = {1, 1, 1};
    const SceneDescription scene = load(triangleFileWith(unlit));
    CHECK(warnsOnce(scene, "material \"water\": KHR_materials_unlit is rendered as a matte surface of its colour"));
    const Material& m = scene.materials[0];
    CHECK(m.baseColor == Rgb(0.25F, 0.5F, 1));
    CHECK(m.metallic == 0);
    CHECK(m.specular == 0);
    CHECK(!m.emissive());
}

TEST_CASE("a variant gives meshes its materials, and those that it does not name keep theirs") {
    GltfFile file = triangleFileWith({{"name", "own"}});
    file.add("materials", {{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
    file.json["extensions"]["KHR_materials_variants"] = {{"variants", {{{"name", "day"}}, {{"name", "dusk"}}}}};
    file["/meshes/0/primitives/0/extensions/KHR_materials_variants"] = {
        {"mappings", {{{"material", 1}, {"variants", {1}}}}}};
    const auto shownMaterial = [&](const std::string& variant) {
        GltfOptions options;
        options.variant = variant;
        const SceneDescription scene = load(file, options);
        CHECK(scene.variants == std::vector<std::string>{"day", "dusk"});
        return scene.materials[scene.meshes[0].material].name;
    };
    CHECK(shownMaterial("") == "own");
    CHECK(shownMaterial("day") == "own");
    CHECK(shownMaterial("dusk") == "red");
    const std::string said = errorOf([&] { shownMaterial("night"); });
    CHECK(contains(said, "variant \"night\": does not exist, expected one of: \"day\", \"dusk\""));
    file["/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/variants/0"] = 2;
    CHECK(contains(errorOf([&] { shownMaterial("dusk"); }), "mapping 0: variant 2 does not exist (2 variants)"));
}
