#include "passes/light_effort.h"

#include <array>

#include "passes/int_range.h"
#include "sampling/strata.h"
#include "transport/direct_light.h"

namespace lsde {

namespace {

constexpr int kBlock = 4;       // pixels
constexpr uint32_t kTried = 4;  // light samples of a block
constexpr int kMostBends = 8;   // of a path before it arrives where it is lit
// Relative variance of a single light sample from which on many are taken. Least error on a penumbra and on a box's
// walls at equal time: a third or three times as much costs up to 10%, and 64 samples beyond 0.3 as much as they gain.
constexpr float kNoisy = 0.02F;

// The variance of one light sample in a block, and the square of the mean that it is about.
struct Spread {
    float variance = 0, meanSquared = 0;

    Spread& operator+=(const Spread& other) {
        variance += other.variance;
        meanSquared += other.meanSquared;
        return *this;
    }
};

// Through mirrors and glass, by one lobe of each, to the first surface that scatters the lights' light.
bool arriveLit(const Scene& scene, PathState& path, Sampler& sampler, Vertex& v, WalkScratch& scratch) {
    for (int bends = 0; bends <= kMostBends; ++bends) {
        if (!advance(scene, path, v, scratch)) return false;
        if (hasDiffuseLobe(v.bsdf) || hasGlossyLobe(v.bsdf)) return true;
        BsdfSample sample;
        const float uLobe = sampler.next();
        if (!sampleBsdf(v.bsdf, v.wo, uLobe, sampler.next2D(), sample)) return false;
        if (!scatter(v, sample, Quantity::Radiance, path)) return false;
    }
    return false;
}

Spread spreadOf(const std::array<float, kTried>& light) {
    float mean = 0, variance = 0;
    for (const float l : light) mean += l / kTried;
    for (const float l : light) variance += square(l - mean) / (kTried - 1);
    return {variance, square(mean)};
}

// Paths that no picture holds.
class LightTrials {
  public:
    LightTrials(const Scene& scene, const Camera& camera, const LightSampler& lights, uint64_t seed)
        : scene_(scene),
          camera_(camera),
          lights_(lights),
          seed_(seed),
          cameraMedia_(scene.mediaAt(camera.description().position)) {}

    // x, y: number of the block in the picture.
    Spread at(int x, int y, WalkScratch& scratch) const {
        Sampler sampler =
            Sampler::pixel(seed_, Stage::LightTrials, static_cast<uint32_t>(x), static_cast<uint32_t>(y), 0);
        const Vec2 pixel = static_cast<float>(kBlock) * (Vec2(x, y) + sampler.next2D());
        PathState path;
        path.ray = camera_.ray(pixel, sampler.next2D()).ray;
        path.media = cameraMedia_;
        path.reserved = reserveWavelength(scene_, sampler);
        Vertex v;
        if (!arriveLit(scene_, path, sampler, v, scratch)) return {};
        const LightChoice choice = lights_.at(litPlace(v));
        const Vec2 on = sampler.next2D();
        const LightNumbers u{sampler.next(), on};
        std::array<float, kTried> light;
        for (uint32_t i = 0; i < kTried; ++i) {
            const LightNumbers each = lightStratum(u, i, kTried);
            const DirectLight d = sampleDirectLight(scene_, choice, v, {}, each.which, each.on, scratch);
            light[i] = luminance(d.diffuse + d.glossy);
        }
        return spreadOf(light);
    }

  private:
    const Scene& scene_;
    const Camera& camera_;
    const LightSampler& lights_;
    uint64_t seed_;
    MediaStack cameraMedia_;
};

// Blocks of the whole picture that a crop has to do with: those of its pixels, and the ones next to them.
IntRange blocksOf(int film, int filmSize, int size) {
    return {std::max(0, film / kBlock - 1), std::min((size - 1) / kBlock, (film + filmSize - 1) / kBlock + 1)};
}

}  // namespace

std::vector<uint8_t> planLightSamples(const Scene& scene, const Camera& camera, const LightSampler& lights,
                                      RunContext& run) {
    const IntRange columns = blocksOf(camera.filmX(), camera.filmWidth(), camera.width());
    const IntRange rows = blocksOf(camera.filmY(), camera.filmHeight(), camera.height());
    const auto at = [&](int x, int y) {
        return static_cast<size_t>(y - rows.first) * static_cast<size_t>(columns.count()) +
               static_cast<size_t>(x - columns.first);
    };
    const LightTrials trials(scene, camera, lights, run.seed);
    std::vector<Spread> spread(at(columns.first, rows.last + 1));
    run.pool.forEach(static_cast<size_t>(rows.count()), [&](size_t row) {
        const int y = rows.first + static_cast<int>(row);
        WalkScratch scratch;
        for (int x = columns.first; x <= columns.last; ++x) spread[at(x, y)] = trials.at(x, y, scratch);
        run.rays += scratch.rays;
    });
    const auto samplesOf = [&](int blockX, int blockY) {
        Spread sum;
        const IntRange nearColumns = columns.around(blockX, 1), nearRows = rows.around(blockY, 1);
        for (int y = nearRows.first; y <= nearRows.last; ++y)
            for (int x = nearColumns.first; x <= nearColumns.last; ++x) sum += spread[at(x, y)];
        return sum.variance > kNoisy * sum.meanSquared ? kManyLightSamples : kFewLightSamples;
    };
    std::vector<uint8_t> ofBlocks;
    ofBlocks.reserve(spread.size());
    for (int y = rows.first; y <= rows.last; ++y)
        for (int x = columns.first; x <= columns.last; ++x) ofBlocks.push_back(samplesOf(x, y));
    std::vector<uint8_t> ofPixels;
    ofPixels.reserve(static_cast<size_t>(camera.filmWidth()) * static_cast<size_t>(camera.filmHeight()));
    for (int y = camera.filmY(); y < camera.filmY() + camera.filmHeight(); ++y)
        for (int x = camera.filmX(); x < camera.filmX() + camera.filmWidth(); ++x)
            ofPixels.push_back(ofBlocks[at(x / kBlock, y / kBlock)]);
    return ofPixels;
}

}  // namespace lsde
