#include "scene/gltf_model.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cstring>

namespace lsde {

namespace {

// ---- what tinygltf is given: a JSON text of buffers, accessors and meshes alone, written anew; it never opens a file

// The named properties of an object, whole numbers as such however they are written (tinygltf refuses 1.0 for 1).
Json pick(const Json& object, std::initializer_list<const char*> keys) {
    Json out = Json::object();
    for (const char* key : keys) {
        const auto at = object.find(key);
        if (at == object.end()) continue;
        if (at->is_number_float())
            out[key] = static_cast<uint64_t>(at->get<double>());
        else
            out[key] = *at;
    }
    return out;
}

Json pickEach(const JsonObject& root, const char* key, std::initializer_list<const char*> keys) {
    Json out = Json::array();
    if (root.size(key) > 0)
        for (const Json& object : root.json()[key]) out.push_back(pick(object, keys));
    return out;
}

Json accessorsFor(const JsonObject& root) {
    Json out =
        pickEach(root, "accessors", {"bufferView", "byteOffset", "componentType", "count", "type", "normalized"});
    for (size_t i = 0; i < out.size(); ++i) {
        const Json& from = root.json()["accessors"][i];
        if (!from.contains("sparse")) continue;
        Json& sparse = out[i]["sparse"] = pick(from["sparse"], {"count"});
        sparse["indices"] = pick(from["sparse"]["indices"], {"bufferView", "byteOffset", "componentType"});
        sparse["values"] = pick(from["sparse"]["values"], {"bufferView", "byteOffset"});
    }
    return out;
}

Json wholeNumbers(const Json& object) {
    Json out = Json::object();
    for (const auto& [name, index] : object.items()) out[name] = static_cast<uint64_t>(index.get<double>());
    return out;
}

Json meshesFor(const JsonObject& root) {
    Json out = Json::array();
    for (const JsonObject& mesh : root.objects("meshes", "mesh")) {
        Json primitives = pickEach(mesh, "primitives", {"indices", "mode", "material"});
        for (size_t i = 0; i < primitives.size(); ++i) {
            const Json& from = mesh.json()["primitives"][i];
            primitives[i]["attributes"] = wholeNumbers(from["attributes"]);
            if (!from.contains("targets")) continue;
            for (const Json& target : from["targets"]) primitives[i]["targets"].push_back(wholeNumbers(target));
        }
        out.push_back({{"primitives", std::move(primitives)}});
    }
    return out;
}

// Buffers are called by their index, and read by readBuffer(). One without data is one byte.
Json buffersFor(const GltfBuffers& buffers) {
    Json out = Json::array();
    for (size_t i = 0; i < buffers.size(); ++i)
        out.push_back({{"byteLength", buffers[i] ? buffers[i]->size() : 1}, {"uri", std::to_string(i)}});
    return out;
}

// tinygltf's callback to read a file: the buffer of this index, which is given up.
bool readBuffer(std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
    std::optional<std::string>& buffer = (*static_cast<GltfBuffers*>(user))[std::stoul(name)];
    out->assign(1, 0);
    if (buffer) out->assign(buffer->begin(), buffer->end());
    buffer.reset();
    return true;
}

tinygltf::Model parse(const JsonObject& root, GltfBuffers& buffers) {
    const Json json = {
        {"asset", {{"version", "2.0"}}},
        {"buffers", buffersFor(buffers)},
        {"bufferViews", pickEach(root, "bufferViews", {"buffer", "byteOffset", "byteLength", "byteStride"})},
        {"accessors", accessorsFor(root)},
        {"meshes", meshesFor(root)}};
    const std::string text = json.dump();
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({[](const std::string&, void*) { return true; },
                           [](const std::string& name, void*) { return name; }, &readBuffer, nullptr, &buffers});
    tinygltf::Model model;
    std::string error, warning;
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.c_str(), static_cast<unsigned>(text.size()), ""))
        root.fail(error.substr(0, error.find('\n')));
    return model;
}

// ---- what it gives back

// Null in a buffer without data, which nothing reads.
const unsigned char* bytesAt(const tinygltf::Model& model, int view, size_t offset) {
    const tinygltf::BufferView& v = model.bufferViews[static_cast<size_t>(view)];
    const std::vector<unsigned char>& data = model.buffers[static_cast<size_t>(v.buffer)].data;
    return v.byteOffset + offset < data.size() ? data.data() + v.byteOffset + offset : nullptr;
}

GltfAccessor accessorOf(const std::string& file, const tinygltf::Model& model, size_t index) {
    const tinygltf::Accessor& a = model.accessors[index];
    GltfAccessor out;
    out.where = fmt::format("{}: accessor {}", file, index);
    out.count = a.count;
    out.componentType = a.componentType;
    out.components = static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(a.type)));
    out.normalized = a.normalized;
    if (a.bufferView >= 0) {
        out.data = bytesAt(model, a.bufferView, a.byteOffset);
        out.stride = static_cast<size_t>(a.ByteStride(model.bufferViews[static_cast<size_t>(a.bufferView)]));
    }
    if (a.sparse.isSparse) {
        out.sparseCount = static_cast<size_t>(a.sparse.count);
        out.sparseIndexType = a.sparse.indices.componentType;
        out.sparseIndices =
            bytesAt(model, a.sparse.indices.bufferView, static_cast<size_t>(a.sparse.indices.byteOffset));
        out.sparseValues = bytesAt(model, a.sparse.values.bufferView, static_cast<size_t>(a.sparse.values.byteOffset));
    }
    return out;
}

}  // namespace

GltfModel parseModel(const JsonObject& root, GltfBuffers buffers) {
    tinygltf::Model parsed = parse(root, buffers);
    GltfModel model;
    for (size_t i = 0; i < parsed.bufferViews.size(); ++i) {
        const unsigned char* bytes = bytesAt(parsed, static_cast<int>(i), 0);
        model.views.emplace_back(bytes, bytes == nullptr ? 0 : parsed.bufferViews[i].byteLength);
    }
    for (size_t i = 0; i < parsed.accessors.size(); ++i) model.accessors.push_back(accessorOf(root.file(), parsed, i));
    for (const tinygltf::Mesh& mesh : parsed.meshes) {
        std::vector<GltfPrimitive>& primitives = model.meshes.emplace_back();
        for (const tinygltf::Primitive& p : mesh.primitives)
            primitives.push_back({p.mode, p.indices, p.material, p.attributes, p.targets});
    }
    // Moved, not copied: what was pointed at stays where it is.
    for (tinygltf::Buffer& buffer : parsed.buffers) model.buffers.push_back(std::move(buffer.data));
    return model;
}

bool decodePngOrJpeg(std::span<const unsigned char> bytes, Texture& texture) {
    tinygltf::Image picture;
    std::string error, warning;
    if (!tinygltf::LoadImageData(&picture, 0, &error, &warning, texture.width, texture.height, bytes.data(),
                                 static_cast<int>(bytes.size()), nullptr))
        return false;
    if (picture.bits == 8) {
        texture.rgba = std::move(picture.image);
        return true;
    }
    for (size_t i = 0; i + 1 < picture.image.size(); i += 2) {
        uint16_t value = 0;
        std::memcpy(&value, &picture.image[i], sizeof value);
        texture.rgba.push_back(static_cast<uint8_t>((value + 128) / 257));
    }
    return true;
}

}  // namespace lsde
