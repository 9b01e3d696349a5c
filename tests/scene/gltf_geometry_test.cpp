// Vertices, triangles and the hierarchy that places them.
#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "scene/gltf_file.h"
#include "support/near.h"

using namespace lsde;
using namespace lsde::test;

namespace {

Vec3 faceNormal(const Mesh& m, size_t triangle) {
    const Triangle& t = m.triangles[triangle];
    return glm::normalize(glm::cross(m.positions[t[1]] - m.positions[t[0]], m.positions[t[2]] - m.positions[t[0]]));
}

// The corners of a mesh's triangles, in order.
std::vector<Vec3> corners(const Mesh& m) {
    std::vector<Vec3> out;
    for (const Triangle& t : m.triangles)
        for (const uint32_t v : t) out.push_back(m.positions[v]);
    return out;
}

// The triangle with normals (0, 0, 1).
GltfFile withNormals(const std::vector<float>& normals = {0, 0, 1, 0, 0, 1, 0, 0, 1}) {
    GltfFile file = triangleFile();
    file["/meshes/0/primitives/0/attributes/NORMAL"] = file.accessor(normals, "VEC3");
    return file;
}

// A unit cube, fronts outside, its faces in the given order of a list of 6 of 2 triangles.
const std::vector<float> kCubeCorners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
const std::vector<uint16_t> kCubeTriangles = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                              2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
const Json kGlass = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                     {"extensions",
                      {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                       {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}};

// The cube in glass, cut into primitives of these numbers of triangles.
GltfFile glassCube(const std::vector<size_t>& parts) {
    GltfFile file;
    file.add("materials", kGlass);
    const size_t positions = file.accessor(kCubeCorners, "VEC3");
    Json primitives = Json::array();
    size_t first = 0;
    for (const size_t part : parts) {
        const auto begin = kCubeTriangles.begin() + static_cast<std::ptrdiff_t>(3 * first);
        const size_t indices =
            file.accessor(std::vector<uint16_t>(begin, begin + static_cast<std::ptrdiff_t>(3 * part)), "SCALAR");
        primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}});
        first += part;
    }
    file.add("meshes", {{"primitives", primitives}});
    file.node({{"mesh", 0}, {"name", "cube"}});
    return file;
}

}  // namespace

TEST_CASE("indices of 8, 16 and 32 bits, and none at all, give the same triangle") {
    const std::vector<Vec3> expected = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    GltfFile file = triangleFile();
    CHECK(corners(load(file).meshes[0]) == expected);
    file["/meshes/0/primitives/0/indices"] = file.accessor<uint8_t>({0, 1, 2}, "SCALAR");
    CHECK(corners(load(file).meshes[0]) == expected);
    file["/meshes/0/primitives/0/indices"] = file.accessor<uint32_t>({0, 1, 2}, "SCALAR");
    CHECK(corners(load(file).meshes[0]) == expected);
    file["/meshes/0/primitives/0"].erase("indices");
    CHECK(corners(load(file).meshes[0]) == expected);
}

TEST_CASE("strips and fans face as their first triangle does") {
    GltfFile file;
    const size_t square = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
    const size_t fan = file.accessor<uint16_t>({0, 1, 3, 2}, "SCALAR");
    // The repeated corners join two strips and are no degenerate triangles.
    const size_t joined = file.accessor<uint16_t>({0, 1, 2, 3, 3, 1, 1, 3, 2}, "SCALAR");
    file.add("meshes", {{"primitives",
                         {{{"mode", 5}, {"attributes", {{"POSITION", square}}}},
                          {{"mode", 6}, {"attributes", {{"POSITION", square}}}, {"indices", fan}},
                          {{"mode", 5}, {"attributes", {{"POSITION", square}}}, {"indices", joined}}}}});
    file.node({{"mesh", 0}});
    const SceneDescription scene = load(file);
    CHECK(scene.warnings.empty());
    REQUIRE(scene.meshes.size() == 3);
    CHECK(scene.meshes[0].triangles.size() == 2);
    CHECK(scene.meshes[1].triangles.size() == 2);
    CHECK(scene.meshes[2].triangles.size() == 3);
    for (const Mesh& m : scene.meshes)
        for (size_t t = 0; t < 2; ++t) checkNear(faceNormal(m, t), {0, 0, 1});
}

TEST_CASE("points, lines, primitives without positions and corners left over are left out with a warning") {
    GltfFile file = triangleFile();
    const Json primitive = file["/meshes/0/primitives/0"];
    for (const int mode : {0, 1, 2, 3}) {
        Json other = primitive;
        other["mode"] = mode;
        file["/meshes/0/primitives"].push_back(other);
    }
    file["/meshes/0/primitives"].push_back({{"attributes", Json::object()}});
    Json more = primitive;
    more["indices"] = file.accessor<uint16_t>({0, 1, 2, 0}, "SCALAR");
    file["/meshes/0/primitives"].push_back(more);
    const SceneDescription scene = load(file);
    CHECK(scene.meshes.size() == 2);
    CHECK(warnsOnce(scene, "mesh 0 primitive 1: points and lines left out (4 in all)"));
    CHECK(warnsOnce(scene, "mesh 0 primitive 5: primitive without POSITION left out"));
    CHECK(warnsOnce(scene, "mesh 0 primitive 6: corners that complete no triangle left out"));
}

TEST_CASE("interleaved vertices are read by their stride") {
    GltfFile file;
    const size_t view =
        file.view(std::vector<float>{0, 0, 0, 0, 0, 1, 0.5F, 1, 1, 0, 0, 0, 0, 1, 0.25F, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    file["/bufferViews/0/byteStride"] = 32;
    const auto accessor = [&](const char* type, int offset) {
        return file.add(
            "accessors",
            {{"bufferView", view}, {"byteOffset", offset}, {"componentType", 5126}, {"count", 3}, {"type", type}});
    };
    const size_t p = accessor("VEC3", 0), n = accessor("VEC3", 12), uv = accessor("VEC2", 24);
    file.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", uv}}}}}}});
    file.node({{"mesh", 0}});
    const Mesh m = load(file).meshes.at(0);
    CHECK(m.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(m.normals == std::vector<Vec3>(3, Vec3(0, 0, 1)));
    CHECK(m.texCoords[0] == std::vector<Vec2>{{0.5F, 1}, {0.25F, 0}, {0, 0}});
    CHECK(m.texCoords[1].empty());
}

TEST_CASE("a sparse accessor replaces elements of its view, or of zeros") {
    GltfFile file = triangleFile();
    const size_t where = file.view(std::vector<uint8_t>{1, 2});
    const size_t values = file.view(std::vector<float>{5, 0, 0, 0, 7, 0});
    file["/accessors/0/sparse"] = {{"count", 2},
                                   {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                   {"values", {{"bufferView", values}}}};
    CHECK(load(file).meshes.at(0).positions == std::vector<Vec3>{{0, 0, 0}, {5, 0, 0}, {0, 7, 0}});
    file["/accessors/0"].erase("bufferView");
    CHECK(load(file).meshes.at(0).positions == std::vector<Vec3>{{0, 0, 0}, {5, 0, 0}, {0, 7, 0}});
}

TEST_CASE("quantised vertices are floats by the rules of normalised integers") {
    GltfFile file;
    file.json["extensionsRequired"] = file.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    const size_t p = file.accessor<int16_t>({0, 0, 0, 1000, 0, 0, 0, -2000, 0}, "VEC3");
    const size_t n = file.accessor<int8_t>({0, 0, 127, 0, 0, 127, 0, 0, -128}, "VEC3", true);
    const size_t uv = file.accessor<uint16_t>({0, 65535, 0, 0, 13107, 0}, "VEC2", true);
    const size_t color = file.accessor<uint8_t>({255, 51, 0, 255, 255, 255, 0, 0, 0}, "VEC3", true);
    file.add(
        "meshes",
        {{"primitives", {{{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", uv}, {"COLOR_0", color}}}}}}});
    file.node({{"mesh", 0}, {"scale", {0.001, 0.001, 0.001}}});
    const Mesh m = load(file).meshes.at(0);
    checkNear(m.positions[2], {0, -2, 0});
    CHECK(m.normals == std::vector<Vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, -1}});
    CHECK(m.texCoords[0][0] == Vec2(0, 1));
    CHECK(m.texCoords[0][2].x == doctest::Approx(0.2));
    CHECK(m.colors[0].y == doctest::Approx(0.2));
    CHECK(m.colors[0].w == 1);
    file.json.erase("extensionsUsed");
    file.json.erase("extensionsRequired");
    CHECK(contains(refusalOf(file),
                   "NORMAL: accessor 1 is VEC3 of componentType 5120 normalized, expected VEC3 of float"));
}

TEST_CASE("a mirroring node flips the winding, and normals stay on the front") {
    GltfFile file = withNormals();
    file["/nodes/0/scale"] = {-2, 1, 1};
    const Mesh mirrored = load(file).meshes.at(0);
    checkNear(faceNormal(mirrored, 0), {0, 0, 1});
    checkNear(mirrored.normals[0], {0, 0, 1});
    file["/nodes/0/scale"] = {1, 1, -1};
    const Mesh turned = load(file).meshes.at(0);
    checkNear(faceNormal(turned, 0), {0, 0, -1});
    checkNear(turned.normals[0], {0, 0, -1});
}

TEST_CASE("nested rotation, mirroring and uneven scale place points by the product, normals by the inverse transpose") {
    // Parent: turned by 90 degrees about z and scaled unevenly. Child: turned by 45 degrees about x, mirrored, moved.
    const double angle = std::numbers::pi / 4, c = std::cos(angle), s = std::sin(angle);
    GltfFile file = withNormals({0.6F, 0, 0.8F, 0, 0, 1, 0, 0, 1});
    file["/nodes/0"] = {{"mesh", 0},
                        {"rotation", {std::sin(angle / 2), 0, 0, std::cos(angle / 2)}},
                        {"scale", {1, 1, -3}},
                        {"translation", {1, 2, 3}}};
    file.add("nodes", {{"children", {0}}, {"rotation", {0, 0, kRootHalf, kRootHalf}}, {"scale", {2, 0.5, 1}}});
    file["/scenes/0/nodes"] = {1};
    const Mesh m = load(file).meshes.at(0);
    const auto place = [&](glm::dvec3 p) {
        p.z *= -3;
        p = glm::dvec3(p.x, c * p.y - s * p.z, s * p.y + c * p.z) + glm::dvec3(1, 2, 3);
        p *= glm::dvec3(2, 0.5, 1);
        return Vec3(-p.y, p.x, p.z);
    };
    std::vector<Vec3> expected = {place({0, 0, 0}), place({0, 1, 0}),
                                  place({1, 0, 0})};  // one mirroring: wound the other way
    const std::vector<Vec3> there = corners(m);
    for (size_t i = 0; i < 3; ++i) checkNear(there[i], expected[i]);
    // A normal is at right angles with whatever it was at right angles with before.
    const Vec3 origin = place({0, 0, 0}), along = place({0.8, 0, -0.6}) - origin, across = place({0, 1, 0}) - origin;
    CHECK(glm::length(m.normals[0]) == doctest::Approx(1));
    CHECK(std::fabs(glm::dot(m.normals[0], glm::normalize(along))) < 1e-6F);
    CHECK(std::fabs(glm::dot(m.normals[0], glm::normalize(across))) < 1e-6F);
    CHECK(glm::dot(m.normals[0], faceNormal(m, 0)) > 0);
}

TEST_CASE("a matrix places as the same translation, rotation and scale do") {
    GltfFile parts = withNormals(), matrix = withNormals();
    parts["/nodes/0"] = {
        {"mesh", 0}, {"rotation", {0, 0, kRootHalf, kRootHalf}}, {"scale", {2, 3, 4}}, {"translation", {5, 6, 7}}};
    matrix["/nodes/0/matrix"] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1};
    const Mesh a = load(parts).meshes.at(0), b = load(matrix).meshes.at(0);
    for (size_t i = 0; i < 3; ++i) checkNear(a.positions[i], b.positions[i]);
    checkNear(a.positions[1], {5, 8, 7});
}

TEST_CASE("a quaternion that is not of unit length is normalised with one warning") {
    GltfFile file = triangleFile();
    file["/nodes/0/rotation"] = {0, 0, 2, 2};
    file.node({{"mesh", 0}, {"rotation", {0, 0, 3, 3}}});
    const SceneDescription scene = load(file);
    checkNear(scene.meshes[0].positions[1], {0, 1, 0});
    CHECK(warnsOnce(scene, "node 0: rotation is not a unit quaternion: normalised (2 in all)"));
    // Rounded to 16 bits it still is one.
    file["/nodes/0/rotation"] = file["/nodes/1/rotation"] = {0, 0, 0.70711, 0.70712};
    CHECK(load(file).warnings.empty());
}

TEST_CASE("a node's flat scale keeps its triangles, with a warning") {
    GltfFile file = withNormals();
    file["/nodes/0/scale"] = {1, 1, 0};
    const SceneDescription scene = load(file);
    checkNear(scene.meshes.at(0).normals[0], {0, 0, 1});
    CHECK(warnsOnce(scene, "node 0: its matrix is singular"));
}

TEST_CASE("degenerate triangles are left out, counted, and leave no stray vertices") {
    GltfFile file;
    const size_t p = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 50, 50, 50, 2, 0, 0}, "VEC3");
    const size_t i = file.accessor<uint16_t>({0, 0, 3, 0, 1, 2, 0, 1, 4}, "SCALAR");
    file.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", i}}}}});
    file.node({{"mesh", 0}});
    const SceneDescription scene = load(file);
    CHECK(corners(scene.meshes.at(0)) == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(scene.meshes[0].positions.size() == 3);
    CHECK(warnsOnce(scene, "mesh 0 primitive 0: degenerate triangles left out (2 in all)"));
    // Small is not degenerate: a triangle of a micrometre.
    GltfFile small = triangleFile();
    small["/nodes/0/scale"] = {1e-6, 1e-6, 1e-6};
    CHECK(load(small).warnings.empty());
}

TEST_CASE("vertices that no triangle uses do not enlarge a mesh") {
    GltfFile file = triangleFile();
    file["/meshes/0/primitives/0/attributes/POSITION"] =
        file.accessor<float>({9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    file["/meshes/0/primitives/0/indices"] = file.accessor<uint16_t>({1, 2, 3}, "SCALAR");
    const Mesh m = load(file).meshes.at(0);
    CHECK(m.positions.size() == 3);
    CHECK(m.bounds().hi == Vec3(1, 1, 0));
}

TEST_CASE("normals that are zero make their triangles flat, others stay; those of other lengths are normalised") {
    GltfFile file;
    const size_t p = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0}, "VEC3");
    const size_t n =
        file.accessor<float>({0, 0, 0, 0, 0.6F, 0.8F, 0, 0.6F, 0.8F, 0, 1.2F, 1.6F, 0, 0.6F, 0.8F}, "VEC3");
    const size_t i = file.accessor<uint16_t>({0, 1, 2, 1, 3, 2, 1, 4, 3}, "SCALAR");
    file.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", p}, {"NORMAL", n}}}, {"indices", i}}}}});
    file.node({{"mesh", 0}});
    const SceneDescription scene = load(file);
    const Mesh& m = scene.meshes.at(0);
    REQUIRE(m.triangles.size() == 3);
    for (const uint32_t v : m.triangles[0]) checkNear(m.normals[v], {0, 0, 1});
    for (const uint32_t v : m.triangles[1]) checkNear(m.normals[v], {0, 0.6F, 0.8F});
    CHECK(warnsOnce(scene, "mesh 0 primitive 0: normals are zero: triangles rendered flat"));
    CHECK(warnsOnce(scene, "mesh 0 primitive 0: normals are not of unit length: normalised"));
}

TEST_CASE("a solid is closed across its primitives, and an open one is told with its count of open edges") {
    CHECK(load(glassCube({12})).warnings.empty());
    const SceneDescription closed = load(glassCube({5, 7}));
    CHECK(closed.warnings.empty());
    CHECK(closed.meshes[0].openEdges == 0);
    CHECK(closed.meshes[1].openEdges == 0);
    const SceneDescription open = load(glassCube({10}));
    CHECK(open.meshes.at(0).openEdges == 4);
    CHECK(warnsOnce(
        open,
        "\"cube\": open mesh of a solid, so that inside and outside are told by facing alone: open edges (4 in all)"));
    GltfFile opaque = glassCube({10});
    opaque["/materials/0"] = Json::object();
    CHECK(load(opaque).warnings.empty());
}

TEST_CASE("split vertices are joined by position before open edges are counted") {
    GltfFile file = glassCube({12});
    std::vector<float> split;
    for (const uint16_t v : kCubeTriangles)
        split.insert(split.end(), {kCubeCorners[3 * v], kCubeCorners[3 * v + 1], -kCubeCorners[3 * v + 2]});
    file["/meshes/0/primitives/0/attributes/POSITION"] = file.accessor(split, "VEC3");
    file["/meshes/0/primitives/0"].erase("indices");
    CHECK(load(file).meshes.at(0).openEdges == 0);
}

TEST_CASE(
    "meshes are named by node, else mesh, else number; switches and priority come from the node, else the material") {
    GltfFile file = triangleFileWith({{"extras", {{"priority", 3}}}});
    file.node(
        {{"mesh", 0},
         {"name", "left"},
         {"extras",
          {{"priority", -2}, {"lsde", {{"castsCaustics", false}, {"receivesCaustics", false}, {"aim", false}}}}}});
    file.add("meshes", file["/meshes/0"]);
    file["/meshes/1/name"] = "tile";
    file["/meshes/1/primitives/0"].erase("material");
    file.node({{"mesh", 1}, {"extras", {{"lsde", {{"castCaustics", false}}}}}});
    file["/nodes/0/extras"] = "of any type";
    const SceneDescription scene = load(file);
    REQUIRE(scene.meshes.size() == 3);
    CHECK(scene.meshes[0].object == "node 0");
    CHECK(scene.meshes[0].priority == 3);
    CHECK(scene.meshes[0].hasPriority);
    CHECK(scene.meshes[0].switches == CausticSwitches{});
    CHECK(scene.meshes[1].object == "left");
    CHECK(scene.meshes[1].priority == -2);
    CHECK(scene.meshes[1].switches == CausticSwitches{false, false, false});
    CHECK(scene.meshes[1].node == 1);
    CHECK(scene.meshes[2].object == "tile");
    CHECK(!scene.meshes[2].hasPriority);
    CHECK(warnsOnce(scene, "node 2 extras lsde: \"castCaustics\" is unknown and ignored"));
}

TEST_CASE("one of several scenes is chosen by name or number, else the default, else the first") {
    GltfFile file = triangleFile();
    for (int i = 0; i < 2; ++i) file.add("nodes", {{"mesh", 0}, {"name", "n" + std::to_string(i + 1)}});
    file.add("scenes", {{"name", "second"}, {"nodes", {1}}});
    file.add("scenes", {{"name", "0"}, {"nodes", {2}}});
    file["/nodes/0/name"] = "n0";
    const auto shown = [&](const std::string& scene) { return load(file, optionsOf(scene)).meshes.at(0).object; };
    CHECK(shown("") == "n0");
    CHECK(shown("second") == "n1");
    CHECK(shown("1") == "n1");
    CHECK(shown("0") == "n2");  // a name comes before a number
    file.json["scene"] = 2;
    CHECK(shown("") == "n2");
    file.json.erase("scene");
    CHECK(shown("") == "n0");
    CHECK(load(file, optionsOf("second")).sceneName == "second");
    CHECK(contains(errorOf([&] { shown("third"); }),
                   "scene \"third\": does not exist, expected one of: 0, 1 \"second\", 2 \"0\""));
    CHECK(contains(errorOf([&] { shown("3"); }), "scene \"3\": does not exist"));
}

TEST_CASE("nodes that share a mesh show it in their own places") {
    GltfFile file = triangleFile();
    file.node({{"mesh", 0}, {"translation", {0, 0, 5}}});
    const SceneDescription scene = load(file);
    REQUIRE(scene.meshes.size() == 2);
    checkNear(scene.meshes[0].positions[0], {0, 0, 0});
    checkNear(scene.meshes[1].positions[0], {0, 0, 5});
}

TEST_CASE("a node with instances shows its mesh once for each, as nodes of these transforms would") {
    GltfFile file = triangleFile();
    const size_t translation = file.accessor<float>({5, 0, 0, 0, 7, 0}, "VEC3");
    const size_t rotation = file.accessor<int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}, "VEC4", true);
    const size_t scale = file.accessor<float>({1, 1, 1, 2, 2, -2}, "VEC3");
    file["/nodes/0/scale"] = {10, 10, 10};
    file["/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes"] = {
        {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}, {"_ID", scale}};
    file.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const SceneDescription scene = load(file);
    REQUIRE(scene.meshes.size() == 2);
    const auto near = [](Vec3 a, Vec3 b) { return glm::length(a - b) < 1e-3F; };
    CHECK(near(scene.meshes[0].positions[1], {60, 0, 0}));
    // Turned by 90 degrees about z, doubled, mirrored: the winding is undone.
    CHECK(near(scene.meshes[1].positions[0], {0, 70, 0}));
    CHECK(near(scene.meshes[1].positions[1], {0, 90, 0}));
    CHECK(scene.meshes[1].triangles[0] == Triangle{0, 2, 1});
    CHECK(scene.meshes[0].object == scene.meshes[1].object);
    CHECK(scene.meshes[0].node != scene.meshes[1].node);

    GltfFile unequal = file, wrong = file, none = file;
    unequal["/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE"] = 0;
    CHECK(contains(refusalOf(unequal), "\"SCALE\" has 3 elements, others have 2"));
    wrong["/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE"] = rotation;
    CHECK(contains(refusalOf(wrong), "SCALE: accessor 3 is VEC4 of componentType 5122, expected VEC3 of float"));
    none["/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes"] = Json::object();
    CHECK(load(none).meshes.size() == 1);
    GltfFile many = file;
    const size_t zeros = many.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 16'000'000}});
    many["/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes"] = {{"TRANSLATION", zeros}};
    CHECK(contains(refusalOf(many), "more than 1000000 primitives"));
}

TEST_CASE("numbers written with a fraction of zero are whole numbers") {
    GltfFile file = triangleFile();
    for (const char* pointer :
         {"/scene", "/nodes/0/mesh", "/accessors/0/count", "/accessors/0/componentType", "/bufferViews/1/byteOffset",
          "/meshes/0/primitives/0/indices", "/meshes/0/primitives/0/attributes/POSITION", "/scenes/0/nodes/0"})
        file[pointer] = file[pointer].get<double>();
    CHECK(load(file).meshes.size() == 1);
}
