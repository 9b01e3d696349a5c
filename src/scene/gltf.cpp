// The one file that includes tinygltf: it parses buffers, accessors and meshes, and decodes pictures. It gets a JSON
// text of these alone, written anew from what validation passed, and never opens a file itself.
#include "scene/gltf.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cstring>
#include <set>
#include <span>

#include "base/error.h"
#include "scene/gltf_attachments.h"
#include "scene/gltf_geometry.h"
#include "scene/gltf_limits.h"
#include "scene/gltf_material.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_placement.h"
#include "scene/gltf_uri.h"
#include "scene/gltf_validate.h"
#include "scene/image_size.h"
#include "store/file.h"

namespace lsde {

namespace {

// ---- what tinygltf is given

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

Json meshesFor(const JsonObject& root) {
    Json out = Json::array();
    for (const JsonObject& mesh : root.objects("meshes", "mesh")) {
        Json primitives = pickEach(mesh, "primitives", {"indices", "mode", "material"});
        for (size_t i = 0; i < primitives.size(); ++i) {
            Json& attributes = primitives[i]["attributes"] = Json::object();
            for (const auto& [name, index] : mesh.json()["primitives"][i]["attributes"].items())
                attributes[name] = static_cast<uint64_t>(index.get<double>());
        }
        out.push_back({{"primitives", std::move(primitives)}});
    }
    return out;
}

// Where the bytes behind URIs come from.
struct Resources {
    const JsonObject& root;
    std::filesystem::path folder;
    bool allowOutside = false;
    GltfSource& source;
    std::vector<JsonObject> buffers = root.objects("buffers", "buffer");

    std::string behindUri(const JsonObject& object, uint64_t limit) const {
        const std::string uri = object.string("uri");
        return isDataUri(uri) ? decodeDataUri(uri) : readFile(resolveUri(folder, uri, allowOutside), limit);
    }
    bool bufferHasData(size_t index) const { return buffers[index].has("uri") || (index == 0 && source.hasBinary); }
    size_t bufferBytes(size_t index) const {
        return bufferHasData(index) ? static_cast<size_t>(buffers[index].integer("byteLength", 1, 1, kMaxFileBytes))
                                    : 1;
    }
};

// Buffers are called by their index, and read by readBuffer(). One without data that an extension would fill, and that
// nothing reads, is one byte.
Json buffersFor(const Resources& resources) {
    Json out = Json::array();
    for (size_t i = 0; i < resources.buffers.size(); ++i)
        out.push_back({{"byteLength", resources.bufferBytes(i)}, {"uri", std::to_string(i)}});
    return out;
}

// tinygltf's callback to read a file: the buffer of this index, cut to its byteLength.
bool readBuffer(std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
    const auto& resources = *static_cast<const Resources*>(user);
    const size_t index = std::stoul(name);
    const JsonObject& buffer = resources.buffers[index];
    std::string bytes(1, '\0');
    if (buffer.has("uri"))
        bytes = resources.behindUri(buffer, kMaxFileBytes);
    else if (resources.bufferHasData(index))
        bytes = std::move(resources.source.binary);
    const size_t length = resources.bufferBytes(index);
    if (bytes.size() < length) buffer.fail("its file was cut while being read");
    out->assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    return true;
}

tinygltf::Model parseBinaryParts(Resources& resources) {
    const Json json = {
        {"asset", {{"version", "2.0"}}},
        {"buffers", buffersFor(resources)},
        {"bufferViews", pickEach(resources.root, "bufferViews", {"buffer", "byteOffset", "byteLength", "byteStride"})},
        {"accessors", accessorsFor(resources.root)},
        {"meshes", meshesFor(resources.root)}};
    const std::string text = json.dump();
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({[](const std::string&, void*) { return true; },
                           [](const std::string& name, void*) { return name; }, &readBuffer, nullptr, &resources});
    tinygltf::Model model;
    std::string error, warning;
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.c_str(), static_cast<unsigned>(text.size()), ""))
        resources.root.fail(error.substr(0, error.find('\n')));
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

GltfModel modelOf(const std::string& file, const tinygltf::Model& parsed) {
    GltfModel model;
    for (size_t i = 0; i < parsed.accessors.size(); ++i) model.accessors.push_back(accessorOf(file, parsed, i));
    for (const tinygltf::Mesh& mesh : parsed.meshes) {
        std::vector<GltfPrimitive>& primitives = model.meshes.emplace_back();
        for (const tinygltf::Primitive& p : mesh.primitives)
            primitives.push_back({p.mode, p.indices, p.material, p.attributes});
    }
    return model;
}

// ---- textures

// Decoded to 8 bits RGBA. The size is checked before.
void decodePicture(const JsonObject& image, std::span<const unsigned char> bytes, Texture& texture) {
    tinygltf::Image picture;
    std::string error, warning;
    if (!tinygltf::LoadImageData(&picture, 0, &error, &warning, texture.width, texture.height, bytes.data(),
                                 static_cast<int>(bytes.size()), nullptr))
        image.fail("cannot be decoded: its data are damaged");
    if (picture.bits == 8) {
        texture.rgba = std::move(picture.image);
        return;
    }
    for (size_t i = 0; i + 1 < picture.image.size(); i += 2) {
        uint16_t value = 0;
        std::memcpy(&value, &picture.image[i], sizeof value);
        texture.rgba.push_back(static_cast<uint8_t>((value + 128) / 257));
    }
}

class TextureLoader {
  public:
    TextureLoader(const Resources& resources, const tinygltf::Model& parsed)
        : resources_(resources),
          parsed_(parsed),
          images_(resources.root.objects("images", "image")),
          samplers_(resources.root.objects("samplers", "sampler")) {}

    Texture load(const JsonObject& object) {
        const auto source = object.reference("source", "image", images_.size());
        if (!source) object.fail("no source, expected a PNG or JPEG image (KTX2 and WebP are not supported)");
        const JsonObject& image = images_[*source];
        Texture texture;
        texture.name = object.string("name").empty() ? image.string("name") : object.string("name");
        if (const auto sampler = object.reference("sampler", "sampler", samplers_.size()))
            readSampler(samplers_[*sampler], texture);
        readPicture(image, texture);
        return texture;
    }

  private:
    static Wrap wrapOf(const JsonObject& sampler, const char* key) {
        const int64_t wrap = sampler.integer(key, TINYGLTF_TEXTURE_WRAP_REPEAT, 0, 1 << 16);
        if (wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::Clamp;
        return wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::Mirror : Wrap::Repeat;
    }
    static void readSampler(const JsonObject& sampler, Texture& texture) {
        texture.wrapS = wrapOf(sampler, "wrapS");
        texture.wrapT = wrapOf(sampler, "wrapT");
        texture.nearest = sampler.integer("magFilter", 0, 0, 1 << 16) == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    void readPicture(const JsonObject& image, Texture& texture) {
        std::string file;
        std::span<const unsigned char> bytes;
        if (const auto view = image.reference("bufferView", "buffer view", parsed_.bufferViews.size())) {
            bytes = {bytesAt(parsed_, static_cast<int>(*view), 0), parsed_.bufferViews[*view].byteLength};
        } else {
            file = resources_.behindUri(image, kMaxImageBytes);
            bytes = {reinterpret_cast<const unsigned char*>(file.data()), file.size()};
        }
        ImageSize size;
        try {
            size = readImageSize(bytes);
        } catch (const Error& e) {
            image.fail(e.what());
        }
        const uint64_t pixels = uint64_t{size.width} * size.height;
        if (pixels == 0 || pixels > kMaxImagePixels)
            image.fail(fmt::format("{} x {} pixels, expected 1 to {}", size.width, size.height, kMaxImagePixels));
        pixels_ += pixels;
        if (pixels_ > kMaxScenePixels)
            image.fail(fmt::format("the scene's textures have more than {} pixels with it", kMaxScenePixels));
        texture.width = static_cast<int>(size.width);
        texture.height = static_cast<int>(size.height);
        decodePicture(image, bytes, texture);
    }

    const Resources& resources_;
    const tinygltf::Model& parsed_;
    std::vector<JsonObject> images_, samplers_;
    uint64_t pixels_ = 0;  // of all textures so far
};

// The file's textures; those that no material in use refers to stay empty.
std::vector<Texture> loadTextures(TextureLoader loader, const JsonObject& root, const std::vector<Material>& materials,
                                  const std::set<uint32_t>& used) {
    const std::vector<JsonObject> objects = root.objects("textures", "texture");
    std::vector<Texture> textures(objects.size());
    for (const uint32_t m : used)
        for (const TextureRef* ref : materials[m].textures())
            if (*ref && textures[static_cast<size_t>(ref->texture)].width == 0)
                textures[static_cast<size_t>(ref->texture)] = loader.load(objects[static_cast<size_t>(ref->texture)]);
    return textures;
}

SceneDescription load(const std::filesystem::path& file, const GltfOptions& options, Warnings& warnings) {
    const std::string name = file.string();
    GltfSource source = readGltfSource(file, warnings);
    const Json json = validateGltf(file, source, options.allowOutside, warnings);
    source.json = {};
    const JsonObject root(json, "", name);

    SceneDescription scene;
    scene.file = file;
    const std::vector<GltfMaterial> materials = readMaterials(root, warnings);
    for (const GltfMaterial& m : materials) scene.materials.push_back(m.material);
    const GltfAttachments attachments = readAttachments(root, warnings);
    const size_t index = chooseScene(root, options.scene);
    scene.sceneName = root.objects("scenes", "scene")[index].string("name");
    const std::vector<PlacedNode> placed = placeNodes(root, index, warnings);
    scene.cameras = placeCameras(attachments, root, placed);
    scene.lights = placeLights(attachments, root, placed);

    Resources resources{root, file.parent_path(), options.allowOutside, source};
    const tinygltf::Model parsed = parseBinaryParts(resources);
    const GltfModel model = modelOf(name, parsed);
    GeometryLoader geometry(name, model, warnings);
    placeMeshes(root, placed, materials, geometry, scene, warnings);
    if (scene.meshes.empty()) root.fail(fmt::format("scene {}: no triangles to render", index));
    countOpenEdges(scene.meshes, scene.materials, warnings);
    std::set<uint32_t> used;
    for (const Mesh& mesh : scene.meshes) used.insert(mesh.material);
    scene.textures = loadTextures(TextureLoader(resources, parsed), root, scene.materials, used);
    return scene;
}

}  // namespace

SceneDescription loadGltf(const std::filesystem::path& file, const GltfOptions& options) {
    Warnings warnings;
    try {
        SceneDescription scene = load(file, options, warnings);
        scene.warnings = warnings.lines(file.string());
        return scene;
    } catch (const Error&) {
        if (options.onWarning)
            for (const std::string& line : warnings.lines(file.string())) options.onWarning(line);
        throw;
    }
}

}  // namespace lsde
