// Small scenes built in code: shapes, materials and lights, put together by SceneBuilder.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "scene/scene.h"

namespace lsde::test {

// ---- shapes, counter-clockwise seen from the front

inline Mesh polygonFan(std::vector<Vec3> corners) {
    Mesh m;
    m.positions = std::move(corners);
    for (uint32_t i = 2; i < m.positions.size(); ++i) m.triangles.push_back({0, i - 1, i});
    return m;
}

inline Mesh quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return polygonFan({a, b, c, d}); }

// A horizontal square about `centre`, front up or down.
inline Mesh plate(Vec3 centre, float halfSize, bool up = true) {
    const Vec3 x(halfSize, 0, 0), z(0, 0, up ? halfSize : -halfSize);
    return quad(centre - x + z, centre + x + z, centre + x - z, centre - x - z);
}

// Fronts outside. Vertices are shared, normals flat.
inline Mesh box(Vec3 lo, Vec3 hi) {
    Mesh m;
    for (int i = 0; i < 8; ++i)
        m.positions.emplace_back((i & 1) != 0 ? hi.x : lo.x, (i & 2) != 0 ? hi.y : lo.y, (i & 4) != 0 ? hi.z : lo.z);
    m.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return m;
}

inline Mesh flipped(Mesh m) {
    for (Triangle& t : m.triangles) std::swap(t[1], t[2]);
    for (Vec3& n : m.normals) n = -n;
    return m;
}

inline void append(Mesh& to, const Mesh& part) {
    const auto first = static_cast<uint32_t>(to.positions.size());
    to.positions.insert(to.positions.end(), part.positions.begin(), part.positions.end());
    to.normals.insert(to.normals.end(), part.normals.begin(), part.normals.end());
    for (const Triangle& t : part.triangles) to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

inline Mesh joined(Mesh a, const Mesh& b) {
    append(a, b);
    return a;
}

enum class Shading { Flat, Smooth };

// An octahedron, each face cut in four `level` times and put on the sphere.
inline Mesh sphere(Vec3 centre, float radius, int level, Shading shading = Shading::Smooth) {
    std::vector<Vec3> unit = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<Triangle> faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                   {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int l = 0; l < level; ++l) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [at, added] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(unit.size()));
            if (added) unit.push_back(glm::normalize(unit[a] + unit[b]));
            return at->second;
        };
        std::vector<Triangle> finer;
        for (const Triangle& t : faces) {
            const uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
            finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    Mesh m;
    for (const Vec3 n : unit) m.positions.push_back(centre + radius * n);
    if (shading == Shading::Smooth) m.normals = unit;
    m.triangles = std::move(faces);
    return m;
}

// ---- materials

inline Material lambert(Rgb albedo) {
    Material m;
    m.baseColor = albedo;
    m.metallic = 0;
    m.specular = 0;
    return m;
}

inline Material metal(float roughness, Rgb f0 = Rgb(1)) {
    Material m;
    m.baseColor = f0;
    m.roughness = roughness;
    return m;
}

inline Material glass(float ior, VolumeProperties volume = {}) {
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.ior = ior;
    m.transmission = 1;
    m.volume = volume;
    return m;
}

inline Material thinWall(Rgb tint, float ior = 1.5F) {
    Material m = glass(ior);
    m.baseColor = tint;
    m.volume.reset();
    return m;
}

inline Material emitter(Rgb radiance, bool twoSided = false) {
    Material m = lambert(Rgb(0));
    m.emission = radiance;
    m.doubleSided = twoSided;
    return m;
}

// ---- environments

// Of the same brightness all around but for a bright and a coloured spot, and a texel that is black.
inline RgbImage spottedSky(int width = 16) {
    RgbImage sky(width, width / 2, Rgb(0.5F, 0.6F, 1));
    sky.at(width / 8, width / 8) = Rgb(40, 30, 20);
    sky.at(5 * width / 8, width / 16) = Rgb(0, 4, 0);
    sky.at(width / 2, width / 4) = Rgb(0);
    return sky;
}

// ---- scenes

class SceneBuilder {
  public:
    // A node of its own. The mesh can still be changed through the result, until the next call.
    Mesh& add(Mesh mesh, const Material& material, const std::string& object = "object") {
        mesh.object = object;
        mesh.node = static_cast<uint32_t>(description_.meshes.size());
        mesh.material = static_cast<uint32_t>(description_.materials.size());
        description_.materials.push_back(material);
        description_.meshes.push_back(std::move(mesh));
        return description_.meshes.back();
    }
    TextureRef texture(Texture t) {
        description_.textures.push_back(std::move(t));
        TextureRef ref;
        ref.texture = static_cast<int>(description_.textures.size()) - 1;
        return ref;
    }
    void point(Vec3 position, Rgb intensity) {
        PunctualLight l;
        l.name = "point";
        l.position = position;
        l.intensity = intensity;
        description_.lights.push_back(l);
    }
    // Down, half of that sideways, nothing up; three times as much towards +X as towards -X.
    void measured(Vec3 position, Rgb intensity) {
        point(position, intensity);
        PunctualLight& l = description_.lights.back();
        l.name = "measured";
        l.kind = PunctualKind::Measured;
        l.direction = {0, -1, 0};
        l.right = {1, 0, 0};
        l.up = {0, 0, -1};
        l.profile = std::make_shared<const IesProfile>(
            "TILT=NONE\n1 1 1 3 3 1 2 0 0 0 1 1 1\n0 90 150\n0 90 180\n1 .75 0 1 .5 0 1 .25 0\n");
    }
    void spot(Vec3 position, Vec3 towards, Rgb intensity, float innerDeg, float outerDeg) {
        point(position, intensity);
        PunctualLight& l = description_.lights.back();
        l.name = "spot";
        l.kind = PunctualKind::Spot;
        l.direction = glm::normalize(towards - position);
        l.innerConeAngle = innerDeg * kPi / 180;
        l.outerConeAngle = outerDeg * kPi / 180;
    }
    void sun(Vec3 direction, Rgb irradiance) {
        point(Vec3(0), irradiance);
        PunctualLight& l = description_.lights.back();
        l.name = "sun";
        l.kind = PunctualKind::Directional;
        l.direction = glm::normalize(direction);
    }
    // Light from all around: a picture of radiance, turned about +Y by `turn` (rad).
    void environment(RgbImage picture, float turn = 0) {
        description_.environment = EnvironmentDescription{"environment", std::move(picture), turn};
    }
    // A disc of light in the sky, seen in direction `towards`.
    void sunDisc(Vec3 towards, float angularRadiusDeg, Rgb radiance) {
        description_.sun = SunDescription{"sun", glm::normalize(towards), angularRadiusDeg * kPi / 180, radiance};
    }
    void camera(Vec3 eye, Vec3 target, float yfovDeg) {
        CameraDescription c;
        c.name = "camera";
        c.yfov = yfovDeg * kPi / 180;
        c.position = eye;
        c.back = glm::normalize(eye - target);
        c.right = glm::normalize(glm::cross(Vec3(0, 1, 0), c.back));
        c.up = glm::cross(c.back, c.right);
        description_.cameras.push_back(c);
    }
    // All positions times `scale`, then moved. Intensities stay: what is compared must be geometry.
    void transform(float scale, Vec3 move) {
        for (Mesh& m : description_.meshes)
            for (Vec3& p : m.positions) p = scale * p + move;
        for (PunctualLight& l : description_.lights) l.position = scale * l.position + move;
    }
    const SceneDescription& description() const { return description_; }
    std::unique_ptr<Scene> build() const { return std::make_unique<Scene>(description_); }

  private:
    SceneDescription description_;
};

inline std::vector<bool> allLights(const Scene& scene) { return std::vector<bool>(scene.lights().size(), true); }

}  // namespace lsde::test
