// Path tracing and multi-pass photon mapping: one walk from the eye, with and without a map.
#include <optional>

#include "passes/eye_tracer.h"
#include "passes/integrators/registry.h"
#include "passes/light_effort.h"
#include "passes/sample_plan.h"

namespace lsde {

namespace {

class EyeIntegrator : public Integrator {
  public:
    EyeIntegrator(const IntegratorInput& input, bool photons)
        : scene_(input.scene),
          camera_(input.camera),
          lights_(input.scene, input.lights),
          film_(input.camera.filmWidth(), input.camera.filmHeight(), input.layers.filmLayers()),
          plan_(film_.width(), film_.height()),
          statistics_(static_cast<size_t>(film_.width()) * static_cast<size_t>(film_.height())),
          adaptive_(photons),
          tracer_(input.scene, input.camera, lights_, input.layers, photons ? input.photons : nullptr,
                  settings(photons), input.seed) {}

    void render(double begin, double end, RunContext& run) override {
        if (!first_) {
            first_ = static_cast<uint64_t>(begin);
            if (adaptive_ && !lights_.onePoint()) plan_.sampleLights(planLightSamples(scene_, camera_, lights_, run));
        }
        const auto uniform = static_cast<double>(*first_ + SamplePlan::kUniform);
        if (adaptive_ && begin < uniform && end >= uniform) {
            sample(begin, uniform, run);
            plan_.adapt(statistics_);
            begin = uniform;
        }
        if (begin < end) sample(begin, end, run);
    }
    RgbImage develop(int layer, double samples) const override { return film_.develop(layer, counts(samples)); }
    std::optional<PictureError> error(double samples) const override {
        // What a pixel that nobody saw would show is not known.
        if (samples < 1) return std::nullopt;
        return pictureError(statistics_, counts(samples), film_.width());
    }
    uint64_t notFinite() const override { return notFinite_; }

  private:
    std::vector<double> counts(double samples) const {
        std::vector<double> counts(statistics_.size());
        for (size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<double>(plan_.count(i, samples));
        return counts;
    }
    void sample(double begin, double end, RunContext& run) {
        EyeCounters counters;
        const auto first = static_cast<double>(*first_);
        tracer_.render(film_, statistics_, plan_, {*first_, begin - first, end - first}, run, counters);
        run.rays += counters.rays;
        notFinite_ += counters.notFinite;
    }
    static EyeSettings settings(bool photons) {
        EyeSettings s;
        s.stage = photons ? Stage::Camera : Stage::Reference;
        if (!photons) return s;
        s.indirectBranches = 2;
        // What a gather or a lamp adds may be a thousand times the pixel: seen by chance alone it would be a bright
        // dot.
        s.rouletteThreshold = s.splitThreshold = 2e-4F;
        return s;
    }

    const Scene& scene_;
    const Camera& camera_;
    LightSampler lights_;
    Film film_;
    SamplePlan plan_;
    std::vector<SampleStatistics> statistics_;
    bool adaptive_;                  // the path tracer, as ground truth, takes the same number everywhere
    std::optional<uint64_t> first_;  // number of the first sample
    EyeTracer tracer_;
    uint64_t notFinite_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> makeEyeIntegrator(const IntegratorInput& input, bool photons) {
    return std::make_unique<EyeIntegrator>(input, photons);
}

}  // namespace lsde
