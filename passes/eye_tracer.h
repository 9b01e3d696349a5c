// Paths from the camera: direct light, specular recursion with splitting, photon gathers where the map owns the light,
// continuation elsewhere. Without photons the same walk is a path tracer. Who owns a path: path/ownership.h.
#pragma once

#include <vector>

#include "passes/gather.h"
#include "passes/layers.h"
#include "passes/sample_plan.h"
#include "path/ownership.h"
#include "sampling/sampler.h"
#include "transport/direct_light.h"

namespace lsde {

struct EyeSettings {
    Stage stage = Stage::Camera;
    int splits = 12;                  // most interfaces split after every non-specular vertex
    float splitThreshold = 5e-4F;     // of the pixel: least throughput of a branch
    int indirectBranches = 1;         // directions in which a path goes on from its first vertex without delta lobes
    float rouletteThreshold = 0.02F;  // throughput below which Russian roulette may end a path
    int freeDepth = 24;               // events after which it may end any
    int maxDepth = 0;                 // events; 0: no limit
};

struct SampleSpan {
    uint64_t first = 0;         // number of a pixel's first sample
    double begin = 0, end = 0;  // samples a pixel on average, since the first
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

    // Samples of every pixel of the crop that the plan adds between the means `begin` and `end`, in tiles over the
    // pool's threads; their numbers start at `first`.
    void render(Film& film, std::vector<SampleStatistics>& statistics, const SamplePlan& plan, const SampleSpan& span,
                RunContext& run, EyeCounters& counters) const;

  private:
    void samplePixel(int x, int y, uint64_t index, int lightSamples, EyeScratch& scratch) const;
    void follow(EyePath& path, EyeScratch& scratch) const;
    void recordFirst(const Vertex& v, SampleSums& sums) const;
    void addEmission(const Vertex& v, const EyePath& path, EyeScratch& scratch) const;
    void addBackground(const EyePath& path, EyeScratch& scratch) const;
    // pdfW: gives the density with which light sampling at the last vertex would have drawn what is seen.
    template <typename PdfW>
    void addEmitter(Rgb radiance, const PdfW& pdfW, const EyePath& path, EyeScratch& scratch) const;
    void addDirect(const Vertex& v, EyePath& path, EyeScratch& scratch) const;
    bool indirectFromMap(const Vertex& v) const;
    void addPhotons(const Vertex& v, const EyePath& path, EyeScratch& scratch) const;
    void addGathered(const ClassGather& from, const PhotonGatherQuery& query, const Vertex& v, const EyePath& path,
                     EyeScratch& scratch) const;
    bool split(const Vertex& v, EyePath& path, EyeScratch& scratch) const;
    bool bounce(const Vertex& v, EyePath& path, EyeScratch& scratch) const;
    bool passStraight(const Vertex& v, EyePath& path) const;
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
