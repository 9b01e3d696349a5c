// Light that arrives at a vertex straight from a source: sampled at the lights, weighted against sampled BSDFs.
#pragma once

#include "transport/light_sampler.h"
#include "transport/walk.h"

namespace lsde {

// One sampled light at a vertex: radiance towards wo by each lobe, MIS-weighted where the BSDF may hit the light too.
struct DirectLight {
    Rgb diffuse{0}, glossy{0};  // W/(m2 sr)
    int straightPassages = 0;
};

struct DirectLightQuery {
    bool diffuse = true, glossy = true;  // lobes that sample light (path/ownership.h)
    // How many directions the walk goes on from here by BSDF sampling, counting hits with their weight: 1, or the
    // probability that it does so at all.
    float bsdfSamples = 1;
};

// lights: the choice at the vertex.
DirectLight sampleDirectLight(const Scene& scene, const LightChoice& lights, const Vertex& vertex,
                              const DirectLightQuery& query, float uLight, Vec2 u, WalkScratch& scratch);

// Density (1/sr) with which sampleDirectLight() by this choice would have drawn the emitting point `hit`, seen from the
// vertex at `from` at `distance` in direction wi.
float directLightPdf(const Scene& scene, const LightChoice& lights, Vec3 from, const Surface& hit, Vec3 wi,
                     float distance);
// The same of an infinite light.
float directLightPdf(const Scene& scene, const LightChoice& lights, size_t light, Vec3 wi);

}  // namespace lsde
