// The scene's hash: what a photon map depends on, and nothing else (not the cameras, not the file's name).
#include <fmt/format.h>
#include <xxhash.h>

#include <span>

#include "scene/scene.h"

namespace lsde {

namespace {

class Hasher {
  public:
    Hasher() : state_(XXH3_createState()) { XXH3_128bits_reset(state_); }
    ~Hasher() { XXH3_freeState(state_); }
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;

    void bytes(const void* data, size_t size) { XXH3_128bits_update(state_, data, size); }
    template <typename T>
    void value(const T& v) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        bytes(&v, sizeof v);
    }
    void value(Vec2 v) { bytes(&v, sizeof v); }
    void value(Vec3 v) { bytes(&v, sizeof v); }
    void value(Vec4 v) { bytes(&v, sizeof v); }
    void value(const std::string& s) {
        value(s.size());
        bytes(s.data(), s.size());
    }
    template <typename T>
    void array(const std::vector<T>& v) {
        value(v.size());
        bytes(v.data(), v.size() * sizeof(T));
    }
    std::string digest() const {
        const XXH128_hash_t h = XXH3_128bits_digest(state_);
        return fmt::format("{:016x}{:016x}", h.high64, h.low64);
    }

  private:
    XXH3_state_t* state_;
};

void add(Hasher& h, const TextureRef& r) {
    h.value(r.texture);
    h.value(r.texCoord);
    h.value(r.matrix);
    h.value(r.offset);
}

void add(Hasher& h, const Mesh& m) {
    h.value(m.object);
    h.array(m.positions);
    h.array(m.normals);
    if (!m.tangents.empty()) h.array(m.tangents);
    for (const auto& uv : m.texCoords) h.array(uv);
    h.array(m.colors);
    h.array(m.triangles);
    h.value(m.material);
    h.value(m.node);
    h.value(m.switches.casts);
    h.value(m.switches.receives);
    h.value(m.switches.aim);
    h.value(m.priority);
}

// What a material does not have leaves the hash as it was before there was such a thing.
void addLayers(Hasher& h, const Material& m) {
    if (m.anisotropy) {
        h.value('a');
        h.value(m.anisotropy->strength);
        h.value(m.anisotropy->rotation);
    }
    if (m.iridescence) {
        h.value('i');
        h.value(m.iridescence->factor);
        h.value(m.iridescence->ior);
        h.value(m.iridescence->thicknessMinimum);
        h.value(m.iridescence->thicknessMaximum);
    }
    if (m.sheen) {
        h.value('s');
        h.value(m.sheen->color);
        h.value(m.sheen->roughness);
    }
    if (m.clearcoat) {
        h.value('c');
        h.value(m.clearcoat->factor);
        h.value(m.clearcoat->roughness);
        h.value(m.clearcoat->normalScale);
    }
}

void add(Hasher& h, const Material& m) {
    h.value(m.doubleSided);
    h.value(m.baseColor);
    h.value(m.metallic);
    h.value(m.roughness);
    h.value(m.ior);
    h.value(m.dispersion);
    h.value(m.specular);
    h.value(m.specularColor);
    h.value(m.transmission);
    h.value(m.emission);
    h.value(m.volume.has_value());
    if (m.volume) {
        h.value(m.volume->attenuationColor);
        h.value(m.volume->attenuationDistance);
    }
    for (const TextureRef* r : m.textures()) add(h, *r);
    if (m.normalTexture) h.value(m.normalScale);
    addLayers(h, m);
    if (m.alphaMode == AlphaMode::Opaque) return;
    h.value(m.alphaMode);
    h.value(m.alpha);
    h.value(m.alphaCutoff);
}

void add(Hasher& h, const Texture& t) {
    h.value(t.width);
    h.value(t.height);
    h.array(t.rgba);
    h.value(t.wrapS);
    h.value(t.wrapT);
    h.value(t.nearest);
}

void add(Hasher& h, const PunctualLight& l) {
    h.value(l.name);
    h.value(l.kind);
    h.value(l.intensity);
    h.value(l.position);
    h.value(l.direction);
    h.value(l.innerConeAngle);
    h.value(l.outerConeAngle);
    if (l.kind != PunctualKind::Measured) return;
    h.value(l.right);
    h.value(l.up);
    h.value(l.profile->photometry());
    for (const std::vector<float>* table : l.profile->tables()) h.array(*table);
}

void add(Hasher& h, const EnvironmentDescription& e) {
    h.value(e.name);
    h.value(e.image.width);
    h.value(e.image.height);
    h.array(e.image.pixels);
    h.value(e.turn);
}

void add(Hasher& h, const SunDescription& s) {
    h.value(s.name);
    h.value(s.direction);
    h.value(s.angularRadius);
    h.value(s.radiance);
}

template <typename T>
void addAll(Hasher& h, const std::vector<T>& items) {
    h.value(items.size());
    for (const T& item : items) add(h, item);
}

}  // namespace

std::string hashDescription(const SceneDescription& description) {
    Hasher h;
    addAll(h, description.meshes);
    addAll(h, description.materials);
    addAll(h, description.textures);
    addAll(h, description.lights);
    if (description.environment) add(h, *description.environment);
    if (description.sun) add(h, *description.sun);
    return h.digest();
}

}  // namespace lsde
