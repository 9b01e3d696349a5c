#include "scene/gltf_compression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.h"
#include "scene/gltf_limits.h"

namespace lsde {

namespace {

std::span<const unsigned char> bytesOf(const std::string& buffer, size_t offset, size_t length) {
    return {reinterpret_cast<const unsigned char*>(buffer.data()) + offset, length};
}

// What each mode and filter allows as an element's size.
void checkMeshoptStride(const JsonObject& extension, const MeshoptView& v) {
    const auto refuse = [&](const std::string& what, const char* expected) {
        extension.fail(fmt::format("{}: byteStride {} with {}, expected {}", kMeshopt, v.stride, what, expected));
    };
    if (v.mode != "ATTRIBUTES") {
        if (v.stride != 2 && v.stride != 4) refuse("mode " + v.mode, "2 or 4");
        if (v.filter != "NONE") extension.fail(fmt::format("{}: filter {} with mode {}", kMeshopt, v.filter, v.mode));
        if (v.mode == "TRIANGLES" && v.count % 3 != 0)
            extension.fail(fmt::format("{}: count {}, expected a multiple of 3", kMeshopt, v.count));
        return;
    }
    if (v.stride % 4 != 0) refuse("mode ATTRIBUTES", "a multiple of 4");
    if (v.filter == "OCTAHEDRAL" && v.stride != 4 && v.stride != 8) refuse("filter OCTAHEDRAL", "4 or 8");
    if (v.filter == "QUATERNION" && v.stride != 8) refuse("filter QUATERNION", "8");
}

std::string oneOf(const JsonObject& extension, const char* key, const std::string& value,
                  std::initializer_list<std::string_view> known) {
    if (std::find(known.begin(), known.end(), value) == known.end())
        extension.fail(fmt::format("{}: {} {} is unknown", kMeshopt, key, shown(value)));
    return value;
}

void decodeViews(Json& json, const std::string& file, GltfBuffers& buffers) {
    const JsonObject root(json, "", file);
    const size_t own = buffers.size();
    uint64_t sum = 0;
    size_t index = 0;
    for (const JsonObject& object : root.objects("bufferViews", "buffer view")) {
        Json& view = json["bufferViews"][index++];
        if (buffers[object.reference("buffer", "buffer", own).value()]) continue;
        const auto meshopt = readMeshoptView(object, own);
        if (!meshopt) continue;
        sum += meshopt->count * meshopt->stride;
        if (sum > kMaxFileBytes) object.fail(fmt::format("more than {} bytes once decoded with it", kMaxFileBytes));
        try {
            buffers.emplace_back(
                decodeMeshopt(*meshopt, bytesOf(*buffers[meshopt->buffer], meshopt->offset, meshopt->bytes)));
        } catch (const Error& e) {
            object.fail(fmt::format("{}: {}", kMeshopt, e.what()));
        }
        view["buffer"] = buffers.size() - 1;
        view["byteOffset"] = 0;
    }
}

// ---- Draco

class DracoDecoder {
  public:
    DracoDecoder(Json& json, const std::string& file, GltfBuffers& buffers)
        : json_(json), file_(file), buffers_(buffers) {}

    void decode(const JsonObject& primitive, const JsonObject& extension, Json& out) {
        const JsonObject ids = extension.object("attributes").value();
        std::vector<std::string> names;
        std::vector<DracoTarget> attributes;
        for (const auto& [name, id] : ids.json().items()) {
            names.push_back(name);
            attributes.push_back(targetOf(out["attributes"][name]));
            attributes.back().attribute = static_cast<uint32_t>(id.get<double>());
        }
        std::optional<DracoTarget> indices;
        if (primitive.has("indices")) indices = targetOf(out["indices"]);
        try {
            decodeDraco(viewBytes(extension), attributes, indices ? &*indices : nullptr);
        } catch (const Error& e) {
            primitive.fail(fmt::format("{}: {}", kDraco, e.what()));
        }
        for (size_t i = 0; i < names.size(); ++i)
            out["attributes"][names[i]] = keep(out["attributes"][names[i]], std::move(attributes[i].bytes));
        if (indices) out["indices"] = keep(out["indices"], std::move(indices->bytes));
        out["mode"] = 4;  // Draco knows triangles only
    }

  private:
    Json& accessor(const Json& index) { return json_["accessors"][static_cast<size_t>(index.get<double>())]; }

    DracoTarget targetOf(const Json& index) {
        const JsonObject object(accessor(index), "", file_);
        const std::string type = object.string("type");
        DracoTarget target;
        target.componentType = static_cast<int>(object.integer("componentType", 5126, 0, 1 << 16));
        target.components = type == "SCALAR" ? 1 : static_cast<size_t>(type[3] - '0');
        target.count = static_cast<size_t>(object.integer("count", 1, 1, kMaxFileBytes));
        return target;
    }
    std::span<const unsigned char> viewBytes(const JsonObject& extension) {
        const JsonObject root(json_, "", file_);
        const size_t index = extension.reference("bufferView", "buffer view", root.size("bufferViews")).value();
        const JsonObject view(json_["bufferViews"][index], "", file_);
        const size_t buffer = view.reference("buffer", "buffer", buffers_.size()).value();
        return bytesOf(*buffers_[buffer], static_cast<size_t>(view.integer("byteOffset", 0, 0, kMaxFileBytes)),
                       static_cast<size_t>(view.integer("byteLength", 1, 1, kMaxFileBytes)));
    }
    // A copy of an accessor, of these bytes: others may use the one there is for something else.
    size_t keep(const Json& index, std::string bytes) {
        Json copy = accessor(index);
        copy["bufferView"] = json_["bufferViews"].size();
        copy["byteOffset"] = 0;
        json_["bufferViews"].push_back({{"buffer", buffers_.size()}, {"byteLength", bytes.size()}});
        json_["accessors"].push_back(std::move(copy));
        buffers_.emplace_back(std::move(bytes));
        return json_["accessors"].size() - 1;
    }

    Json& json_;
    const std::string& file_;
    GltfBuffers& buffers_;
};

void decodePrimitives(Json& json, const std::string& file, GltfBuffers& buffers) {
    DracoDecoder decoder(json, file, buffers);
    const JsonObject root(json, "", file);
    size_t mesh = 0;
    for (const JsonObject& object : root.objects("meshes", "mesh")) {
        size_t index = 0;
        for (const JsonObject& primitive : object.objects("primitives", "primitive")) {
            Json& out = json["meshes"][mesh]["primitives"][index++];
            if (const auto draco = neededDraco(root, primitive)) decoder.decode(primitive, *draco, out);
        }
        ++mesh;
    }
}

}  // namespace

std::optional<MeshoptView> readMeshoptView(const JsonObject& view, size_t buffers) {
    const auto extension = view.extension(kMeshopt);
    if (!extension) return {};
    for (const char* key : {"buffer", "byteLength", "byteStride", "count", "mode"}) extension->require(key);
    constexpr auto kLargest = static_cast<int64_t>(kMaxFileBytes);
    MeshoptView v;
    v.buffer = extension->reference("buffer", "buffer", buffers).value();
    v.offset = static_cast<size_t>(extension->integer("byteOffset", 0, 0, kLargest));
    v.bytes = static_cast<size_t>(extension->integer("byteLength", 0, 1, kLargest));
    v.stride = static_cast<size_t>(extension->integer("byteStride", 0, 2, 256));
    v.count = static_cast<size_t>(extension->integer("count", 0, 1, kLargest));
    v.mode = oneOf(*extension, "mode", extension->string("mode"), {"ATTRIBUTES", "TRIANGLES", "INDICES"});
    const std::string filter = extension->has("filter") ? extension->string("filter") : "NONE";
    v.filter = oneOf(*extension, "filter", filter, {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"});
    checkMeshoptStride(*extension, v);
    const auto bytes = static_cast<size_t>(view.integer("byteLength", 0, 1, kLargest));
    if (v.count * v.stride != bytes)
        view.fail(fmt::format("{}: {} elements of {} bytes, but byteLength {}", kMeshopt, v.count, v.stride, bytes));
    return v;
}

std::optional<JsonObject> neededDraco(const JsonObject& root, const JsonObject& primitive) {
    auto extension = primitive.extension(kDraco);
    const auto attributes = primitive.object("attributes");
    if (!extension || !attributes) return {};
    const auto isThere = [&](const JsonObject& object, const char* key) {
        const auto accessor = object.reference(key, "accessor", root.size("accessors"));
        return !accessor || root.json()["accessors"][*accessor].contains("bufferView");
    };
    bool there = isThere(primitive, "indices") && attributes->has("POSITION");
    for (const auto& [name, index] : attributes->json().items()) there &= isThere(*attributes, name.c_str());
    return there ? std::nullopt : extension;
}

void decodeCompressed(Json& json, const std::string& file, GltfBuffers& buffers) {
    decodeViews(json, file, buffers);
    decodePrimitives(json, file, buffers);
}

}  // namespace lsde
