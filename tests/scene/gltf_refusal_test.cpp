// What is refused, and by which line.
#include <doctest/doctest.h>

#include "base/error.h"
#include "scene/gltf_file.h"

using namespace lsde;
using namespace lsde::test;

namespace {

// One change to a sound file and what must be said of it.
struct Refusal {
    const char* pointer;
    Json value;
    const char* message;
};

void checkRefusals(const GltfFile& sound, const std::vector<Refusal>& refusals) {
    REQUIRE(refusalOf(sound).empty());
    for (const Refusal& r : refusals) {
        CAPTURE(r.pointer);
        CAPTURE(r.value.dump());
        GltfFile file = sound;
        file[r.pointer] = r.value;
        const std::string said = refusalOf(file);
        CHECK_MESSAGE(contains(said, r.message), said);
        CHECK(said.find('\n') == std::string::npos);
    }
}

GltfFile animated() {
    GltfFile file = triangleFile();
    file.node({{"children", {2}}});
    file.add("nodes", {{"name", "child"}});
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}});
    file["/nodes/1/camera"] = 0;
    return file;
}

// Positions of which the second is replaced by a sparse accessor.
GltfFile sparseFile(const std::vector<uint16_t>& indices) {
    GltfFile file = triangleFile();
    const size_t where = file.view(indices);
    const size_t values = file.view(std::vector<float>(3 * indices.size(), 2.0F));
    file["/accessors/0/sparse"] = {{"count", indices.size()},
                                   {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                                   {"values", {{"bufferView", values}}}};
    return file;
}

}  // namespace

TEST_CASE("a reference to nothing is refused by the names of both ends") {
    checkRefusals(
        animated(),
        {
            {"/nodes/0/mesh", 7, "node 0: mesh 7 does not exist (1 mesh)"},
            {"/nodes/0/mesh", -1, "node 0: mesh -1, expected the index of a mesh"},
            {"/nodes/0/mesh", "0", "node 0: mesh \"0\", expected the index of a mesh"},
            {"/nodes/0/mesh", 0.5, "node 0: mesh 0.5"},
            {"/nodes/1/camera", 1, "node 1: camera 1 does not exist (1 camera)"},
            {"/nodes/1/skin", 0, "node 1: skin 0 does not exist (0 skins)"},
            {"/nodes/1/children", {9}, "node 1: node 9 does not exist (3 nodes)"},
            {"/nodes/2/extensions",
             {{"KHR_lights_punctual", {{"light", 0}}}},
             "node 2: light 0 does not exist (0 lights)"},
            {"/scenes/0/nodes", {3}, "scene 0: node 3 does not exist (3 nodes)"},
            {"/scene", 1, "scene 1 does not exist (1 scene)"},
            {"/meshes/0/primitives/0/material", 0, "mesh 0 primitive 0: material 0 does not exist (0 materials)"},
            {"/meshes/0/primitives/0/indices", 8, "mesh 0 primitive 0: accessor 8 does not exist (2 accessors)"},
            {"/meshes/0/primitives/0/attributes/NORMAL", 8, "mesh 0 primitive 0 attributes: accessor 8 does not exist"},
            {"/meshes/0/primitives/0/targets", {{{"POSITION", 8}}}, "accessor 8 does not exist"},
            {"/accessors/0/bufferView", 5, "accessor 0: buffer view 5 does not exist (2 buffer views)"},
            {"/bufferViews/0/buffer", 1, "buffer view 0: buffer 1 does not exist (1 buffer)"},
            {"/textures", {{{"source", 0}}}, "texture 0: image 0 does not exist (0 images)"},
            {"/textures", {{{"sampler", 2}}}, "texture 0: sampler 2 does not exist (0 samplers)"},
            {"/materials",
             {{{"normalTexture", {{"index", 0}}}}},
             "material 0 normalTexture: texture 0 does not exist (0 textures)"},
        });
}

TEST_CASE("a property of the wrong type is refused") {
    checkRefusals(
        animated(),
        {
            {"/asset", "2.0", "asset: \"2.0\", expected an object"},
            {"/asset/version", 2.0, "asset: version 2.0, expected a string"},
            {"/nodes", Json::object(), "nodes an object, expected an array"},
            {"/nodes/0", 3, "node 0: 3, expected an object"},
            {"/nodes/0/name", 3, "node 0: name 3, expected a string"},
            {"/nodes/0/translation", {1, 2}, "node 0: translation has 2 numbers, expected 3"},
            {"/nodes/0/translation", {1, 2, "3"}, "node 0: translation[2] \"3\", expected a number"},
            {"/nodes/0/translation",
             {1, 2, 1e300},
             "node 0: translation[2] 1e+300, expected a number within a float's range"},
            {"/nodes/0/extras",
             {{"lsde", {{"castsCaustics", 1}}}},
             "node 0 extras lsde: castsCaustics 1, expected true or false"},
            {"/nodes/0/extras", {{"priority", "high"}}, "node 0 extras: priority \"high\", expected a whole number"},
            {"/nodes/0/extras", {{"priority", 1.5}}, "node 0 extras: priority 1.5, expected a whole number"},
            {"/nodes/0/extras", {{"lsde", 1}}, "node 0 extras lsde: 1, expected an object"},
            {"/meshes/0/primitives", Json::object(), "mesh 0: primitives an object, expected an array"},
            {"/meshes/0/primitives/0/mode", 7, "mesh 0 primitive 0: mode 7, expected a whole number in [0, 6]"},
            {"/extensionsUsed", {1}, "extensionsUsed 1, expected a string"},
            {"/materials", {{{"doubleSided", "yes"}}}, "material 0: doubleSided \"yes\", expected true or false"},
        });
}

TEST_CASE("a file of another version, or one that requires what is not supported, is refused") {
    checkRefusals(
        triangleFile(),
        {
            {"/asset/version", "1.0", "asset: version \"1.0\", expected 2.0"},
            {"/asset/version", "two", "asset: version \"two\", expected \"2.0\""},
            {"/asset/minVersion", "2.1", "asset: minVersion \"2.1\", expected at most 2.0"},
            {"/asset", Json::object(), "asset: version is missing"},
            {"/extensionsRequired", {"EXT_unheard_of"}, "extension \"EXT_unheard_of\" is required, but not supported"},
            {"/extensionsRequired", {"EXT_mesh_features"}, "extension \"EXT_mesh_features\" is required"},
        });
    GltfFile required = triangleFile();
    required.json["extensionsRequired"] = {"KHR_materials_volume", "KHR_mesh_quantization"};
    CHECK(refusalOf(required).empty());
}

TEST_CASE("accessors and buffer views must lie within what they view, with sound strides and alignment") {
    checkRefusals(
        triangleFile(),
        {
            {"/bufferViews/0/byteLength", 99, "buffer view 0: bytes 0 to 99, but buffer 0 has 42 bytes"},
            {"/bufferViews/0/byteOffset", 9007199254740992,
             "buffer view 0: byteOffset 9007199254740992, expected a whole number"},
            {"/bufferViews/0/byteOffset", 4294967296, "but buffer 0 has 42 bytes"},
            {"/bufferViews/0/byteStride", 6, "buffer view 0: byteStride 6, expected a multiple of 4"},
            {"/bufferViews/0/byteStride", 256, "buffer view 0: byteStride 256, expected a whole number in [4, 252]"},
            {"/bufferViews/0/byteStride", 40, "buffer view 0: byteStride 40, but it has 36 bytes"},
            {"/bufferViews/0/byteStride", 8,
             "accessor 0: byteStride 8 of its buffer view, but an element has 12 bytes"},
            {"/bufferViews/0/byteStride", 16, "accessor 0: 3 elements end at byte 44, but buffer view 0 has 36 bytes"},
            {"/accessors/0/count", 4, "accessor 0: 4 elements end at byte 48, but buffer view 0 has 36 bytes"},
            {"/accessors/0/count", 4294967296, "accessor 0: 4294967296 elements end at byte 51539607552"},
            {"/accessors/0/count", 1e18, "accessor 0: count 1e+18, expected a whole number"},
            {"/accessors/0/count", 0, "accessor 0: count 0, expected a whole number"},
            {"/accessors/0/byteOffset", 2, "accessor 0: 3 elements end at byte 38"},
            {"/accessors/1/byteOffset", -2, "accessor 1: byteOffset -2, expected a whole number"},
            {"/accessors/0/componentType", 5124, "accessor 0: componentType 5124, expected 5120"},
            {"/accessors/0/type", "VEC5", "accessor 0: type \"VEC5\", expected SCALAR"},
            {"/accessors/0/normalized", true, "accessor 0: normalized, expected only with 8 or 16 bits"},
            {"/accessors/1/componentType", 5125,
             "accessor 1: 3 elements end at byte 12, but buffer view 1 has 6 bytes"},
        });
    GltfFile unaligned = triangleFile();
    unaligned["/bufferViews/1/byteOffset"] = 35;
    CHECK(contains(refusalOf(unaligned), "accessor 1: starts at byte 35 of its buffer, expected a multiple of 2"));
    GltfFile bare = triangleFile();
    bare["/accessors/0"].erase("bufferView");
    bare["/accessors/0/count"] = 20'000'000;
    CHECK(contains(refusalOf(bare), "accessor 0: 20000000 elements without a buffer view, limit 16777216"));
}

TEST_CASE("sparse accessors must lie within their views, their indices within the accessor and in order") {
    checkRefusals(
        sparseFile({1}),
        {
            {"/accessors/0/sparse/count", 4, "accessor 0 sparse: count 4, expected a whole number in [1, 3]"},
            {"/accessors/0/sparse/count", 2,
             "accessor 0 sparse indices: 2 elements end at byte 4, but buffer view 2 has 2 bytes"},
            {"/accessors/0/sparse/indices/componentType", 5126, "accessor 0 sparse indices: componentType 5126"},
            {"/accessors/0/sparse/indices/bufferView", 9, "accessor 0 sparse indices: buffer view 9 does not exist"},
            {"/accessors/0/sparse/values/byteOffset", 4, "accessor 0 sparse values: 1 elements end at byte 16"},
            {"/accessors/0/sparse/values", Json::object(), "accessor 0 sparse values: bufferView is missing"},
        });
    CHECK(contains(refusalOf(sparseFile({3})), "accessor 0: sparse index 0 = 3, but 3 elements"));
    CHECK(contains(refusalOf(sparseFile({1, 1})), "accessor 0: sparse index 1 = 1, expected more than the one before"));
}

TEST_CASE("a primitive's accessors must be of the formats that the specification allows") {
    GltfFile file = triangleFile();
    const size_t bytes = file.accessor<uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    const size_t short2 = file.accessor<float>({0, 0, 1, 1}, "VEC2");
    checkRefusals(
        file,
        {
            {"/meshes/0/primitives/0/attributes/POSITION", bytes,
             "POSITION: accessor 2 is VEC4 of componentType 5121, expected VEC3 of float"},
            {"/meshes/0/primitives/0/attributes/COLOR_0", bytes,
             "COLOR_0: accessor 2 is VEC4 of componentType 5121, expected VEC3 or VEC4"},
            {"/meshes/0/primitives/0/attributes/TEXCOORD_0", bytes, "TEXCOORD_0: accessor 2 is VEC4"},
            {"/meshes/0/primitives/0/attributes/TEXCOORD_0", short2, "TEXCOORD_0 has 2 elements, but POSITION has 3"},
            {"/meshes/0/primitives/0/indices", 0, "indices: accessor 0 is VEC3 of componentType 5126, expected SCALAR"},
        });
    GltfFile strided = triangleFile();
    strided["/meshes/0/primitives/0/indices"] = strided.accessor<uint16_t>({0, 0, 1, 0, 2, 0}, "SCALAR");
    strided["/accessors/2/count"] = 3;
    strided["/bufferViews/2/byteStride"] = 4;
    CHECK(contains(refusalOf(strided), "indices: buffer view 2 has a byteStride, expected none for indices"));
    GltfFile shared = triangleFile();
    shared.add("accessors", shared["/accessors/0"]);
    shared["/meshes/0/primitives/0/attributes/NORMAL"] = 2;
    CHECK(contains(refusalOf(shared), "share buffer view 0, which has no byteStride"));
}

TEST_CASE("geometry whose data are not there is refused, never loaded as nothing") {
    GltfFile draco = triangleFile();
    draco.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    draco["/meshes/0/primitives/0/extensions"] = {{"KHR_draco_mesh_compression", {{"bufferView", 0}}}};
    CHECK(refusalOf(draco).empty());  // there uncompressed, too
    draco["/accessors/0"].erase("bufferView");
    CHECK(contains(refusalOf(draco), "mesh 0 primitive 0: attributes is missing"));

    GltfFile meshopt = triangleFile();
    meshopt.json["extensionsUsed"] = {"EXT_meshopt_compression"};
    Json json = Json::parse(meshopt.text());
    json["buffers"].push_back({{"byteLength", 4'000'000'000}});
    json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 36}});
    CHECK(refusalOf(json.dump()).empty());  // nothing reads it
    json["accessors"][0]["bufferView"] = 2;
    CHECK(contains(refusalOf(json.dump()), "accessor 0 is in a buffer without data, expected a uri or a BIN chunk"));
}

TEST_CASE("the hierarchy must be a forest") {
    const auto nodes = [](std::initializer_list<Json> list) {
        GltfFile file = triangleFile();
        file.json["nodes"] = list;
        file["/nodes/0/mesh"] = 0;
        return refusalOf(file);
    };
    CHECK(contains(nodes({{{"children", {0}}}}), "node 0 is its own ancestor"));
    CHECK(contains(nodes({Json::object(), {{"children", {2}}}, {{"children", {3}}}, {{"children", {1}}}}),
                   "node 1 is its own ancestor"));
    CHECK(contains(nodes({{{"children", {2}}}, {{"children", {2}}}, Json::object()}),
                   "node 2: has two parents, nodes 0 and 1"));
    CHECK(contains(nodes({{{"children", {1, 1}}}, Json::object()}), "node 1: has two parents, nodes 0 and 0"));
    GltfFile file = animated();
    file["/scenes/0/nodes"] = {0, 2};
    CHECK(contains(refusalOf(file), "scene 0: node 2 has parent node 1, expected a root"));
    file["/scenes/0/nodes"] = {0, 0};
    CHECK(contains(refusalOf(file), "scene 0: node 0 is listed twice"));
}

TEST_CASE("a chain of nodes may be long, but not beyond the limit") {
    GltfFile file = triangleFile();
    for (size_t i = 1; i <= 1000; ++i) {
        file.add("nodes", Json::object());
        file.json["nodes"][i - 1]["children"] = {i};
    }
    CHECK(refusalOf(file).empty());
    file.add("nodes", Json::object());
    file.json["nodes"][1000]["children"] = {1001};
    CHECK(contains(refusalOf(file), "node 1001 has 1001 nodes above it, limit 1000"));
}

TEST_CASE("transforms that are no transforms are refused") {
    const std::vector<double> projective = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    checkRefusals(animated(),
                  {
                      {"/nodes/0/rotation", {0, 0, 0, 0}, "node 0: rotation [0,0,0,0], expected a unit quaternion"},
                      {"/nodes/0/matrix", projective, "node 0: matrix with last row 1 0 0 1, expected 0 0 0 1"},
                      {"/nodes/1/scale", {1, 0, 1}, ""},
                  });
    GltfFile both = triangleFile();
    both["/nodes/0/matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    both["/nodes/0/scale"] = {1, 1, 1};
    CHECK(contains(refusalOf(both), "node 0: both matrix and scale"));
}

TEST_CASE("indices beyond the vertices and values that are not finite are named by their place") {
    GltfFile indices = triangleFile();
    indices["/meshes/0/primitives/0/indices"] = indices.accessor<uint8_t>({0, 1, 2, 2, 1, 9}, "SCALAR");
    CHECK(refusalOf(indices) == "mesh 0 primitive 0: index 5 = 9, but 3 vertices");
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        for (const char* name : {"POSITION", "NORMAL"}) {
            GltfFile file = triangleFile();
            file["/meshes/0/primitives/0/attributes"][name] =
                file.accessor<float>({0, 0, 1, 0, bad, 0, 1, 0, 0}, "VEC3");
            CHECK(contains(refusalOf(file), "accessor 2: element 1 is not finite"));
        }
    GltfFile far = triangleFile();
    far["/nodes/0/scale"] = {1e10, 1, 1};
    CHECK(contains(refusalOf(far), "mesh 0 primitive 0: a vertex at 1e+10 0 0 m, limit 1e+09 m"));
    far["/nodes/0/scale"] = {1e38, 1, 1};
    far.node({{"scale", {1e38, 1e38, 1e38}}, {"children", {0}}});
    far["/scenes/0/nodes"] = {1};
    far["/nodes/1/translation"] = {0, 1e38, 0};
    CHECK(contains(refusalOf(far), "m, limit 1e+09 m"));
}

TEST_CASE("a scene of which nothing is left is refused") {
    GltfFile empty;
    CHECK(contains(refusalOf(empty), "scene 0: no triangles to render"));
    empty.json.erase("scenes");
    empty.json.erase("scene");
    CHECK(contains(refusalOf(empty), "no scene to render"));
    GltfFile points = triangleFile();
    points["/meshes/0/primitives/0/mode"] = 0;
    CHECK(contains(refusalOf(points), "no triangles to render"));
    GltfFile flat = triangleFile();
    flat["/nodes/0/scale"] = {0, 0, 0};
    CHECK(contains(refusalOf(flat), "no triangles to render"));
}

TEST_CASE("many nodes that show one mesh may not make more primitives or triangles than the limits") {
    GltfFile file = triangleFile();
    file["/meshes/0/primitives"] = std::vector<Json>(2000, file["/meshes/0/primitives/0"]);
    for (int i = 0; i < 600; ++i) file.node({{"mesh", 0}});
    CHECK(contains(refusalOf(file), "the scene's nodes show more than 1000000 primitives"));
    GltfFile large = triangleFile();
    large["/meshes/0/primitives/0/indices"] = large.accessor(std::vector<uint8_t>(3'000'000, 0), "SCALAR");
    for (int i = 0; i < 120; ++i) large.node({{"mesh", 0}});
    CHECK(contains(refusalOf(large), "the scene's nodes show more than 100000000 triangles"));
}

TEST_CASE("a line that refuses stays one short line, whatever the names in the file") {
    GltfFile file = triangleFileWith(
        {{"name", "two\nlines\x1b[31m" + std::string(5000, 'x')}, {"pbrMetallicRoughness", {{"metallicFactor", 2}}}});
    const std::string said = refusalOf(file);
    CHECK(said.find('\n') == std::string::npos);
    CHECK(said.find('\x1b') == std::string::npos);
    CHECK(said.size() < 300);
    CHECK(contains(said, "two\\nlines"));
}

TEST_CASE("warnings that came before a refusal are not lost") {
    GltfFile file = triangleFile();
    file.json["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
    file["/nodes/0/mesh"] = 3;
    std::vector<std::string> warnings;
    GltfOptions options;
    options.onWarning = [&](const std::string& line) { warnings.push_back(line); };
    CHECK_THROWS_AS(load(file, options), Error);
    REQUIRE(warnings.size() == 1);
    CHECK(contains(warnings[0], "scene.gltf: extension \"KHR_materials_pbrSpecularGlossiness\" is ignored"));
    file["/nodes/0/mesh"] = 0;
    CHECK(warnsOnce(load(file, options), "extension \"KHR_materials_pbrSpecularGlossiness\" is ignored"));
    CHECK(warnings.size() == 1);
}
