// What is found out before photons are emitted, by light paths whose photons are discarded.
//
// All of it is a function of scene, settings and seed: every shard of an emission finds the same.
#pragma once

#include "passes/light_tracer.h"

namespace lsde {

// The first `paths` light paths of the pilot's stage, a multiple of 512, in chunks.
std::vector<LightPaths> tracePilot(LightTracerInput input, uint64_t paths, ThreadPool& pool);

// Where within the parts that it aims at a light's paths are worth most, and where in the cones of casters those that
// leave a diffuse surface: a path's worth is the power of the photons that it leaves, each over the root of the
// irradiance where it lands. Where light is concentrated there are photons enough; that they thin out there gives the
// dim surroundings more.
struct AimTrials {
    std::vector<AimTrial> starts;
    std::vector<DiffuseAim::Trial> afterDiffuse;
};
AimTrials tryAims(LightTracerInput input, ThreadPool& pool);

struct PilotFindings {
    float fairPower = 0;     // W: light that met a D then takes as many rays as its share is
    float diffuseBoost = 0;  // of directions towards casters from diffuse surfaces: more where those of the lobe escape
    std::array<Dispersion, kPhotonClasses> dispersion;  // of what is stored
};
PilotFindings pilotEmission(LightTracerInput input, ThreadPool& pool);
inline constexpr float kPilotDiffuseBoost = 4;

}  // namespace lsde
