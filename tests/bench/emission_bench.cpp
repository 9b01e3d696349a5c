// Light paths of a scene: photons stored a second by one thread, beside the rays that they take alone; the map's file.
//
// usage: bench_emission SCENE.glb [--benchmark_...]
//
// Emissions are those of `lsde emit`, tracing and packing, without the pilot that aims them and without the tree; of
// each class, the rate of photons stored is a counter, and so are the rays. "rays" are those of caustic paths from the
// lights to the first surface that scatters, in the order in which an emission traces them, asked of Embree and nothing
// else: what no emission that traces single rays can exceed. Files go to the system's temporary folder.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "base/error.h"
#include "passes/emission_pilot.h"
#include "passes/emit.h"
#include "passes/scene_source.h"

using namespace lsde;

namespace {

constexpr int kDigits = 18;
constexpr uint64_t kPaths = 1 << kDigits;

double perSecond(double count, const benchmark::State& state) {
    return count * static_cast<double>(state.iterations());
}

void emitting(benchmark::State& state, const Scene& scene, Store store) {
    RunContext run(1);
    double caustic = 0, indirect = 0, rays = 0;
    while (state.KeepRunning()) {
        state.PauseTiming();
        EmitSettings settings;
        settings.photons = kPaths;
        settings.store = store;
        Emission emission(scene, settings, run);
        run.rays = 0;
        state.ResumeTiming();
        emission.trace(0, kPaths, run);
        caustic = static_cast<double>(emission.stored(PhotonClass::Caustic));
        indirect = static_cast<double>(emission.stored(PhotonClass::Indirect));
        rays = static_cast<double>(run.rays);
    }
    const auto rate = benchmark::Counter::kIsRate;
    state.counters["caustic/s"] = benchmark::Counter(perSecond(caustic, state), rate);
    state.counters["indirect/s"] = benchmark::Counter(perSecond(indirect, state), rate);
    state.counters["rays/s"] = benchmark::Counter(perSecond(rays, state), rate);
}

// Paths of the lights up to the first surface that scatters widely, and the photons that they would leave there.
struct CausticRays {
    std::vector<Ray> rays;
    double photons = 0;
};

CausticRays causticRays(const Scene& scene) {
    constexpr uint64_t kSideBySide = 16;  // as LightTracer
    constexpr uint32_t kMostEvents = 64;
    RunContext run(1);
    EmissionSampler sources(scene, scene.lightSelection({}), aimSharesFor(Store::Caustic));
    const DiffuseAim diffuseAim(scene, kPilotDiffuseBoost);
    sources.learn(tryAims({scene, sources, diffuseAim, Store::Caustic}, run.pool).starts);
    const SobolOrder order(kDigits, sources.aimingDimension(), sources.aimingDimension() + 1);
    struct Path {
        Sampler sampler;
        PathState state;
        bool bent = false;
    };
    CausticRays out;
    WalkScratch scratch;
    for (uint64_t first = 0; first < kPaths; first += kSideBySide) {
        std::vector<Path> paths;
        for (uint64_t i = first; i < first + kSideBySide; ++i) {
            Sampler sampler = Sampler::sequence(run.seed, Stage::Emission, order.index(i));
            LightPathStart start;
            if (sources.sample(sampler, start)) paths.push_back({sampler, start.path()});
        }
        for (uint32_t event = 0; event < kMostEvents && !paths.empty(); ++event) {
            for (const Path& path : paths) out.rays.push_back(path.state.ray);
            std::erase_if(paths, [&](Path& path) {
                Vertex v;
                if (!advance(scene, path.state, v, scratch)) return true;
                if (hasDiffuseLobe(v.bsdf)) {
                    out.photons += path.bent ? 1 : 0;
                    return true;
                }
                path.bent = true;
                BsdfSample sample;
                const float uLobe = path.sampler.next();
                return !sampleBsdf(v.bsdf, v.wo, uLobe, path.sampler.next2D(), sample) ||
                       !scatter(v, sample, Quantity::Power, path.state);
            });
        }
    }
    return out;
}

void raysAlone(benchmark::State& state, const Scene& scene) {
    const CausticRays caustic = causticRays(scene);
    while (state.KeepRunning())
        for (const Ray& ray : caustic.rays) {
            Hit hit;
            benchmark::DoNotOptimize(scene.accel().intersect(ray, hit));
        }
    const auto rate = benchmark::Counter::kIsRate;
    state.counters["caustic/s"] = benchmark::Counter(perSecond(caustic.photons, state), rate);
    state.counters["rays/s"] = benchmark::Counter(perSecond(static_cast<double>(caustic.rays.size()), state), rate);
}

// A map of the scene, and a file for it that goes when it goes.
class MapFile {
  public:
    explicit MapFile(const Scene& scene) : path(std::filesystem::temp_directory_path() / "lsde-bench-emission.lsmap") {
        EmitSettings settings;
        settings.photons = 4 * kPaths;
        map = emitPhotons(scene, settings, run);
        write();
    }
    ~MapFile() { std::filesystem::remove(path); }
    MapFile(const MapFile&) = delete;
    MapFile& operator=(const MapFile&) = delete;

    void write() { writePhotonMap(path, map, run); }
    void read() { benchmark::DoNotOptimize(readPhotonMap(path, run)); }

    std::filesystem::path path;
    RunContext run{1};
    PhotonMap map;
};

void file(benchmark::State& state, const Scene& scene, void (MapFile::*action)()) {
    MapFile map(scene);
    while (state.KeepRunning()) (map.*action)();
    state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) *
                            static_cast<int64_t>(std::filesystem::file_size(map.path)));
}

void addBenchmarks(const Scene& scene) {
    const auto add = [](const char* name, auto run) {
        benchmark::RegisterBenchmark(name, run)->Unit(benchmark::kMillisecond);
    };
    for (const Store store : {Store::Caustic, Store::Indirect})
        add(fmt::format("emission/{}", name(store)).c_str(), [&scene, store](auto& s) { emitting(s, scene, store); });
    add("rays", [&scene](auto& s) { raysAlone(s, scene); });
    add("file/write", [&scene](auto& s) { file(s, scene, &MapFile::write); });
    add("file/read", [&scene](auto& s) { file(s, scene, &MapFile::read); });
}

}  // namespace

int main(int argc, char** argv) try {
    benchmark::Initialize(&argc, argv);
    if (argc != 2) {
        fmt::print(stderr, "usage: bench_emission SCENE.glb [--benchmark_...]\n");
        return 2;
    }
    RunContext run(1);
    const std::unique_ptr<Scene> scene = loadScene(argv[1], {}, run);
    addBenchmarks(*scene);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
} catch (const Error& error) {
    fmt::print(stderr, "bench_emission: {}\n", error.what());
    return 1;
}
