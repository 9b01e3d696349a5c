#include "scene/gltf_textures.h"

#include <fmt/format.h>

#include "base/error.h"
#include "scene/gltf_limits.h"
#include "scene/image_size.h"
#include "scene/webp.h"

namespace lsde {

namespace {

// Of OpenGL, as glTF has them.
constexpr int64_t kRepeat = 10497, kClampToEdge = 33071, kMirroredRepeat = 33648, kNearest = 9728;

class TextureLoader {
  public:
    TextureLoader(const GltfResources& resources, const GltfModel& model, Warnings& warnings)
        : resources_(resources),
          model_(model),
          warnings_(warnings),
          images_(resources.root.objects("images", "image")),
          samplers_(resources.root.objects("samplers", "sampler")) {}

    Texture load(const JsonObject& object) {
        const JsonObject& image = images_[sourceOf(object)];
        Texture texture;
        texture.name = object.string("name").empty() ? image.string("name") : object.string("name");
        if (const auto sampler = object.reference("sampler", "sampler", samplers_.size()))
            readSampler(samplers_[*sampler], texture);
        readPicture(image, texture);
        return texture;
    }

  private:
    // WebP before what is there for those that cannot read it; KTX2 not at all.
    size_t sourceOf(const JsonObject& object) {
        const auto within = [&](const char* name) {
            const auto extension = object.extension(name);
            return extension ? extension->reference("source", "image", images_.size()) : std::nullopt;
        };
        if (const auto webp = within("EXT_texture_webp")) return *webp;
        const auto source = object.reference("source", "image", images_.size());
        const bool basis = object.extension("KHR_texture_basisu").has_value();
        if (source && basis)
            warnings_.add("KTX2 (KHR_texture_basisu) is not supported: its fallback picture is taken", object.where());
        if (!source)
            object.fail(basis ? "KTX2 (KHR_texture_basisu) without a fallback, expected a PNG, JPEG or WebP image"
                              : "no source, expected a PNG, JPEG or WebP image");
        return *source;
    }
    static Wrap wrapOf(const JsonObject& sampler, const char* key) {
        const int64_t wrap = sampler.integer(key, kRepeat, 0, 1 << 16);
        if (wrap == kClampToEdge) return Wrap::Clamp;
        return wrap == kMirroredRepeat ? Wrap::Mirror : Wrap::Repeat;
    }
    static void readSampler(const JsonObject& sampler, Texture& texture) {
        texture.wrapS = wrapOf(sampler, "wrapS");
        texture.wrapT = wrapOf(sampler, "wrapT");
        texture.nearest = sampler.integer("magFilter", 0, 0, 1 << 16) == kNearest;
    }
    void readPicture(const JsonObject& image, Texture& texture) {
        std::string file;
        std::span<const unsigned char> bytes;
        if (const auto view = image.reference("bufferView", "buffer view", model_.views.size())) {
            bytes = model_.views[*view];
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
        if (!(isWebp(bytes) ? decodeWebp(bytes, texture) : decodePngOrJpeg(bytes, texture)))
            image.fail("cannot be decoded: its data are damaged");
    }

    const GltfResources& resources_;
    const GltfModel& model_;
    Warnings& warnings_;
    std::vector<JsonObject> images_, samplers_;
    uint64_t pixels_ = 0;  // of all textures so far
};

}  // namespace

std::vector<Texture> loadTextures(const GltfResources& resources, const GltfModel& model,
                                  const std::vector<Material>& materials, const std::set<uint32_t>& used,
                                  Warnings& warnings) {
    TextureLoader loader(resources, model, warnings);
    const std::vector<JsonObject> objects = resources.root.objects("textures", "texture");
    std::vector<Texture> textures(objects.size());
    for (const uint32_t m : used)
        for (const TextureRef* ref : materials[m].textures())
            if (*ref && textures[static_cast<size_t>(ref->texture)].width == 0)
                textures[static_cast<size_t>(ref->texture)] = loader.load(objects[static_cast<size_t>(ref->texture)]);
    return textures;
}

}  // namespace lsde
