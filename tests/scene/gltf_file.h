// glTF files made in tests: JSON and one buffer, written and loaded.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "base/json.h"
#include "scene/gltf.h"
#include "store/fixture.h"

namespace lsde::test {

using Json = nlohmann::json;

inline const double kRootHalf = std::sqrt(0.5);  // of quaternions: a quarter turn

template <typename T>
constexpr int componentTypeOf() {
    if constexpr (std::is_same_v<T, float>) return 5126;
    if constexpr (std::is_same_v<T, uint32_t>) return 5125;
    if constexpr (std::is_same_v<T, uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, int16_t>) return 5122;
    if constexpr (std::is_same_v<T, uint8_t>) return 5121;
    return 5120;
}

inline std::string base64(const std::string& bytes) {
    static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = (bits << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[(bits >> (18 - 6 * k)) & 63];
    }
    return out;
}

inline std::string littleEndian(uint32_t value) {
    return {static_cast<char>(value), static_cast<char>(value >> 8), static_cast<char>(value >> 16),
            static_cast<char>(value >> 24)};
}

struct GltfFile {
    Json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}};
    std::string bytes;  // of buffer 0

    size_t add(const char* list, Json value) {
        json[list].push_back(std::move(value));
        return json[list].size() - 1;
    }
    // At the value of a JSON pointer, "/nodes/0/mesh".
    Json& operator[](const std::string& pointer) { return json[Json::json_pointer(pointer)]; }

    size_t view(const std::string& data) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        bytes += data;
        return add("bufferViews",
                   {{"buffer", 0}, {"byteOffset", bytes.size() - data.size()}, {"byteLength", data.size()}});
    }
    template <typename T>
    size_t view(const std::vector<T>& values) {
        return view(std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)));
    }
    template <typename T>
    size_t accessor(const std::vector<T>& values, const char* type, bool normalized = false) {
        const size_t components = type[0] == 'S' ? 1 : static_cast<size_t>(type[3] - '0');
        Json a = {{"bufferView", view(values)},
                  {"componentType", componentTypeOf<T>()},
                  {"count", values.size() / components},
                  {"type", type}};
        if (normalized) a["normalized"] = true;
        return add("accessors", a);
    }
    // A node of the scene.
    size_t node(Json value) {
        const size_t index = add("nodes", std::move(value));
        json["scenes"][0]["nodes"].push_back(index);
        return index;
    }

    std::string text() const {
        Json out = json;
        if (!bytes.empty())
            out["buffers"] = {
                {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
        return out.dump();
    }
    std::string glb() const {
        Json out = json;
        if (!bytes.empty()) out["buffers"] = {{{"byteLength", bytes.size()}}};
        std::string jsonChunk = out.dump(), binary = bytes;
        jsonChunk.resize((jsonChunk.size() + 3) / 4 * 4, ' ');
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        std::string body = littleEndian(static_cast<uint32_t>(jsonChunk.size())) + "JSON" + jsonChunk;
        if (!binary.empty())
            body += littleEndian(static_cast<uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
        return "glTF" + littleEndian(2) + littleEndian(static_cast<uint32_t>(12 + body.size())) + body;
    }
};

// A right triangle in z = 0 that faces +z, shown by node 0: accessor 0 its positions, accessor 1 its indices.
inline GltfFile triangleFile() {
    GltfFile file;
    const size_t positions = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const size_t indices = file.accessor<uint16_t>({0, 1, 2}, "SCALAR");
    file.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}});
    file.node({{"mesh", 0}});
    return file;
}

// The same with material 0 as given.
inline GltfFile triangleFileWith(Json material) {
    GltfFile file = triangleFile();
    file.add("materials", std::move(material));
    file["/meshes/0/primitives/0/material"] = 0;
    return file;
}

inline GltfOptions optionsOf(const std::string& scene, bool allowOutside = false) {
    GltfOptions options;
    options.scene = scene;
    options.allowOutside = allowOutside;
    return options;
}

inline SceneDescription loadText(const std::string& content, const GltfOptions& options = {}) {
    const TemporaryFolder folder;
    put(folder / "scene.gltf", content);
    return loadGltf(folder / "scene.gltf", options);
}

inline SceneDescription load(const GltfFile& file, const GltfOptions& options = {}) {
    return loadText(file.text(), options);
}

// The refusal of a file, without its name; empty if it loads.
inline std::string refusalOf(const std::string& content) {
    const std::string message = errorOf([&] { loadText(content); });
    const size_t name = message.find("scene.gltf: ");
    return name == std::string::npos ? message : message.substr(name + 12);
}
inline std::string refusalOf(const GltfFile& file) { return refusalOf(file.text()); }

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Whether just one of the warnings has this text.
inline bool warnsOnce(const SceneDescription& scene, const std::string& text) {
    return std::count_if(scene.warnings.begin(), scene.warnings.end(),
                         [&](const std::string& w) { return contains(w, text); }) == 1;
}

}  // namespace lsde::test
