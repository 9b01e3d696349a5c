// Whatever a file holds, loading ends: in a scene, or in one line.
#include <doctest/doctest.h>

#include <fstream>
#include <map>

#include "base/error.h"
#include "image/png.h"
#include "scene/gltf_file.h"
#include "support/random.h"

using namespace lsde;
using namespace lsde::test;

namespace {

const std::filesystem::path kOdd = std::filesystem::path(LSDE_TEST_DATA) / "odd";

std::vector<std::filesystem::path> scenesBelow(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

// The Error's message, or nothing if the file loads. Anything else that is thrown fails the test.
std::string outcomeOf(const std::filesystem::path& file) {
    std::string message = errorOf([&] { loadGltf(file); });
    CHECK(message.find('\n') == std::string::npos);
    CHECK(message.size() < 1000);
    return message;
}

// A file with a part of everything that is read: hierarchy, sparse and interleaved accessors, a texture, glass, lights.
GltfFile richFile() {
    GltfFile file =
        triangleFileWith({{"name", "glass"},
                          {"pbrMetallicRoughness",
                           {{"metallicFactor", 0}, {"roughnessFactor", 0}, {"baseColorTexture", {{"index", 0}}}}},
                          {"extensions",
                           {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                            {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}});
    file["/meshes/0/primitives/0/attributes/TEXCOORD_0"] = file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    file["/meshes/0/primitives/0/attributes/NORMAL"] = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const size_t where = file.view(std::vector<uint8_t>{1}), values = file.view(std::vector<float>{2, 0, 0});
    file["/accessors/0/sparse"] = {{"count", 1},
                                   {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                   {"values", {{"bufferView", values}}}};
    file.add("textures", {{"source", 0}});
    file.add("images", {{"mimeType", "image/png"},
                        {"bufferView", file.view(encodePngBytes(2, 2, std::vector<uint8_t>(12, 99)))}});
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}});
    file.json["extensions"] = {
        {"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}}}}}};
    file.node({{"camera", 0}, {"children", {2}}, {"rotation", {0, 0.6, 0, 0.8}}});
    file.add("nodes", {{"mesh", 0},
                       {"scale", {1, -1, 2}},
                       {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
                       {"extras", {{"priority", 2}}}});
    return file;
}

std::string mutated(std::string bytes, Random& random) {
    const auto place = [&](size_t size) { return static_cast<size_t>(random.bits64() % size); };
    switch (random.bits64() % 4) {
        case 0:  // another byte
            bytes[place(bytes.size())] = static_cast<char>(random.bits64());
            break;
        case 1:  // another digit: sizes, offsets and references
            for (int i = 0; i < 3; ++i)
                if (char& c = bytes[place(bytes.size())]; c >= '0' && c <= '9')
                    c = static_cast<char>('0' + random.bits64() % 10);
            break;
        case 2:  // a part left out
            bytes.erase(place(bytes.size()), 1 + place(40));
            break;
        default:  // a part twice
            bytes.insert(place(bytes.size()), bytes.substr(place(bytes.size()), 1 + place(40)));
    }
    return bytes;
}

// Another value in place of one or two of the JSON's.
Json withOddValues(const Json& sound, Random& random) {
    static const std::vector<Json> kOddValues = {
        0,         -1,  1,      2,  3,   5,          255,     1e9,  4294967295,    9007199254740992, 1e308,
        -1e308,    0.5, 1e-320, "", "x", "POSITION", nullptr, true, Json::array(), Json::object(),   {1, 2, 3},
        {{"a", 1}}};
    const Json flat = sound.flatten();
    Json out = sound;
    for (uint64_t n = 1 + random.bits64() % 2; n > 0; --n) {
        const auto at = std::next(flat.begin(), static_cast<std::ptrdiff_t>(random.bits64() % flat.size()));
        Json::json_pointer place(at.key());
        if (random.bits64() % 4 == 0) place.pop_back();
        if (out.contains(place)) out[place] = kOddValues[random.bits64() % kOddValues.size()];
    }
    return out;
}

// Counts of loaded and refused mutations.
std::pair<int, int> outcomesOfMutations(const std::string& sound, const char* name, int count, uint32_t seed) {
    const TemporaryFolder folder;
    Random random(seed);
    std::pair<int, int> outcomes;
    for (int i = 0; i < count; ++i) {
        std::string bytes = sound;
        for (uint64_t n = 1 + random.bits64() % 3; n > 0; --n) bytes = mutated(std::move(bytes), random);
        put(folder / name, bytes);
        CAPTURE(i);
        (outcomeOf(folder / name).empty() ? outcomes.first : outcomes.second) += 1;
    }
    return outcomes;
}

}  // namespace

TEST_CASE("the project's own scenes load, with no warnings but for the pool's open water") {
    for (const auto& file : scenesBelow(LSDE_SCENES)) {
        CAPTURE(file.string());
        const SceneDescription scene = loadGltf(file);
        CHECK(!scene.meshes.empty());
        CHECK(scene.cameras.size() == 1);
        const bool isPool = file.stem() == "pool-small";
        CHECK(scene.warnings.size() == (isPool ? 1 : 0));
        if (isPool) CHECK(warnsOnce(scene, "open edges (256 in all)"));
    }
}

TEST_CASE("every odd file of other loaders' tests loads or is refused in one line") {
    const std::vector<std::filesystem::path> files = scenesBelow(kOdd);
    CHECK(files.size() >= 54);
    for (const auto& file : files) {
        CAPTURE(file.string());
        outcomeOf(file);
    }
}

TEST_CASE("odd files are refused for what is odd about them") {
    const std::map<std::string, const char*> expected = {
        {"cesium/cubeSomeBadIndices.glb", "mesh 0 primitive 0: index 26 = 15, but 8 vertices"},
        {"magnum/mesh-invalid.gltf", "buffer 2: uri"},
        {"tinygltf/invalid-buffer-index.gltf", "buffer view 1: buffer 1 does not exist (1 buffer)"},
        {"tinygltf/invalid-buffer-view-index.gltf", "buffer view 0: buffer 0 does not exist (0 buffers)"},
        {"validator/accessor__alignment.gltf", "accessor 0: starts at byte 3 of its buffer, expected a multiple of 4"},
        {"validator/accessor__small_stride.gltf",
         "accessor 0: byteStride 4 of its buffer view, but an element has 16 bytes"},
        {"validator/asset__min_version_invalid.gltf", "minVersion \"2.1\""},
        {"validator/buffer__no_bin_chunk.glb", "buffer 0: neither uri nor BIN chunk"},
        {"validator/buffer__non_relative_uri.gltf", "uri \"http://example.com/buffer.bin\": refused"},
        {"validator/buffer__wrong_bytelength.glb", "buffer 0: byteLength 17, but the BIN chunk has 16 bytes"},
        {"validator/buffer_view__invalid_length.gltf", "buffer view 0: bytes 0 to 5, but buffer 0 has 4 bytes"},
        {"validator/camera__orthographic_xy.gltf", "xmag 1, ymag 0, expected other than 0"},
        {"validator/ext__KHR_lights_punctual__spot_light_without_spot_object.gltf", "light 0: spot is missing"},
        {"validator/ext__KHR_materials_emissive_strength__out_of_range.gltf", "emissiveStrength -0.5"},
        {"validator/ext__KHR_materials_ior__out_of_range.gltf", "ior -0.5, expected 0 or >= 1"},
        {"validator/glb__bom.glb", "byte-order mark"},
        {"validator/glb__chunk_too_big.glb", "GLB chunk 0"},
        {"validator/glb__invalid_magic.glb", "not glTF"},
        {"validator/glb__misplaced_bin_chunk.glb", "GLB chunk 2: BIN chunk"},
        {"validator/glb__two_bin_chunks.glb", "GLB chunk 0: type"},
        {"validator/json__bom.gltf", "byte-order mark"},
        {"validator/json__empty_file.gltf", "empty"},
        {"validator/mesh__accessor_unequal_count.gltf", "POSITION has 3 elements, but COLOR_0 has 4"},
        {"validator/node__infinite_transform.gltf", "1e309"},
        {"validator/node__node_loop.gltf", "node 0 is its own ancestor"},
        {"validator/node__unresolved_child_node.gltf", "node 0: node 1 does not exist (1 node)"},
        {"validator/scene__unresolved_node.gltf", "scene 0: node 0 does not exist (0 nodes)"},
    };
    for (const auto& [name, message] : expected) {
        CAPTURE(name);
        const std::string said = outcomeOf(kOdd / name);
        CHECK_MESSAGE(contains(said, message), said);
        CHECK(contains(said, std::filesystem::path(name).filename().string()));
    }
    for (const char* sound : {"tinygltf/CubeImageUriMultipleSpaces.gltf", "tinygltf/zero-sized-bin-chunk-issue-440.glb",
                              "tinygltf/unassigned-skeleton.gltf", "gltf-transform/BoxMeshopt.glb",
                              "gltf-transform/DracoSparseMesh.gltf"}) {
        CAPTURE(sound);
        CHECK(outcomeOf(kOdd / sound).empty());
    }
}

TEST_CASE("values changed at random never end in anything but a scene or one line") {
    const Json sound = Json::parse(richFile().text());
    Random random(4);
    int loaded = 0;
    for (int i = 0; i < 1500; ++i) {
        const Json changed = withOddValues(sound, random);
        const std::string said = refusalOf(changed.dump());
        CHECK(said.find('\n') == std::string::npos);
        loaded += said.empty() ? 1 : 0;
    }
    MESSAGE("loaded: ", loaded);
    CHECK(loaded > 30);
    CHECK(loaded < 1000);
}

TEST_CASE("bytes changed at random never end in anything but a scene or one line") {
    const GltfFile rich = richFile();
    REQUIRE(refusalOf(rich).empty());
    const auto [textLoaded, textRefused] = outcomesOfMutations(rich.text(), "scene.gltf", 600, 1);
    const auto [glbLoaded, glbRefused] = outcomesOfMutations(rich.glb(), "scene.glb", 600, 2);
    const std::string hierarchy = contentOf(std::filesystem::path(LSDE_SCENES) / "floor-lamp.glb");
    const auto [lampLoaded, lampRefused] = outcomesOfMutations(hierarchy, "scene.glb", 300, 3);
    MESSAGE("mutations loaded: ", textLoaded, " of .gltf, ", glbLoaded, " of .glb, ", lampLoaded, " of floor-lamp.glb");
    CHECK(textLoaded + glbLoaded + lampLoaded > 50);
    CHECK(textRefused + glbRefused + lampRefused > 500);
}
