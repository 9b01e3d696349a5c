// Path tracing and multi-pass photon mapping: one walk from the eye, with and without a map.
#include "passes/eye_tracer.h"
#include "passes/integrators/registry.h"

namespace lsde {

namespace {

class EyeIntegrator : public Integrator {
  public:
    EyeIntegrator(const IntegratorInput& input, bool photons)
        : lights_(input.scene, input.lights),
          film_(input.camera.filmWidth(), input.camera.filmHeight(), input.layers.filmLayers()),
          tracer_(input.scene, input.camera, lights_, input.layers, photons ? input.photons : nullptr,
                  settings(photons), input.seed) {}

    void render(uint64_t begin, uint64_t end, RunContext& run) override {
        EyeCounters counters;
        tracer_.render(film_, begin, end, run, counters);
        run.rays += counters.rays;
        notFinite_ += counters.notFinite;
    }
    RgbImage develop(int layer, uint64_t samples) const override {
        return film_.develop(layer, static_cast<double>(samples));
    }
    uint64_t notFinite() const override { return notFinite_; }

  private:
    static EyeSettings settings(bool photons) {
        EyeSettings s;
        s.stage = photons ? Stage::Camera : Stage::Reference;
        if (photons) s.indirectBranches = 2;
        return s;
    }

    LightSampler lights_;
    Film film_;
    EyeTracer tracer_;
    uint64_t notFinite_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> makeEyeIntegrator(const IntegratorInput& input, bool photons) {
    return std::make_unique<EyeIntegrator>(input, photons);
}

}  // namespace lsde
