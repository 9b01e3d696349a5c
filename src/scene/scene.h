// The scene: immutable after construction, asked by every pass.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/ray.h"
#include "base/surface_point.h"
#include "bsdf/bsdf.h"
#include "scene/accel.h"
#include "scene/camera.h"
#include "scene/casters.h"
#include "scene/description.h"
#include "scene/light.h"
#include "scene/media_stack.h"

namespace lsde {

// A point of a surface that a ray has hit.
struct Surface {
    Vec3 position{0};
    Vec3 ng{0};  // geometric normal, unit, front side
    Vec3 ns{0};  // shading normal, unit, on ng's side
    uint32_t mesh = 0;
    uint32_t triangle = 0;
    float u = 0, v = 0;  // barycentric
    float epsilon = 0;   // m: offset for rays that leave
};

// A mesh as transport sees it.
struct MeshInfo {
    MediumId medium = kOutside;  // of the solid that it bounds; kOutside: it bounds none
    int light = -1;              // index of its area light
    uint32_t object = 0;         // index into Scene::objects()
    float area = 0;              // m2
    bool caster = false;         // has a lobe of class Bend or Glossy, and may cast
    bool receiver = true;        // photons are gathered on it
    bool mayTouch = false;       // a solid that something may lie against: coincident surfaces are looked for
};

class Scene {
  public:
    explicit Scene(SceneDescription description);
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    const SceneDescription& description() const { return description_; }
    const std::string& hash() const { return hash_; }  // geometry, materials, lights, textures; not cameras
    const std::vector<Light>& lights() const { return lights_; }
    // Those of them that lie beyond the scene: what escapes may see them.
    const std::vector<size_t>& infiniteLights() const { return infiniteLights_; }
    const std::vector<Medium>& media() const { return media_; }
    const std::vector<MeshInfo>& meshes() const { return meshes_; }
    const std::vector<std::string>& objects() const { return objects_; }
    const std::vector<Caster>& casters() const { return casters_; }
    const Sphere& boundingSphere() const { return boundingSphere_; }
    bool hasThinWalls() const { return hasThinWalls_; }
    bool disperses() const { return disperses_; }  // the refractive index of some medium varies with the wavelength
    const Accel& accel() const { return accel_; }

    Surface surface(const Hit& hit) const;
    // Has the caches fetch what surface() will read: the triangle, then, when that has come, its vertices.
    void prefetchTriangle(const Hit& hit) const {
        __builtin_prefetch(&description_.meshes[hit.mesh].triangles[hit.triangle]);
    }
    void prefetchVertices(const Hit& hit) const;
    // 1/m: the largest along the edges of the triangle, as its vertices' normals tell.
    float curvature(const Surface& s) const;
    const Material& material(const Surface& s) const {
        return description_.materials[description_.meshes[s.mesh].material];
    }
    // Share of the area about the point that the surface covers (coverage.h): more than 0 wherever a ray met it.
    float coverage(const Surface& s) const {
        return material(s).alphaMode == AlphaMode::Opaque ? 1 : coverageAt(s.mesh, s.triangle, s.u, s.v);
    }
    // Front and back: refractive indices on either side of the interface, where the surface bounds a solid.
    Bsdf bsdf(const Surface& s, float iorFront, float iorBack) const;
    // Radiance emitted into direction `leaving` (unit, away from the surface).
    Rgb emission(const Surface& s, Vec3 leaving) const;
    // The solids around a point, found by the facing of what a ray meets; for paths that start there.
    MediaStack mediaAt(Vec3 p) const;
    // What lies against a solid's surface: hits of other solids and of opaque meshes within `distance` (m) of its
    // point.
    void coincidentSurfaces(const Surface& s, float distance, std::vector<Hit>& out) const;
    // Light indices by name; throws Error naming those there are.
    std::vector<bool> lightSelection(const std::vector<std::string>& names) const;
    // The named camera, the first, or one that frames the scene.
    CameraDescription camera(const std::string& name) const;

  private:
    PartialCoverage partialCoverage() const;
    float coverageAt(uint32_t mesh, uint32_t triangle, float u, float v) const;
    void buildMedia();
    void findTouching();
    void buildLights();
    void buildInfiniteLights();
    void buildCasters();
    void checkNesting() const;
    std::vector<MediumId> solidsAround(Vec3 p) const;  // innermost (left first) to outermost
    Vec2 texCoord(const Surface& s, int set) const;
    Rgb vertexColor(const Surface& s) const;
    Vec4 sample(const Surface& s, const TextureRef& ref, bool srgb) const;
    void metallicRoughness(const Surface& s, float& metallic, float& roughness) const;
    float specular(const Surface& s) const;
    Rgb specularColor(const Surface& s) const;
    Vec3 vertexNormal(const Surface& s) const;  // the shading normal before any texture bends it
    Vec3 mappedNormal(const Surface& s, Vec3 normal, const TextureRef& ref, float scale) const;
    Vec2 anisotropyDirection(const Surface& s, float& strength) const;
    ThinFilm film(const Surface& s) const;
    Sheen sheen(const Surface& s) const;
    Clearcoat clearcoat(const Surface& s) const;
    Bsdf layeredBsdf(const Surface& s, MetalRoughBsdf base) const;
    // eta: refractive index behind the front side over that before it; of no use to thin walls.
    Bsdf transmissiveBsdf(const Surface& s, Rgb baseColor, float eta) const;

    SceneDescription description_;
    Accel accel_;
    std::string hash_;
    std::vector<MeshInfo> meshes_;
    std::vector<std::string> objects_;
    std::vector<Medium> media_;
    std::vector<Light> lights_;
    std::vector<size_t> infiniteLights_;
    std::vector<Caster> casters_;
    Sphere boundingSphere_;
    Bounds bounds_;
    bool hasThinWalls_ = false;
    bool disperses_ = false;
};

// Whether light leaves this material by an event of class Bend or Glossy (path/event.h).
bool hasNarrowLobe(const Material& material);

// XXH3-128 of all that a map depends on, as 32 hexadecimal digits.
std::string hashDescription(const SceneDescription& description);

}  // namespace lsde
