#include "scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"
#include "path/event.h"
#include "scene/coverage.h"
#include "scene/tangent_frame.h"

namespace lsde {

namespace {

float meshArea(const Mesh& mesh) {
    double area = 0;
    for (const Triangle& t : mesh.triangles)
        area += 0.5 * glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                             mesh.positions[t[2]] - mesh.positions[t[0]]));
    return static_cast<float>(area);
}

}  // namespace

bool hasNarrowLobe(const Material& m) {
    if (m.clearcoat && (m.clearcoat->roughness < kGlossyRoughness || m.clearcoat->roughnessTexture)) return true;
    const bool glossy = m.metallic > 0 || m.metallicRoughnessTexture || m.specular > 0 || m.transmission > 0;
    const bool narrow = m.roughness < kGlossyRoughness || m.metallicRoughnessTexture;
    return glossy && narrow;
}

Scene::Scene(SceneDescription description)
    : description_(std::move(description)),
      accel_(description_.meshes, partialCoverage()),
      hash_(hashDescription(description_)) {
    std::map<std::string, uint32_t> objectIndex;
    for (const Mesh& mesh : description_.meshes) {
        MeshInfo info;
        const auto [at, added] = objectIndex.try_emplace(mesh.object, static_cast<uint32_t>(objects_.size()));
        if (added) objects_.push_back(mesh.object);
        info.object = at->second;
        info.area = meshArea(mesh);
        info.receiver = mesh.switches.receives;
        bounds_.grow(mesh.bounds());
        const Material& material = description_.materials[mesh.material];
        hasThinWalls_ |= material.isThinWall();
        info.caster = mesh.switches.casts && hasNarrowLobe(material);
        meshes_.push_back(info);
    }
    if (!bounds_.empty()) {
        boundingSphere_.centre = bounds_.centre();
        for (const Mesh& mesh : description_.meshes)
            for (const Vec3 p : mesh.positions)
                boundingSphere_.radius = std::max(boundingSphere_.radius, glm::length(p - boundingSphere_.centre));
    }
    buildMedia();
    buildLights();
    buildCasters();
}

PartialCoverage Scene::partialCoverage() const {
    PartialCoverage out;
    for (const Mesh& mesh : description_.meshes)
        out.partial.push_back(coversPartly(mesh, description_.materials[mesh.material], description_.textures));
    out.at = [this](const Hit& hit) { return coverageAt(hit.mesh, hit.triangle, hit.u, hit.v); };
    return out;
}

float Scene::coverageAt(uint32_t mesh, uint32_t triangle, float u, float v) const {
    const Mesh& m = description_.meshes[mesh];
    return lsde::coverage(m, description_.materials[m.material], description_.textures, triangle, u, v);
}

void Scene::buildLights() {
    for (size_t i = 0; i < meshes_.size(); ++i) {
        const Mesh& mesh = description_.meshes[i];
        const Material& material = description_.materials[mesh.material];
        if (!material.emissive()) continue;
        AreaLight area(mesh, material, description_.textures);
        if (area.triangles.empty()) continue;
        meshes_[i].light = static_cast<int>(lights_.size());
        lights_.push_back({mesh.object, std::move(area)});
    }
    for (const PunctualLight& p : description_.lights) {
        if (isBlack(p.intensity)) continue;
        if (p.kind == PunctualKind::Directional) {
            lights_.push_back({p.name, DirectionalLight{p.direction, p.intensity, boundingSphere_}});
            continue;
        }
        PointLight light{.position = p.position,
                         .intensity = p.intensity,
                         .axis = p.direction,
                         .profile = p.profile,
                         .right = p.right,
                         .up = p.up};
        if (p.kind == PunctualKind::Spot) {
            light.oneMinusCosInner = 2 * square(std::sin(0.5F * p.innerConeAngle));
            light.oneMinusCosOuter = 2 * square(std::sin(0.5F * p.outerConeAngle));
        }
        lights_.push_back({p.name, light});
    }
    buildInfiniteLights();
    if (lights_.size() > 65535)
        throw Error(fmt::format("{}: {} lights, expected at most 65535", description_.file.string(), lights_.size()));
}

void Scene::buildInfiniteLights() {
    const auto add = [&](const std::string& name, std::variant<EnvironmentMap, SunDisc> source) {
        infiniteLights_.push_back(lights_.size());
        lights_.push_back({name, InfiniteLight{std::move(source), boundingSphere_}});
    };
    if (const auto& e = description_.environment) add(e->name, EnvironmentMap(e->image, e->turn));
    if (const auto& s = description_.sun)
        add(s->name, SunDisc{s->direction, 2 * square(std::sin(0.5F * s->angularRadius)), s->radiance});
}

void Scene::buildCasters() {
    // Wider than the caster by more than directions and places are rounded to: what meets a far caster's rim lies in
    // its cone, or it would weigh as light that was never aimed, 1e6 times too much.
    constexpr float kMargin = 1e-3F, kRounding = 4e-7F;
    const float rounding = kRounding * (boundingSphere_.radius + glm::length(boundingSphere_.centre));
    std::vector<Sphere> spheres;
    for (size_t i = 0; i < meshes_.size(); ++i)
        if (meshes_[i].caster && description_.meshes[i].switches.aim) {
            spheres.push_back(boundingSphereOf(description_.meshes[i]));
            spheres.back().radius += kMargin * spheres.back().radius + rounding;
        }
    casters_ = groupCasters(std::move(spheres), kMaxCasters);
}

Surface Scene::surface(const Hit& hit) const {
    const Mesh& mesh = description_.meshes[hit.mesh];
    const Triangle& t = mesh.triangles[hit.triangle];
    const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    Surface s;
    s.mesh = hit.mesh;
    s.triangle = hit.triangle;
    s.u = hit.u;
    s.v = hit.v;
    // By barycentric weights: closer to the triangle than the point at distance t along the ray.
    s.position = (1 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
    s.ng = glm::normalize(glm::cross(b - a, c - a));
    s.ns = vertexNormal(s);
    s.epsilon = surfaceEpsilon(largestCoordinates(a, b, c), hit.t);
    const Material& m = material(s);
    if (m.normalTexture) s.ns = mappedNormal(s, s.ns, m.normalTexture, m.normalScale);
    return s;
}

void Scene::prefetchVertices(const Hit& hit) const {
    const Mesh& mesh = description_.meshes[hit.mesh];
    for (const uint32_t vertex : mesh.triangles[hit.triangle]) {
        __builtin_prefetch(&mesh.positions[vertex]);
        if (!mesh.normals.empty()) __builtin_prefetch(&mesh.normals[vertex]);
    }
}

Vec3 Scene::vertexNormal(const Surface& s) const {
    const Mesh& mesh = description_.meshes[s.mesh];
    if (mesh.normals.empty()) return s.ng;
    const Vec3 n = interpolated(mesh.normals, mesh.triangles[s.triangle], s.u, s.v);
    const float length = glm::length(n);
    // Normals that cancel out, or that point behind the face, say nothing of this side: the face's own holds.
    return length > 0 && glm::dot(n, s.ng) > 0 ? n / length : s.ng;
}

float Scene::curvature(const Surface& s) const {
    const Mesh& mesh = description_.meshes[s.mesh];
    if (mesh.normals.empty()) return 0;
    const Triangle& t = mesh.triangles[s.triangle];
    float largest = 0;
    for (size_t i = 0; i < 3; ++i) {
        const uint32_t a = t[i], b = t[(i + 1) % 3];
        const Vec3 edge = mesh.positions[b] - mesh.positions[a], turn = mesh.normals[b] - mesh.normals[a];
        const float edge2 = lengthSquared(edge);
        if (edge2 > 0) largest = std::max(largest, lengthSquared(turn) / edge2);
    }
    return std::sqrt(largest);
}

// A normal bent by a normal texture.
Vec3 Scene::mappedNormal(const Surface& s, Vec3 normal, const TextureRef& ref, float scale) const {
    const Mesh& mesh = description_.meshes[s.mesh];
    const TangentFrame frame = tangentFrame(mesh, mesh.triangles[s.triangle], s.u, s.v, normal, ref.texCoord);
    const Vec3 texel = 2.0F * Vec3(sample(s, ref, false)) - Vec3(1);
    const Vec3 n = scale * (texel.x * frame.tangent + texel.y * frame.bitangent) + texel.z * normal;
    const float length = glm::length(n);
    // As for vertex normals: what points behind the face says nothing of this side.
    return length > 0 && glm::dot(n, s.ng) > 0 ? n / length : normal;
}

Vec2 Scene::texCoord(const Surface& s, int set) const {
    const Mesh& mesh = description_.meshes[s.mesh];
    const auto& uvs = mesh.texCoords[set];
    if (uvs.empty()) return Vec2(0);
    return interpolated(uvs, mesh.triangles[s.triangle], s.u, s.v);
}

Rgb Scene::vertexColor(const Surface& s) const {
    const Mesh& mesh = description_.meshes[s.mesh];
    if (mesh.colors.empty()) return Rgb(1);
    return Rgb(interpolated(mesh.colors, mesh.triangles[s.triangle], s.u, s.v));
}

Vec4 Scene::sample(const Surface& s, const TextureRef& ref, bool srgb) const {
    return description_.textures[static_cast<size_t>(ref.texture)].sample(ref.transform(texCoord(s, ref.texCoord)),
                                                                          srgb);
}

Bsdf Scene::bsdf(const Surface& s, float iorFront, float iorBack) const {
    const Material& m = material(s);
    Rgb baseColor = m.baseColor * vertexColor(s);
    if (m.baseColorTexture) baseColor *= Vec3(sample(s, m.baseColorTexture, true));
    if (m.transmission > 0) return transmissiveBsdf(s, baseColor, iorBack / iorFront);

    MetalRoughBsdf b;
    b.baseColor = baseColor;
    metallicRoughness(s, b.metallic, b.roughness);
    b.specular = specular(s);
    const bool bare = !m.hasLayers();
    if (bare && b.metallic == 0 && b.specular == 0) {
        if (isBlack(baseColor)) return BlackBsdf{};
        return DiffuseBsdf{baseColor};
    }
    if (bare && b.metallic == 1 && b.roughness == 0) return MirrorBsdf{baseColor};
    // ior 0 stands for an infinite one (KHR_materials_ior): F0 = 1.
    const float f0 = m.ior == 0 ? 1 : square((m.ior - 1) / (m.ior + 1));
    b.dielectricF0 = glm::min(f0 * specularColor(s), Rgb(1));
    if (bare) return b;
    return layeredBsdf(s, b);
}

Bsdf Scene::transmissiveBsdf(const Surface& s, Rgb baseColor, float eta) const {
    // Interfaces of nearly equal refractive indices are told from smooth ones neither by what is seen through them nor
    // by floats, which do not resolve their half vectors.
    constexpr float kNoInterface = 1e-3F;
    const Material& m = material(s);
    TransmissiveBsdf b;
    b.thin = m.isThinWall();
    b.eta = b.thin ? m.ior : eta;
    b.baseColor = baseColor;
    metallicRoughness(s, b.metallic, b.roughness);
    if (!b.thin && std::fabs(eta - 1) < kNoInterface) b.roughness = 0;
    b.transmission = m.transmission;
    if (m.transmissionTexture) b.transmission *= sample(s, m.transmissionTexture, false).x;
    b.specular = specular(s);
    b.specularColor = specularColor(s);
    const bool clear = b.transmission == 1 && b.metallic == 0 && b.specular == 1 && b.specularColor == Rgb(1);
    if (!clear || b.roughness > 0) return b;
    if (b.thin) return ThinDielectricBsdf{b.eta, baseColor};
    return DielectricBsdf{b.eta, baseColor};
}

void Scene::metallicRoughness(const Surface& s, float& metallic, float& roughness) const {
    const Material& m = material(s);
    metallic = m.metallic;
    roughness = m.roughness;
    if (!m.metallicRoughnessTexture) return;
    const Vec4 texel = sample(s, m.metallicRoughnessTexture, false);
    roughness *= texel.y;
    metallic *= texel.z;
}

float Scene::specular(const Surface& s) const {
    const Material& m = material(s);
    return m.specularTexture ? m.specular * sample(s, m.specularTexture, false).w : m.specular;
}

Rgb Scene::specularColor(const Surface& s) const {
    const Material& m = material(s);
    if (!m.specularColorTexture) return m.specularColor;
    return m.specularColor * Vec3(sample(s, m.specularColorTexture, true));
}

Rgb Scene::emission(const Surface& s, Vec3 leaving) const {
    const int light = meshes_[s.mesh].light;
    if (light < 0) return Rgb(0);
    const auto& area = std::get<AreaLight>(lights_[static_cast<size_t>(light)].shape);
    if (!area.twoSided && glm::dot(s.ng, leaving) <= 0) return Rgb(0);
    return area.radiance(s.triangle, s.u, s.v);
}

std::vector<bool> Scene::lightSelection(const std::vector<std::string>& names) const {
    std::vector<bool> selected(lights_.size(), names.empty());
    for (const std::string& name : names) {
        bool found = false;
        for (size_t i = 0; i < lights_.size(); ++i)
            if (lights_[i].name == name) selected[i] = found = true;
        if (found) continue;
        std::string there;
        for (const Light& light : lights_) there += (there.empty() ? "" : ", ") + light.name;
        throw Error(fmt::format("{}: light \"{}\": does not exist, expected one of: {}", description_.file.string(),
                                name, there.empty() ? "(the scene has no lights)" : there));
    }
    return selected;
}

CameraDescription Scene::camera(const std::string& name) const {
    if (name.empty() && !description_.cameras.empty()) return description_.cameras.front();
    std::string there;
    for (const CameraDescription& camera : description_.cameras) {
        if (camera.name == name) return camera;
        there += (there.empty() ? "" : ", ") + camera.name;
    }
    if (!name.empty())
        throw Error(fmt::format("{}: camera \"{}\": does not exist, expected one of: {}", description_.file.string(),
                                name, there.empty() ? "(the scene has no cameras)" : there));
    // From the front, a little above, far enough to see all of it.
    CameraDescription c;
    c.name = "framing";
    c.yfov = 0.7F;
    c.aspectRatio = 4.0F / 3;
    c.back = glm::normalize(Vec3(0.25F, 0.45F, 1));
    c.right = glm::normalize(glm::cross(Vec3(0, 1, 0), c.back));
    c.up = glm::cross(c.back, c.right);
    c.position = boundingSphere_.centre + c.back * (std::max(boundingSphere_.radius, 1e-6F) / std::sin(0.5F * c.yfov));
    return c;
}

}  // namespace lsde
