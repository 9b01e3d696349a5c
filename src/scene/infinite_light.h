// Light from beyond the scene: an environment, or the sun's disc.
#pragma once

#include <variant>

#include "base/bounds.h"
#include "scene/environment_map.h"

namespace lsde {

// Even radiance from within a small cone.
struct SunDisc {
    Vec3 direction{0, 1, 0};  // unit, to its centre
    float oneMinusCos = 0;    // of its angular radius
    Rgb radianceOfDisc{0};    // W/(m2 sr)

    Rgb radiance(Vec3 towards) const;
    Rgb integral() const { return radianceOfDisc * (2 * kPi * oneMinusCos); }
    Vec3 sample(Vec2 u, float& pdfW) const;
    float pdfW(Vec3 towards) const;
};

// Directions are unit and point from the scene to the light.
struct InfiniteLight {
    std::variant<EnvironmentMap, SunDisc> source;
    Sphere scene;  // its power is what passes through this sphere

    Rgb radiance(Vec3 towards) const;
    Rgb integral() const;  // of the radiance over all directions, W/m2
    Rgb power() const { return integral() * (kPi * square(scene.radius)); }
    Vec3 sample(Vec2 u, float& pdfW) const;
    float pdfW(Vec3 towards) const;  // 1/sr

    // Shines from all around, so that no place turns away from it.
    bool surrounds() const { return std::holds_alternative<EnvironmentMap>(source); }
};

}  // namespace lsde
