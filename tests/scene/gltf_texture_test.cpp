// Textures: pictures, samplers and coordinates.
#include <doctest/doctest.h>

#include "image/png.h"
#include "scene/gltf_file.h"
#include "support/near.h"

using namespace lsde;
using namespace lsde::test;

namespace {

// A picture of 2 x 2 texels: red, green; blue, white.
std::string fourTexels() { return encodePngBytes(2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}); }

GltfFile texturedFile(const std::string& picture, const Json& use = {{"index", 0}}) {
    GltfFile file = triangleFileWith({{"pbrMetallicRoughness", {{"baseColorTexture", use}}}});
    file["/meshes/0/primitives/0/attributes/TEXCOORD_0"] = file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    file.add("textures", {{"source", 0}});
    file.add("images", {{"mimeType", "image/png"}, {"bufferView", file.view(picture)}});
    return file;
}

}  // namespace

TEST_CASE("a texture is decoded to linear texels, top row first, and interpolated between their centres") {
    const SceneDescription scene = load(texturedFile(fourTexels()));
    REQUIRE(scene.textures.size() == 1);
    const Texture& t = scene.textures[0];
    CHECK(t.width == 2);
    CHECK(t.height == 2);
    const auto sampled = [&](float u, float v) { return Vec3(t.sample({u, v}, true)); };
    CHECK(sampled(0.25F, 0.25F) == Vec3(1, 0, 0));
    CHECK(sampled(0.75F, 0.25F) == Vec3(0, 1, 0));
    CHECK(sampled(0.25F, 0.75F) == Vec3(0, 0, 1));
    checkNear(sampled(0.5F, 0.25F), {0.5F, 0.5F, 0});
    checkNear(sampled(0.5F, 0.5F), {0.5F, 0.5F, 0.5F});
}

TEST_CASE("texels are sRGB where they are colours and linear where they are data") {
    Texture t;
    t.width = t.height = 1;
    t.rgba = {128, 128, 128, 128};
    CHECK(t.sample({0.5F, 0.5F}, true).x == doctest::Approx(0.2158605));
    CHECK(t.sample({0.5F, 0.5F}, false).x == doctest::Approx(128.0 / 255));
    CHECK(t.sample({0.5F, 0.5F}, true).w == doctest::Approx(128.0 / 255));
}

TEST_CASE("coordinates outside the picture repeat, mirror or clamp, however far out") {
    Texture t;
    t.width = 2;
    t.height = 1;
    t.rgba = {0, 0, 0, 255, 255, 0, 0, 255};
    const auto at = [&](float u, Wrap wrap, bool nearest = false) {
        t.wrapS = wrap;
        t.nearest = nearest;
        return t.sample({u, 0.5F}, false).x;
    };
    CHECK(at(1.25F, Wrap::Repeat) == 0);
    CHECK(at(-0.25F, Wrap::Repeat) == 1);
    CHECK(at(0, Wrap::Repeat) == 0.5F);
    CHECK(at(1.25F, Wrap::Mirror) == 1);
    CHECK(at(-0.25F, Wrap::Mirror) == 0);
    CHECK(at(1, Wrap::Mirror) == 1);
    CHECK(at(5, Wrap::Clamp) == 1);
    CHECK(at(-5, Wrap::Clamp) == 0);
    CHECK(at(0.49F, Wrap::Repeat, true) == 0);
    CHECK(at(0.51F, Wrap::Repeat, true) == 1);
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
        for (const float u :
             {1e30F, -1e30F, -1e-30F, kInfinity, std::numeric_limits<float>::quiet_NaN(), 0.99999994F, 1.0F, 2.0F})
            for (const bool nearest : {false, true}) {
                const float x = at(u, wrap, nearest);
                CHECK((x >= 0 && x <= 1));
            }
}

TEST_CASE("samplers set wrapping and filter, and only known values") {
    GltfFile file = texturedFile(fourTexels());
    file.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9987}});
    file["/textures/0/sampler"] = 0;
    const Texture t = load(file).textures[0];
    CHECK(t.wrapS == Wrap::Clamp);
    CHECK(t.wrapT == Wrap::Mirror);
    CHECK(t.nearest);
    file["/samplers/0/wrapS"] = 1;
    CHECK(contains(refusalOf(file), "sampler 0: wrapS 1, expected 10497"));
}

TEST_CASE("KHR_texture_transform moves, turns and scales, and may choose another set") {
    const auto refOf = [](const Json& transform) {
        GltfFile file =
            texturedFile(fourTexels(), {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}});
        file["/meshes/0/primitives/0/attributes/TEXCOORD_1"] = file["/meshes/0/primitives/0/attributes/TEXCOORD_0"];
        return load(file).materials[0].baseColorTexture;
    };
    const auto near = [](Vec2 a, Vec2 b) { return glm::length(a - b) < 1e-6F; };
    CHECK(near(refOf({{"offset", {0.5, 0.25}}, {"scale", {2, 4}}}).transform({1, 1}), {2.5F, 4.25F}));
    // The extension's own example: the lower left quadrant of the picture, turned by 90 degrees.
    const TextureRef turned = refOf({{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}});
    CHECK(near(turned.transform({0, 0}), {0, 1}));
    CHECK(near(turned.transform({1, 0}), {0, 0.5F}));
    CHECK(near(turned.transform({0, 1}), {0.5F, 1}));
    CHECK(refOf({{"texCoord", 1}}).texCoord == 1);
    CHECK(contains(refusalOf(texturedFile(fourTexels(), {{"index", 0}, {"texCoord", 2}})),
                   "texCoord 2, expected a whole number in [0, 1]"));
}

TEST_CASE("each use of a texture has its own set and transform") {
    const auto use = [](double offset) {
        return Json{{"index", 0},
                    {"texCoord", 0},
                    {"extensions", {{"KHR_texture_transform", {{"offset", {offset, 0}}, {"texCoord", 1}}}}}};
    };
    GltfFile file = texturedFile(fourTexels());
    file["/meshes/0/primitives/0/attributes/TEXCOORD_1"] = file["/meshes/0/primitives/0/attributes/TEXCOORD_0"];
    file["/materials/0"] = {
        {"pbrMetallicRoughness", {{"baseColorTexture", use(1)}, {"metallicRoughnessTexture", use(2)}}},
        {"emissiveTexture", use(3)},
        {"extensions",
         {{"KHR_materials_transmission", {{"transmissionFactor", 0}, {"transmissionTexture", use(4)}}},
          {"KHR_materials_specular", {{"specularTexture", use(5)}, {"specularColorTexture", use(6)}}}}}};
    const Material m = load(file).materials[0];
    float expected = 1;
    for (const TextureRef* ref : {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.emissiveTexture,
                                  &m.transmissionTexture, &m.specularTexture, &m.specularColorTexture}) {
        CHECK(ref->offset == Vec2(expected++, 0));
        CHECK(ref->texCoord == 1);
    }
}

TEST_CASE("a primitive without the texture coordinates that its material uses is refused") {
    GltfFile file = texturedFile(fourTexels(), {{"index", 0}, {"texCoord", 1}});
    CHECK(contains(refusalOf(file), "mesh 0 primitive 0: no TEXCOORD_1, which its material \"\" uses"));
}

TEST_CASE("pictures of 16 bits are rounded to 8") {
    // One grey texel of 0x80FF, by another encoder.
    GltfFile file = texturedFile(fourTexels());
    file["/images/0"] = {
        {"uri",
         "data:image/"
         "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABEAAAAABq7kcWAAAAC0lEQVR4nGNo+A8AAgIBgG5WixMAAAAASUVORK5CYII="}};
    CHECK(load(file).textures.at(0).rgba == std::vector<uint8_t>{128, 128, 128, 255});
}

TEST_CASE("pictures come as JPEG, too, and as files in the scene's folder") {
    // 3 x 2 texels of grey 120, by another encoder.
    GltfFile jpeg = texturedFile(fourTexels());
    jpeg["/images/0"] = {
        {"uri",
         "data:image/jpeg;base64,/9j/4AAQSkZJRgABAQAAAQABAAD/"
         "2wBDABALDA4MChAODQ4SERATGCgaGBYWGDEjJR0oOjM9PDkzODdASFxOQERXRTc4UG1RV19iZ2hnPk1xeXBkeFxlZ2P/wAALCAACAAMBAREA/"
         "8QAFAABAAAAAAAAAAAAAAAAAAAAA//EABQQAQAAAAAAAAAAAAAAAAAAAAD/2gAIAQEAAD8AN//Z"}};
    const Texture grey = load(jpeg).textures.at(0);
    CHECK(grey.width == 3);
    CHECK(grey.height == 2);
    CHECK(std::abs(grey.rgba[0] - 120) <= 2);
    CHECK(grey.rgba[3] == 255);

    const TemporaryFolder folder;
    GltfFile file = texturedFile(fourTexels());
    file["/images/0"] = {{"uri", "a%20picture.png"}};
    put(folder / "scene.gltf", file.text());
    put(folder / "a picture.png", fourTexels());
    CHECK(loadGltf(folder / "scene.gltf").textures.at(0).rgba == load(texturedFile(fourTexels())).textures.at(0).rgba);
    std::filesystem::remove(folder / "a picture.png");
    CHECK(
        contains(errorOf([&] { loadGltf(folder / "scene.gltf"); }), "image 0: uri \"a%20picture.png\": no such file"));
}

TEST_CASE("a picture that is no picture, too large, or of another format is refused before it is decoded") {
    std::string bomb = fourTexels();
    bomb.replace(16, 8, std::string("\0\0\x40\0\0\0\x40\0", 8));
    CHECK(contains(refusalOf(texturedFile(bomb)), "image 0: 16384 x 16384 pixels, expected 1 to 67108864"));
    bomb.replace(16, 8, std::string(8, '\0'));
    CHECK(contains(refusalOf(texturedFile(bomb)), "image 0: 0 x 0 pixels"));
    bomb.replace(16, 8, std::string("\0\0\0\x20\0\0\0\x20", 8));
    CHECK(contains(refusalOf(texturedFile(bomb)), "image 0: cannot be decoded"));
    CHECK(contains(refusalOf(texturedFile(fourTexels().substr(0, 20))), "image 0: its header is cut short"));
    CHECK(contains(refusalOf(texturedFile("RIFF....WEBPVP8 ")), "image 0: a WebP picture whose header is damaged"));
    CHECK(contains(refusalOf(texturedFile("\xABKTX 20\xBB\r\n\x1A\n")), "image 0: KTX2, expected PNG, JPEG or WebP"));
    CHECK(contains(refusalOf(texturedFile("text")), "image 0: an unknown format, expected PNG, JPEG or WebP"));
    CHECK(contains(refusalOf(texturedFile("\xFF\xD8\xFF\xDA")), "image 0: a damaged JPEG"));
    GltfFile none = texturedFile(fourTexels());
    none["/textures/0"] = Json::object();
    CHECK(contains(refusalOf(none), "texture 0: no source, expected a PNG, JPEG or WebP image"));
    GltfFile both = texturedFile(fourTexels());
    both["/images/0/uri"] = "a.png";
    CHECK(contains(refusalOf(both), "image 0: expected either uri or bufferView"));
    // What nothing shows is not decoded.
    GltfFile unused = texturedFile("RIFF....WEBPVP8 ");
    unused["/materials/0"] = Json::object();
    CHECK(refusalOf(unused).empty());
}

TEST_CASE("WebP pictures are decoded, and taken before what is there for those that cannot read them") {
    GltfFile file = texturedFile(fourTexels());
    // The same four texels, the blue one half covering, by another encoder.
    file.add("images",
             {{"uri", "data:image/webp;base64,UklGRioAAABXRUJQVlA4TB0AAAAvAUAAEB+w/wKCIv9Hm38BQdF1y0U2JWEXIvofAgA="}});
    file["/textures/0/extensions/EXT_texture_webp/source"] = 1;
    CHECK(load(file).textures.at(0).rgba ==
          std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 128, 255, 255, 255, 255});
    file["/textures/0"].erase("source");
    CHECK(load(file).textures.at(0).rgba[14] == 255);
    file["/textures/0/extensions/EXT_texture_webp/source"] = 2;
    CHECK(contains(refusalOf(file), "texture 0: image 2 does not exist (2 images)"));
}

TEST_CASE("a KTX2 picture's fallback is taken with a warning; without one the texture is refused") {
    GltfFile file = texturedFile(fourTexels());
    file.add("images", {{"bufferView", file.view("\xABKTX 20\xBB\r\n\x1A\n")}, {"mimeType", "image/ktx2"}});
    file["/textures/0/extensions/KHR_texture_basisu/source"] = 1;
    const SceneDescription scene = load(file);
    CHECK(scene.textures.at(0).rgba == load(texturedFile(fourTexels())).textures.at(0).rgba);
    CHECK(warnsOnce(scene, "texture 0: KTX2 (KHR_texture_basisu) is not supported: its fallback picture is taken"));
    file["/textures/0"].erase("source");
    CHECK(contains(refusalOf(file), "texture 0: KTX2 (KHR_texture_basisu) without a fallback"));
}
