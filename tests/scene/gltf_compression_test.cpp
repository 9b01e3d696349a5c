// Compressed meshes, made by the encoders of meshoptimizer and Draco: they load as what was encoded, or not at all.
#include <doctest/doctest.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include "base/error.h"
#include "scene/gltf_file.h"
#include "support/random.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

const Mesh& ball() {
    static const Mesh kBall = sphere({0, 0, 0}, 1, 3);
    return kBall;
}

std::vector<uint32_t> indicesOf(const Mesh& m) {
    std::vector<uint32_t> out;
    for (const Triangle& t : m.triangles) out.insert(out.end(), t.begin(), t.end());
    return out;
}

// The positions of a mesh's corners: the same however its vertices are numbered, turned so that the least comes first.
std::vector<std::array<Vec3, 3>> facesOf(const Mesh& m) {
    const auto before = [](Vec3 a, Vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    std::vector<std::array<Vec3, 3>> out;
    for (const Triangle& t : m.triangles) {
        std::array<Vec3, 3> face = {m.positions[t[0]], m.positions[t[1]], m.positions[t[2]]};
        std::rotate(face.begin(), std::min_element(face.begin(), face.end(), before), face.end());
        out.push_back(face);
    }
    std::sort(out.begin(), out.end(), [&](const auto& a, const auto& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), before);
    });
    return out;
}

std::string asString(const std::vector<unsigned char>& bytes) { return {bytes.begin(), bytes.end()}; }

template <typename T>
std::string encodedVertices(const std::vector<T>& vertices) {
    std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(T)));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), vertices.data(), vertices.size(), sizeof(T)));
    return asString(out);
}
std::string encodedTriangles(const std::vector<uint32_t>& indices, size_t vertices) {
    std::vector<unsigned char> out(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
    return asString(out);
}
std::string encodedSequence(const std::vector<uint32_t>& indices, size_t vertices) {
    std::vector<unsigned char> out(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
    return asString(out);
}

// A mesh shown by one node whose buffer views are all compressed: their fallback is a buffer without data.
struct MeshoptFile : GltfFile {
    size_t fallback = 0;
    Json primitive = {{"attributes", Json::object()}};

    MeshoptFile() { json["extensionsRequired"] = json["extensionsUsed"] = {"EXT_meshopt_compression"}; }
    // An accessor of `count` elements of `stride` bytes each.
    size_t compressed(const std::string& encoded, size_t count, size_t stride, const char* mode, Json accessor,
                      const char* filter = "NONE") {
        const size_t source = view(encoded);
        const Json at = json["bufferViews"][source];
        Json v = {{"buffer", 1},
                  {"byteOffset", fallback},
                  {"byteLength", count * stride},
                  {"extensions",
                   {{"EXT_meshopt_compression",
                     {{"buffer", 0},
                      {"byteOffset", at["byteOffset"]},
                      {"byteLength", at["byteLength"]},
                      {"byteStride", stride},
                      {"count", count},
                      {"mode", mode},
                      {"filter", filter}}}}}};
        if (std::string(mode) == "ATTRIBUTES") v["byteStride"] = stride;
        fallback += (count * stride + 3) / 4 * 4;
        accessor["bufferView"] = add("bufferViews", v);
        accessor["count"] = count;
        return add("accessors", accessor);
    }
    std::string finished() {
        add("meshes", {{"primitives", {primitive}}});
        node({{"mesh", 0}});
        Json out = Json::parse(text());
        out["buffers"].push_back(
            {{"byteLength", fallback}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
        return out.dump();
    }
};

MeshoptFile meshoptBall() {
    MeshoptFile file;
    const std::vector<uint32_t> indices = indicesOf(ball());
    const size_t n = ball().positions.size();
    file.primitive["attributes"]["POSITION"] = file.compressed(encodedVertices(ball().positions), n, 12, "ATTRIBUTES",
                                                               {{"componentType", 5126}, {"type", "VEC3"}});
    file.primitive["indices"] = file.compressed(encodedTriangles(indices, n), indices.size(), 2, "TRIANGLES",
                                                {{"componentType", 5123}, {"type", "SCALAR"}});
    return file;
}

// The ball as Draco data, and a file whose mesh is there in no other form.
struct DracoFile : GltfFile {
    DracoFile(bool edgebreaker, bool quantized) {
        draco::TriangleSoupMeshBuilder builder;
        const auto faces = static_cast<int>(ball().triangles.size());
        builder.Start(faces);
        const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
        const int normals = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
        for (int f = 0; f < faces; ++f) {
            const Triangle& t = ball().triangles[static_cast<size_t>(f)];
            const draco::FaceIndex face(static_cast<uint32_t>(f));
            builder.SetAttributeValuesForFace(positions, face, &ball().positions[t[0]], &ball().positions[t[1]],
                                              &ball().positions[t[2]]);
            builder.SetAttributeValuesForFace(normals, face, &ball().normals[t[0]], &ball().normals[t[1]],
                                              &ball().normals[t[2]]);
        }
        const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
        draco::Encoder encoder;
        encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING);
        if (quantized) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
        if (quantized) encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
        draco::EncoderBuffer encoded;
        REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &encoded).ok());
        const size_t data = view(std::string(encoded.data(), encoded.size()));
        json["extensionsRequired"] = json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
        const Json vertices = {{"componentType", 5126}, {"type", "VEC3"}, {"count", mesh->num_points()}};
        add("accessors", vertices);
        add("accessors", vertices);
        add("accessors", {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 3 * mesh->num_faces()}});
        const Json ids = {{"POSITION", mesh->attribute(positions)->unique_id()},
                          {"NORMAL", mesh->attribute(normals)->unique_id()}};
        add("meshes",
            {{"primitives",
              {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}},
                {"indices", 2},
                {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", data}, {"attributes", ids}}}}}}}}});
        node({{"mesh", 0}});
    }
    Json& draco() { return (*this)["/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression"]; }
};

// Loads `count` copies with some bytes from `first` on changed; how many load.
int loadedOfMutations(const std::string& sound, size_t first, const char* name, int count, uint32_t seed) {
    Random random(seed);
    const auto below = [&](size_t n) { return static_cast<size_t>(random.uniform() * static_cast<float>(n)); };
    const TemporaryFolder folder;
    int loaded = 0;
    for (int i = 0; i < count; ++i) {
        CAPTURE(i);
        std::string bytes = sound;
        for (size_t k = 1 + below(6); k > 0; --k)
            bytes[first + below(bytes.size() - first)] = static_cast<char>(below(256));
        put(folder / name, bytes);
        const std::string said = errorOf([&] { loadGltf(folder / name); });
        CHECK(said.find('\n') == std::string::npos);
        loaded += said.empty() ? 1 : 0;
    }
    return loaded;
}

}  // namespace

TEST_CASE("buffer views compressed by meshoptimizer load as what was encoded, as triangles or in sequence") {
    MeshoptFile file = meshoptBall();
    const SceneDescription scene = loadText(file.finished());
    REQUIRE(scene.meshes.size() == 1);
    CHECK(facesOf(scene.meshes[0]) == facesOf(ball()));
    CHECK(scene.warnings.empty());

    MeshoptFile sequence = meshoptBall();
    const std::vector<uint32_t> indices = indicesOf(ball());
    sequence.primitive["indices"] =
        sequence.compressed(encodedSequence(indices, ball().positions.size()), indices.size(), 4, "INDICES",
                            {{"componentType", 5125}, {"type", "SCALAR"}});
    CHECK(loadText(sequence.finished()).meshes.at(0).triangles.size() == ball().triangles.size());
    CHECK(facesOf(loadText(sequence.finished()).meshes.at(0)) == facesOf(ball()));
}

TEST_CASE("filters of compressed buffer views are undone: octahedral normals, exponential positions") {
    MeshoptFile file = meshoptBall();
    const size_t n = ball().positions.size();
    std::vector<float> four;
    for (const Vec3 v : ball().normals) four.insert(four.end(), {v.x, v.y, v.z, 0});
    std::vector<std::array<int16_t, 4>> normals(n);
    meshopt_encodeFilterOct(normals.data(), n, sizeof normals[0], 14, four.data());
    file.primitive["attributes"]["NORMAL"] =
        file.compressed(encodedVertices(normals), n, 8, "ATTRIBUTES",
                        {{"componentType", 5122}, {"type", "VEC3"}, {"normalized", true}}, "OCTAHEDRAL");
    std::vector<std::array<int32_t, 3>> positions(n);
    meshopt_encodeFilterExp(positions.data(), n, sizeof positions[0], 20, &ball().positions[0].x);
    file.primitive["attributes"]["POSITION"] = file.compressed(
        encodedVertices(positions), n, 12, "ATTRIBUTES", {{"componentType", 5126}, {"type", "VEC3"}}, "EXPONENTIAL");
    file.json["extensionsUsed"].push_back("KHR_mesh_quantization");
    const Mesh mesh = loadText(file.finished()).meshes.at(0);
    REQUIRE(mesh.positions.size() == n);
    for (size_t i = 0; i < n; ++i) {
        // On the unit sphere the normal is the position.
        CHECK(glm::length(mesh.positions[i] - mesh.normals[i]) < 3e-4F);
        CHECK(std::fabs(glm::length(mesh.positions[i]) - 1) < 1e-5F);
    }
}

TEST_CASE("compressed views that contradict themselves or their buffer are refused by what is wrong") {
    const auto refusal = [](const char* key, const Json& value) {
        MeshoptFile file = meshoptBall();
        Json json = Json::parse(file.finished());
        json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"][key] = value;
        return refusalOf(json.dump());
    };
    CHECK(contains(refusal("mode", "POINTS"), "buffer view 1: EXT_meshopt_compression: mode \"POINTS\" is unknown"));
    CHECK(contains(refusal("filter", "BLUR"), "filter \"BLUR\" is unknown"));
    CHECK(contains(refusal("filter", "QUATERNION"), "byteStride 12 with filter QUATERNION, expected 8"));
    CHECK(contains(refusal("filter", "OCTAHEDRAL"), "byteStride 12 with filter OCTAHEDRAL, expected 4 or 8"));
    CHECK(contains(refusal("byteStride", 13), "byteStride 13 with mode ATTRIBUTES, expected a multiple of 4"));
    CHECK(contains(refusal("byteStride", 16), "elements of 16 bytes, but byteLength"));
    CHECK(contains(refusal("count", 1), "1 elements of 12 bytes, but byteLength"));
    CHECK(contains(refusal("mode", "TRIANGLES"), "byteStride 12 with mode TRIANGLES, expected 2 or 4"));
    CHECK(contains(refusal("byteLength", 1'000'000), "EXT_meshopt_compression: bytes 0 to 1000000, but buffer 0 has"));
    CHECK(contains(refusal("byteLength", 3), "EXT_meshopt_compression: 3 bytes cannot hold"));
    CHECK(contains(refusal("byteLength", 100), "EXT_meshopt_compression: its compressed data are damaged"));
    CHECK(contains(refusal("buffer", 2), "buffer 2 does not exist"));
    CHECK(contains(refusal("buffer", 1), "is in a buffer without data"));
}

TEST_CASE("Draco meshes load as what was encoded, by either method, exactly or within their quantisation") {
    for (const bool edgebreaker : {false, true})
        for (const bool quantized : {false, true}) {
            CAPTURE(edgebreaker);
            CAPTURE(quantized);
            const SceneDescription scene = load(DracoFile(edgebreaker, quantized));
            REQUIRE(scene.meshes.size() == 1);
            const Mesh& mesh = scene.meshes[0];
            REQUIRE(mesh.triangles.size() == ball().triangles.size());
            if (!quantized) CHECK(facesOf(mesh) == facesOf(ball()));
            REQUIRE(mesh.normals.size() == mesh.positions.size());
            for (size_t i = 0; i < mesh.positions.size(); ++i)
                CHECK(glm::length(mesh.positions[i] - mesh.normals[i]) < (quantized ? 5e-3F : 1e-6F));
        }
}

TEST_CASE("Draco meshes that contradict their accessors or their data are refused by what is wrong") {
    const auto refusal = [](const std::string& pointer, const Json& value) {
        DracoFile file(true, true);
        file[pointer] = value;
        return refusalOf(file);
    };
    const std::string draco = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    const std::string here = "mesh 0 primitive 0";
    CHECK(contains(refusal("/accessors/2/count", 3), here + ": KHR_draco_mesh_compression: 512 triangles in its Draco "
                                                            "data, but 3 indices"));
    DracoFile fewer(true, true);
    fewer["/accessors/0/count"] = fewer["/accessors/1/count"] = 7;
    CHECK(contains(refusalOf(fewer), "vertices in its Draco data, but accessors of 7"));
    CHECK(contains(refusal(draco + "/attributes/NORMAL", 9), "Draco attribute 9 does not exist (2 in its data)"));
    CHECK(contains(refusal(draco + "/attributes", {{"NORMAL", 1}}), "attributes: no POSITION"));
    CHECK(contains(refusal(draco + "/attributes/COLOR_0", 1), "\"COLOR_0\" is not among the primitive's attributes"));
    CHECK(contains(refusal(draco + "/bufferView", 5), "buffer view 5 does not exist (1 buffer view)"));
    CHECK(contains(refusal("/meshes/0/primitives/0/mode", 1), "mode 1, expected 4 or 5"));
    DracoFile cut(true, true);
    cut["/bufferViews/0/byteLength"] = 100;
    CHECK(contains(refusalOf(cut), here + ": KHR_draco_mesh_compression: its Draco data are damaged"));
}

TEST_CASE("compressed data changed at random never end in anything but a scene or one line") {
    const std::string box = contentOf(LSDE_TEST_DATA "/odd/gltf-transform/BoxMeshopt.glb");
    REQUIRE(box.size() > 228);
    const int boxes = loadedOfMutations(box, box.size() - 228, "scene.glb", 300, 1);
    CHECK(boxes > 10);
    CHECK(boxes < 290);
    const std::string ballAsGlb = DracoFile(true, true).glb();
    const size_t json =
        20 + static_cast<unsigned char>(ballAsGlb[12]) + 256 * static_cast<unsigned char>(ballAsGlb[13]);
    const int balls = loadedOfMutations(ballAsGlb, json + 8, "scene.glb", 300, 2);
    CHECK(balls < 290);
    const std::string sequential = DracoFile(false, false).glb();
    const int others = loadedOfMutations(sequential, json + 8, "scene.glb", 300, 3);
    CHECK(others > 10);
}
