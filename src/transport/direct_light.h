// Light that arrives at a vertex straight from a source: sampled at the lights, weighted against sampled BSDFs.
#pragma once

#include <vector>

#include "sampling/distribution.h"
#include "sampling/sampler.h"
#include "transport/walk.h"

namespace lsde {

// Which lights take part, and how often each is chosen.
class LightSampler {
  public:
    // selected[i]: light i takes part. Throws Error if none does.
    LightSampler(const Scene& scene, const std::vector<bool>& selected);

    size_t choose(float& u) const { return choice_.sample(u); }
    float probability(size_t light) const { return choice_.pmf(light); }
    bool selected(size_t light) const { return choice_.pmf(light) > 0; }

  private:
    DiscreteDistribution choice_;  // by power, with a floor for each: no light is starved
};

// One sampled light at a vertex: radiance towards wo by each lobe, MIS-weighted where the BSDF may hit the light too.
struct DirectLight {
    Rgb diffuse{0}, glossy{0};  // W/(m2 sr)
    int straightPassages = 0;
};

struct DirectLightQuery {
    bool diffuse = true, glossy = true;  // lobes that sample light (path/ownership.h)
    bool mis = true;  // the walk goes on from here by BSDF sampling and counts hits with their weight
};

DirectLight sampleDirectLight(const Scene& scene, const LightSampler& lights, const Vertex& vertex,
                              const DirectLightQuery& query, float uLight, Vec2 u, WalkScratch& scratch);

// Density (1/sr) with which sampleDirectLight() at `from` would have drawn the emitting point `hit`, seen at `distance`
// in direction wi.
float directLightPdf(const Scene& scene, const LightSampler& lights, const Surface& hit, Vec3 wi, float distance);

}  // namespace lsde
