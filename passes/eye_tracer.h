// Paths from the camera: direct light, specular recursion with splitting, photon gathers where the map owns the light,
// continuation elsewhere. Without photons the same walk is a path tracer. Who owns a path: path/ownership.h.
#pragma once

#include <vector>

#include "passes/gather.h"
#include "passes/layers.h"
#include "path/ownership.h"
#include "sampling/sampler.h"
#include "transport/direct_light.h"

namespace lsde {

struct EyeSettings {
    Stage stage = Stage::Camera;
    int splits = 3;                   // interfaces split after every non-specular vertex
    float splitThreshold = 1e-3F;     // of the pixel: least throughput of a branch
    int indirectBranches = 1;         // directions in which a path goes on from its first vertex without delta lobes
    float rouletteThreshold = 0.02F;  // throughput below which Russian roulette may end a path
    int freeDepth = 24;               // events after which it may end any
    int maxDepth = 0;                 // events; 0: no limit
};

struct EyeCounters {
    uint64_t rays = 0;
    uint64_t notFinite = 0;
    uint64_t gathers = 0;
    uint64_t gathered = 0;  // photons
};

struct EyePath;     // one path on its way
struct EyeScratch;  // one thread's state

class EyeTracer {
  public:
    // photons: null for path tracing. All references outlive the tracer.
    EyeTracer(const Scene& scene, const Camera& camera, const LightSampler& lights, const RenderLayers& layers,
              const PhotonGather* photons, const EyeSettings& settings, uint64_t seed);

    // Samples [begin, end) of every pixel of the crop, in tiles over the pool's threads.
    void render(Film& film, uint64_t begin, uint64_t end, RunContext& run, EyeCounters& counters) const;

  private:
    void samplePixel(int x, int y, uint64_t index, EyeScratch& scratch) const;
    void follow(EyePath& path, EyeScratch& scratch) const;
    void recordFirst(const Vertex& v, SampleSums& sums) const;
    void addEmission(const Vertex& v, const EyePath& path, EyeScratch& scratch) const;
    void addDirect(const Vertex& v, EyePath& path, EyeScratch& scratch) const;
    void addPhotons(const Vertex& v, const EyePath& path, EyeScratch& scratch) const;
    bool split(const Vertex& v, EyePath& path, EyeScratch& scratch) const;
    bool bounce(const Vertex& v, EyePath& path, EyeScratch& scratch) const;
    bool step(const Vertex& v, const BsdfSample& sample, EyePath& path) const;

    const Scene& scene_;
    const Camera& camera_;
    const LightSampler& lights_;
    const RenderLayers& layers_;
    const PhotonGather* photons_;
    EyeSettings settings_;
    uint64_t seed_;
    MediaStack cameraMedia_;
};

}  // namespace lsde
