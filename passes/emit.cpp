#include "passes/emit.h"

#include <fmt/format.h>

#include <bit>

#include "base/error.h"
#include "passes/emission_pilot.h"

namespace lsde {

namespace {

constexpr uint64_t kPathsPerChunk = 8192;
constexpr uint64_t kPathsPerRound = 64 * kPathsPerChunk;  // between two looks at the interrupt

// Paths [begin, end) in runs for threads, each along blocks as large as there are: paths that follow each other go much
// the same way, and find in the caches what those before them have read.
std::vector<PathRun> runsOf(uint64_t begin, uint64_t end, int firstDimension) {
    std::vector<PathRun> runs;
    while (begin < end) {
        int digits = std::min(SobolOrder::kMostDigits, std::countr_zero(begin));
        digits = std::min(digits, static_cast<int>(std::bit_width(end - begin)) - 1);
        const uint64_t count = uint64_t{1} << digits;
        PathRun run{begin, SobolOrder(digits, firstDimension, firstDimension + 1), 0, 0};
        for (; run.from < count; run.from = run.to) {
            run.to = std::min(run.from + kPathsPerChunk, count);
            runs.push_back(run);
        }
        begin += count;
    }
    return runs;
}

}  // namespace

IndexRange shardRange(uint64_t photons, uint64_t i, uint64_t n) {
    __extension__ using Wide = unsigned __int128;
    const auto at = [&](uint64_t k) { return static_cast<uint64_t>(static_cast<Wide>(photons) * k / n); };
    return {at(i - 1), at(i)};
}

Emission::Emission(const Scene& scene, const EmitSettings& settings, RunContext& run)
    : scene_(scene),
      settings_(settings),
      seed_(run.seed),
      sources_(scene, scene.lightSelection(settings.lights), settings.aim ? aimSharesFor(settings.store) : kNotAimed),
      diffuseAim_(scene, settings.aim ? kPilotDiffuseBoost : 0),
      tracer_{scene_, sources_, diffuseAim_, settings_.store, settings_.maxDepth, seed_},
      ledger_(scene.lights().size(), scene.objects().size()) {
    if (settings_.aim) {
        const AimTrials trials = tryAims(tracer_, run.pool);
        sources_.learn(trials.starts);
        diffuseAim_.learn(trials.afterDiffuse);
    }
    const PilotFindings found = pilotEmission(tracer_, run.pool);
    tracer_.fairPower = found.fairPower;
    dispersion_ = found.dispersion;
    if (settings_.aim) diffuseAim_.setBoost(found.diffuseBoost);
}

void Emission::trace(uint64_t next, uint64_t count, RunContext& run) {
    const std::vector<PathRun> runs = runsOf(next, next + count, sources_.aimingDimension());
    std::vector<LightPaths> results(runs.size());
    run.pool.forEach(runs.size(), [&](size_t i) {
        results[i] = traceLightPaths(tracer_, runs[i]);
        run.rays += results[i].rays;
    });
    for (LightPaths& paths : results) {
        ledger_.merge(paths.ledger);
        for (size_t c = 0; c < kPhotonClasses; ++c)
            photons_[c].insert(photons_[c].end(), paths.photons[c].begin(), paths.photons[c].end());
        paths = {};
    }
    if (!ranges_.empty() && ranges_.back().end == next)
        ranges_.back().end = next + count;
    else if (count > 0)
        ranges_.push_back({next, next + count});
}

PhotonMap Emission::finish(uint64_t total, RunContext& run) {
    PhotonMap map;
    MapHeader& h = map.header;
    h.sceneHash = scene_.hash();
    h.seed = seed_;
    h.totalPaths = total;
    h.maxDepth = settings_.maxDepth;
    h.store = name(settings_.store);
    h.aimed = settings_.aim;
    for (const Light& light : scene_.lights()) h.lights.push_back(light.name);
    h.objects = scene_.objects();
    h.dispersion = dispersion_;
    h.ranges = ranges_;
    h.ledger = ledger_;
    for (const PhotonClass c : {PhotonClass::Caustic, PhotonClass::Indirect, PhotonClass::Direct})
        if (holds(settings_.store, c))
            map.setTree(c, buildPhotonTree(std::move(photons_[static_cast<size_t>(c)]), run.pool));
    return map;
}

PhotonMap emitPhotons(const Scene& scene, const EmitSettings& settings, RunContext& run, bool* interrupted) {
    IndexRange range = settings.range;
    if (range.end == 0) range = {0, settings.photons};
    Emission emission(scene, settings, run);
    {
        const PhaseTimer timer(run, "emit");
        for (uint64_t at = range.begin; at < range.end; at += kPathsPerRound) {
            if (run.interrupted()) {
                if (interrupted == nullptr) run.checkInterrupt();
                *interrupted = true;
                break;
            }
            emission.trace(at, std::min(kPathsPerRound, range.end - at), run);
            run.progress("emit", static_cast<double>(std::min(at + kPathsPerRound, range.end) - range.begin) /
                                     static_cast<double>(range.end - range.begin));
        }
    }
    const PhaseTimer timer(run, "build");
    return emission.finish(settings.photons, run);
}

}  // namespace lsde
