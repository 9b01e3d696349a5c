// Light that arrives at a vertex straight from a source: sampled at the lights, weighted against sampled BSDFs.
#pragma once

#include <vector>

#include "sampling/distribution.h"
#include "sampling/sampler.h"
#include "scene/casters.h"
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
    // A single point or direction: all samples at a vertex are the same.
    bool onePoint() const { return onePoint_; }
    // For walks that end at a Lambertian vertex: the probability with which to look for emitters in a sampled direction
    // all the same. 1 where they may be near and light sampling alone is noisy; 0 where there are none.
    float bsdfSamples(const Vertex& vertex) const;

  private:
    std::vector<Caster> emitters_;  // spheres that hold the lights with an area
    bool onePoint_ = false;
    DiscreteDistribution choice_;  // by power, with a floor for each: no light is starved
};

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

DirectLight sampleDirectLight(const Scene& scene, const LightSampler& lights, const Vertex& vertex,
                              const DirectLightQuery& query, float uLight, Vec2 u, WalkScratch& scratch);

// Density (1/sr) with which sampleDirectLight() at `from` would have drawn the emitting point `hit`, seen at `distance`
// in direction wi.
float directLightPdf(const Scene& scene, const LightSampler& lights, const Surface& hit, Vec3 wi, float distance);

}  // namespace lsde
