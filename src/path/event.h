// What can happen to light at a surface, in two alphabets: letters, which users filter by, and vertex classes, which
// say who owns a path (path/ownership.h).
#pragma once

#include <cstdint>

namespace lsde {

// Letters of a path, light first. An emitter is L, the eye E. Two bits each in a PathCode.
enum class Event : uint8_t {
    Diffuse = 0,   // D
    Glossy = 1,    // G: non-delta and not diffuse; matched by D in an expression that names no G
    Specular = 2,  // S: delta reflection or refraction, or straight passage through a smooth thin wall
};
inline constexpr int kEventCount = 3;

// Classes of a scattering event, by lobe (never by technique).
enum class VertexClass : uint8_t {
    Diffuse,   // D: non-delta, wide
    Glossy,    // G: non-delta with a roughness below kGlossyRoughness
    Bend,      // B: delta, bends light (mirror, refraction, reflection at a thin wall)
    Straight,  // T: straight passage; tints, owns nothing
};

// A lobe with a roughness (the glTF parameter, not its square) below this is narrow enough for photons to pass on.
inline constexpr float kGlossyRoughness = 0.25F;

}  // namespace lsde
