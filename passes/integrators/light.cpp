// Light tracing (Arvo 1986; Dutre et al. 1993): light paths, each non-specular vertex connected to the camera. Splats
// are summed in fixed point, so that the picture does not depend on the order of the threads.
#include <array>
#include <cmath>
#include <mutex>

#include "base/error.h"
#include "passes/integrators/registry.h"
#include "transport/emission.h"

namespace lsde {

namespace {

constexpr uint64_t kLightPathsPerChunk = 16384;
constexpr int kLongestPath = 1000;  // events; Russian roulette ends paths long before

// A splat's place and value, kept until the chunk's end.
struct Splat {
    uint32_t pixel;
    int layer;
    Rgb value;
};

class LightIntegrator : public Integrator {
  public:
    explicit LightIntegrator(const IntegratorInput& input)
        : scene_(input.scene),
          camera_(input.camera),
          layers_(input.layers),
          seed_(input.seed),
          sources_(input.scene, input.lights, kAimedSeen),
          pixels_(static_cast<uint64_t>(camera_.filmWidth()) * static_cast<uint64_t>(camera_.filmHeight())),
          sums_(static_cast<size_t>(1 + layers_.paths()) * pixels_) {}

    void render(double begin, double end, RunContext& run) override {
        const uint64_t first = pathsOf(begin), last = pathsOf(end);
        std::mutex mutex;
        run.pool.forEach((last - first + kLightPathsPerChunk - 1) / kLightPathsPerChunk, [&](size_t chunk) {
            run.checkInterrupt();
            Tracer tracer{*this, {}, {}, {}, 0};
            const uint64_t from = first + chunk * kLightPathsPerChunk, to = std::min(last, from + kLightPathsPerChunk);
            for (uint64_t path = from; path < to; ++path) tracer.trace(path);
            const std::scoped_lock lock(mutex);
            for (const Splat& s : tracer.splats)
                sums_[static_cast<size_t>(s.layer) * pixels_ + s.pixel] += FixedRgb(s.value);
            run.rays += tracer.scratch.rays;
            notFinite_ += tracer.notFinite;
        });
    }

    RgbImage develop(int layer, double samples) const override {
        RgbImage image(camera_.filmWidth(), camera_.filmHeight());
        if (layer > layers_.paths()) return image;  // albedo, normal, depth: nothing is seen from the light
        const double scale = 1 / static_cast<double>(pathsOf(samples));
        for (size_t p = 0; p < pixels_; ++p)
            for (int c = 0; c < 3; ++c)
                image.pixels[p][c] =
                    static_cast<float>(sums_[static_cast<size_t>(layer) * pixels_ + p].toDouble(c) * scale);
        return image;
    }
    uint64_t notFinite() const override { return notFinite_; }

  private:
    uint64_t pathsOf(double samples) const {
        return static_cast<uint64_t>(std::ceil(samples * static_cast<double>(pixels_)));
    }

    struct Tracer {
        const LightIntegrator& self;
        WalkScratch scratch;
        std::vector<Splat> splats;
        Vertex v;
        uint64_t notFinite = 0;

        void trace(uint64_t index) {
            Sampler sampler = Sampler::sequence(self.seed_, Stage::LightTracer, index);
            LightPathStart start;
            if (!self.sources_.sample(sampler, start)) return;
            PathState path = start.path();
            LightPathState state = self.layers_.filter().light();
            for (int depth = 0; depth < kLongestPath && advance(self.scene_, path, v, scratch); ++depth) {
                const Rgb arriving = path.throughput;
                const Vec2 lens = self.camera_.description().kind == CameraKind::ThinLens ? sampler.next2D() : Vec2(0);
                connect(path.rgbAt(v), state, lens);
                BsdfSample sample;
                const float uLobe = sampler.next();
                if (!sampleBsdf(v.bsdf, v.wo, uLobe, sampler.next2D(), sample)) return;
                if (!scatter(v, sample, Quantity::Power, path)) return;
                self.layers_.filter().append(state, sample.event);
                if (!self.layers_.counts(self.layers_.filter().alive(state))) return;
                const float keep = std::min(1.0F, maxComponent(path.throughput) / maxComponent(arriving));
                if (keep < 1) {
                    if (sampler.next() >= keep) return;
                    path.throughput /= keep;
                }
            }
        }

        // The vertex as seen by the camera: power times f cos times the camera's importance.
        void connect(Rgb power, const LightPathState& state, Vec2 lens) {
            if (!hasDiffuseLobe(v.bsdf) && !hasGlossyLobe(v.bsdf)) return;
            const auto c = self.camera_.connect(v.surface.position, lens);
            if (!c) return;
            const Vec3 wi = v.frame.toLocal(c->direction);
            const float wiNg = glm::dot(c->direction, v.surface.ng), woNg = glm::dot(v.woWorld, v.surface.ng);
            if (wiNg * wi.z <= 0 || woNg * v.wo.z <= 0) return;
            const BsdfEval f = evalBsdf(v.bsdf, v.wo, wi);
            if (isBlack(f.diffuse.f) && isBlack(f.glossy.f)) return;
            const Visibility visible = visibility(self.scene_, v, c->direction, c->distance, scratch);
            if (isBlack(visible.transmittance)) return;
            // Veach 1997, section 5.3: the cosine is that of the geometric normal, |wo.Ns| / |wo.Ng| corrects the
            // light's side.
            const float geometry = std::fabs(wiNg) * std::fabs(v.wo.z / woNg) * c->importance;
            const Rgb base = power * visible.transmittance * geometry;
            const int x = static_cast<int>(c->pixel.x) - self.camera_.filmX();
            const int y = static_cast<int>(c->pixel.y) - self.camera_.filmY();
            if (x < 0 || y < 0 || x >= self.camera_.filmWidth() || y >= self.camera_.filmHeight()) return;
            const auto pixel = static_cast<uint32_t>(y * self.camera_.filmWidth() + x);
            splat(pixel, base * f.diffuse.f, Event::Diffuse, state, visible.straightPassages);
            splat(pixel, base * f.glossy.f, Event::Glossy, state, visible.straightPassages);
        }

        void splat(uint32_t pixel, Rgb value, Event event, const LightPathState& state, int straightPassages) {
            if (isBlack(value)) return;
            EyePathState eye = self.layers_.filter().eye();
            for (int i = 0; i < straightPassages; ++i) self.layers_.filter().prepend(eye, Event::Specular);
            self.layers_.filter().prepend(eye, event);
            SampleSums sums;
            sums.contribute(self.layers_, value, state, eye);
            notFinite += sums.notFinite;
            for (int layer = 0; layer <= self.layers_.paths(); ++layer)
                if (!isBlack(sums.layer[static_cast<size_t>(layer)]))
                    splats.push_back({pixel, layer, sums.layer[static_cast<size_t>(layer)]});
        }
    };

    const Scene& scene_;
    const Camera& camera_;
    const RenderLayers& layers_;
    uint64_t seed_;
    EmissionSampler sources_;
    uint64_t pixels_;
    std::vector<FixedRgb> sums_;  // [layer][pixel]
    uint64_t notFinite_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> makeLightIntegrator(const IntegratorInput& input) {
    return std::make_unique<LightIntegrator>(input);
}

}  // namespace lsde
