// Sources of light: emissive meshes, point, spot and directional lights, and those beyond the scene.
//
// Each can be asked two ways: for the light that arrives at a point (direct light), and for a ray that leaves it
// (emission). Powers are of the whole light, in W per channel.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "base/bounds.h"
#include "base/ray.h"
#include "sampling/distribution.h"
#include "scene/description.h"
#include "scene/infinite_light.h"

namespace lsde {

// Light arriving at a point from one sampled direction.
struct LightSample {
    Vec3 wi{0};           // unit, from the point to the light
    float distance = 0;   // m; infinite for a directional or infinite light
    Rgb radiance{0};      // W/(m2 sr); for a delta light irradiance on a plane facing it (pdfW is 1)
    float pdfW = 0;       // 1/sr
    float clearance = 0;  // m before the light at which a shadow ray must end so as not to meet the light itself
};

// Where on a light a path starts: a position (area), a fixed point, or a fixed direction.
struct EmissionPoint {
    Vec3 position{0};
    Vec3 normal{0};     // area lights: of the side that emits
    Rgb radiance{0};    // area lights: W/(m2 sr) there
    float pdfA = 1;     // 1/m2 (area)
    float epsilon = 0;  // m: by how much a ray must leave the surface
};

struct AreaLight {
    const Mesh* mesh = nullptr;
    const Material* material = nullptr;
    const std::vector<Texture>* textures = nullptr;
    DiscreteDistribution triangles;  // by area times mean luminance
    std::vector<float> areas;        // m2
    bool twoSided = false;
    Rgb power{0};
    Bounds bounds;

    AreaLight(const Mesh& mesh, const Material& material, const std::vector<Texture>& textures);
    Rgb radiance(uint32_t triangle, float u, float v) const;  // of what is there, on an emitting side
    Rgb emitted(uint32_t triangle, float u, float v) const;   // radiance times how much is there (coverage.h)
    // Density per area of choosing a point of this triangle.
    float pdfA(uint32_t triangle) const { return triangles.pmf(triangle) / areas[triangle]; }
    // Chooses a triangle as above, then a direction evenly by its solid angle, or a point by area where it is too small
    // for that.
    LightSample sampleToward(Vec3 p, Vec2 u) const;
    // Density (1/sr) of sampleToward for the point of the triangle that lies at `distance` (m) in direction wi (unit).
    float pdfToward(Vec3 p, uint32_t triangle, Vec3 wi, float distance) const;
    EmissionPoint samplePoint(Vec2 u, float uSide) const;
};

struct PointLight {
    Vec3 position{0};
    Rgb intensity{0};  // W/sr
    // Spot: the falloff of KHR_lights_punctual between two cones, by 1 - cos of their half angles, which keeps narrow
    // ones exact; 2 for a point light.
    Vec3 axis{0, 0, -1};
    float oneMinusCosInner = 2, oneMinusCosOuter = 2;
    // Measured: the falloff, in the frame of right, up and -axis, unit.
    std::shared_ptr<const IesProfile> profile;
    Vec3 right{1, 0, 0}, up{0, 1, 0};

    bool isSpot() const { return oneMinusCosOuter < 2; }
    float falloff(Vec3 direction) const;  // of light leaving in this direction, in [0,1]
    Rgb power() const;
    LightSample sampleToward(Vec3 p) const;
};

struct DirectionalLight {
    Vec3 direction{0, 0, -1};  // the way the light shines
    Rgb irradiance{0};         // W/m2 on a plane facing it
    Sphere scene;              // its power is what passes through this sphere's disc

    Rgb power() const { return irradiance * (kPi * square(scene.radius)); }
};

struct Light {
    std::string name;
    std::variant<AreaLight, PointLight, DirectionalLight, InfiniteLight> shape;

    Rgb power() const;
    bool isDelta() const {
        return std::holds_alternative<PointLight>(shape) || std::holds_alternative<DirectionalLight>(shape);
    }
    // False (and nothing arrives) where the light cannot reach p.
    bool sampleToward(Vec3 p, Vec2 u, LightSample& sample) const;
};

}  // namespace lsde
