// Reading the container, and what may lie outside of it.
#include <doctest/doctest.h>

#include "scene/gltf_file.h"

using namespace lsde;
using namespace lsde::test;

namespace {

// Loads with a side file in the scene's folder.
std::string refusalBeside(const GltfFile& file, const std::string& name, const std::string& content,
                          bool allowOutside = false) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "scenes");
    put(folder / "scenes/scene.gltf", file.json.dump());
    put(folder / name, content);
    return errorOf([&] { loadGltf(folder / "scenes/scene.gltf", optionsOf("", allowOutside)); });
}

// The triangle, its buffer in a file of this URI.
GltfFile triangleWithUri(const std::string& uri) {
    GltfFile file = triangleFile();
    file.json["buffers"] = {{{"byteLength", file.bytes.size()}, {"uri", uri}}};
    return file;
}

}  // namespace

TEST_CASE("a scene loads alike from .gltf, from .glb, and whatever the file is called") {
    const GltfFile file = triangleFile();
    const SceneDescription text = load(file);
    const SceneDescription binary = loadText(file.glb());
    REQUIRE(text.meshes.size() == 1);
    REQUIRE(binary.meshes.size() == 1);
    CHECK(text.meshes[0].positions == binary.meshes[0].positions);
    CHECK(text.meshes[0].triangles == binary.meshes[0].triangles);
    CHECK(text.warnings.empty());
    CHECK(binary.warnings.empty());
}

TEST_CASE("a damaged container is refused by one line that says what is wrong with it") {
    const std::string glb = triangleFile().glb();
    const auto patched = [&](size_t offset, const std::string& with) {
        return std::string(glb).replace(offset, with.size(), with);
    };
    CHECK(contains(refusalOf(std::string()), "empty"));
    CHECK(contains(refusalOf("hello"), "not glTF"));
    CHECK(contains(refusalOf("[1]"), "not glTF"));
    CHECK(contains(refusalOf("\xEF\xBB\xBF" + triangleFile().text()), "byte-order mark"));
    CHECK(contains(refusalOf(glb.substr(0, 8)), "truncated GLB: 8 bytes"));
    CHECK(contains(refusalOf(glb.substr(0, glb.size() - 4)), "truncated GLB"));
    CHECK(contains(refusalOf(patched(4, littleEndian(1))), "GLB version 1, expected 2"));
    CHECK(contains(refusalOf(patched(12, littleEndian(0x7FFFFFFC))), "GLB chunk 0: 2147483644 bytes"));
    CHECK(contains(refusalOf(patched(12, littleEndian(5))), "multiple of 4"));
    CHECK(contains(refusalOf(patched(16, "BIN ")), "GLB chunk 0: type"));
    const std::string extra = littleEndian(4) + std::string("BIN\0abcd", 8);
    std::string twoBinaries = glb + extra;
    twoBinaries.replace(8, 4, littleEndian(static_cast<uint32_t>(twoBinaries.size())));
    CHECK(contains(refusalOf(twoBinaries), "GLB chunk 2: BIN chunk"));
    CHECK(warnsOnce(loadText(glb + "tail"), "4 bytes follow the GLB's end"));
    const std::string missing = errorOf([] { loadGltf("/nonexistent/scene.glb"); });
    CHECK(contains(missing, "/nonexistent/scene.glb"));
}

TEST_CASE("JSON that is no JSON, too deep or with too many values is refused before it is taken apart") {
    CHECK(contains(refusalOf("{\"asset\": "), "not valid JSON: parse error at line 1, column 11"));
    CHECK(contains(refusalOf("{\"a\": 1e309}"), "1e309"));
    CHECK(contains(refusalOf("{\"a\": \"\xFF\"}"), "not valid JSON"));
    CHECK(contains(refusalOf("{\"a\": " + std::string(200000, '[')), "nested deeper than 64 levels"));
    GltfFile deep = triangleFile();
    deep["/extras"] = Json::parse(std::string(62, '[') + std::string(62, ']'));
    CHECK(refusalOf(deep).empty());
    // Brackets within strings nest nothing.
    deep["/extras"] = std::string(1000, '[') + "\"\\";
    CHECK(refusalOf(deep).empty());
}

TEST_CASE("more JSON values than the limit are refused before they take memory") {
    std::string many = "{\"a\": [";
    many.resize(21'000'000, ',');
    CHECK(contains(refusalOf(many + "]}"), "more than 20000000 values"));
}

TEST_CASE("a buffer may lie in the scene's folder or below, under a name with blanks or percent signs") {
    const std::string bytes = triangleFile().bytes;
    CHECK(refusalBeside(triangleWithUri("a.bin"), "scenes/a.bin", bytes).empty());
    CHECK(refusalBeside(triangleWithUri("a%20b.bin"), "scenes/a b.bin", bytes).empty());
    CHECK(refusalBeside(triangleWithUri("a  b.bin"), "scenes/a  b.bin", bytes).empty());
    CHECK(refusalBeside(triangleWithUri("100%.bin"), "scenes/100%.bin", bytes).empty());
    CHECK(refusalBeside(triangleWithUri("./x/../a.bin"), "scenes/a.bin", bytes).empty());
    // A file may be longer than its byteLength.
    CHECK(refusalBeside(triangleWithUri("a.bin"), "scenes/a.bin", bytes + "more").empty());
}

TEST_CASE("nothing outside the scene's folder is read unless asked for, and nothing by scheme or absolute path ever") {
    const std::string bytes = triangleFile().bytes;
    for (const char* uri : {"../a.bin", "%2e%2e/a.bin", "x/../../a.bin"}) {
        CAPTURE(uri);
        CHECK(contains(refusalBeside(triangleWithUri(uri), "a.bin", bytes), "outside the scene's folder"));
        CHECK(refusalBeside(triangleWithUri(uri), "a.bin", bytes, true).empty());
    }
    for (const char* uri : {"http://example.com/a.bin", "file:///etc/passwd", "/etc/passwd", "%2Fetc/passwd",
                            "C:\\a.bin", "\\\\server\\a.bin", "fi%6ce:///etc/passwd", "a%00.bin", ""}) {
        CAPTURE(uri);
        CHECK(contains(refusalBeside(triangleWithUri(uri), "a.bin", bytes, true), "refused"));
    }
}

TEST_CASE("a link does not lead out of the scene's folder") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "scenes");
    put(folder / "secret.bin", triangleFile().bytes);
    std::filesystem::create_symlink("../secret.bin", folder / "scenes/link.bin");
    put(folder / "scenes/scene.gltf", triangleWithUri("link.bin").json.dump());
    CHECK(contains(errorOf([&] { loadGltf(folder / "scenes/scene.gltf"); }), "outside the scene's folder"));
    CHECK(errorOf([&] { loadGltf(folder / "scenes/scene.gltf", optionsOf("", true)); }).empty());
    // The folder itself may be reached by one.
    std::filesystem::create_directory_symlink("scenes", folder / "alias");
    put(folder / "scenes/scene.gltf", triangleWithUri("own.bin").json.dump());
    put(folder / "scenes/own.bin", triangleFile().bytes);
    CHECK(errorOf([&] { loadGltf(folder / "alias/scene.gltf"); }).empty());
}

TEST_CASE("what a buffer's uri stands for is checked against its byteLength") {
    const std::string bytes = triangleFile().bytes;
    CHECK(contains(refusalBeside(triangleWithUri("a.bin"), "b.bin", bytes), "buffer 0: uri \"a.bin\": no such file"));
    CHECK(contains(refusalBeside(triangleWithUri("."), "b.bin", bytes), "not a regular file"));
    CHECK(contains(refusalBeside(triangleWithUri("a.bin"), "scenes/a.bin", "short"),
                   "byteLength 42, but its uri has 5 bytes"));
    const auto refusalOfUri = [](const std::string& uri) { return refusalOf(triangleWithUri(uri).json.dump()); };
    CHECK(contains(refusalOfUri("data:;base64,AAAA"), "its uri has 3 bytes"));
    CHECK(contains(refusalOfUri("data:;base64,AA?A"), "base64 data with \"?\" at character 2"));
    CHECK(contains(refusalOfUri("data:;base64,AAA"), "expected a multiple of 4"));
    CHECK(contains(refusalOfUri("data:;base64,A==="), "base64 data with"));
    CHECK(contains(refusalOfUri("data:text/plain,hello"), "expected data:TYPE;base64,DATA"));
    CHECK(contains(refusalOf(triangleFile().json.dump()), "buffer 0 does not exist (0 buffers)"));
}

TEST_CASE("a GLB's buffer must fit its BIN chunk, and needs one") {
    GltfFile file = triangleFile();
    std::string glb = file.glb();
    const size_t at = glb.find("\"byteLength\":42}]");
    REQUIRE(at != std::string::npos);
    CHECK(contains(refusalOf(std::string(glb).replace(at, 15, "\"byteLength\":99")), "but the BIN chunk has 44 bytes"));
    GltfFile none;
    none.json["buffers"] = {{{"byteLength", 4}}};
    CHECK(contains(refusalOf(none.glb()), "neither uri nor BIN chunk"));
}
