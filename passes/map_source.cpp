#include "passes/map_source.h"

#include <fmt/format.h>

#include "base/error.h"
#include "passes/cache.h"

namespace lsde {

namespace {

constexpr uint64_t kFirstRound = 1 << 16;

void checkMapFits(const Scene& scene, const PhotonMap& map, const MapRequest& request, RunContext& run) {
    const MapHeader& h = map.header;
    if (h.sceneHash != scene.hash()) {
        const std::string what =
            fmt::format("{}: map of another scene: hash {}, expected {} ({})", request.file.string(), h.sceneHash,
                        scene.hash(), scene.description().file.string());
        if (!request.otherScene) throw Error(what + "; --other-scene takes it all the same");
        run.warn(what + ", taken because of --other-scene");
    }
    if (h.emittedPaths() != h.totalPaths)
        run.warn(fmt::format("{}: holds {} of {} light paths (a shard or an interrupted emission); used as it is",
                             request.file.string(), h.emittedPaths(), h.totalPaths));
}

std::optional<PhotonMap> findInCache(const std::filesystem::path& file, const Scene& scene, const EmitSettings& emit,
                                     RunContext& run) {
    if (!std::filesystem::exists(file)) return {};
    try {
        const PhaseTimer timer(run, "load map");
        PhotonMap map = readPhotonMap(file, run);
        if (map.header.sceneHash != scene.hash() || map.header.emittedPaths() != emit.photons) return {};
        run.info(fmt::format("map found in the cache: {}", file.string()));
        return map;
    } catch (const Error& e) {
        run.warn(fmt::format("cached map is not used: {}", e.what()));
        return {};
    }
}

bool keepInCache(const std::filesystem::path& file, const PhotonMap& map, RunContext& run) {
    try {
        std::filesystem::create_directories(file.parent_path());
        writePhotonMap(file, map, run);
        run.info(fmt::format("map kept in the cache: {}", file.string()));
        return true;
    } catch (const std::exception& e) {
        run.warn(fmt::format("the map is not kept in the cache: {}", e.what()));
        return false;
    }
}

}  // namespace

SourcedMap mapByCount(const Scene& scene, const MapRequest& request, RunContext& run) {
    if (!request.file.empty()) {
        const PhaseTimer timer(run, "load map");
        SourcedMap out{readPhotonMap(request.file, run), {}};
        checkMapFits(scene, out.map, request, run);
        return out;
    }
    const auto cached = request.cache ? cachedMapPath(scene, request.emit, run.seed) : std::nullopt;
    if (cached)
        if (auto map = findInCache(*cached, scene, request.emit, run)) return {std::move(*map), *cached};
    SourcedMap out{emitPhotons(scene, request.emit, run), {}};
    if (cached && keepInCache(*cached, out.map, run)) out.cached = *cached;
    return out;
}

PhotonMap mapByTime(const Scene& scene, const EmitSettings& emit, const Clock& clock, const FindMapSeconds& findSeconds,
                    RunContext& run) {
    // A photon: tree and layout, and its share of the records of irradiance, which the first sample makes (0.15 to 0.5
    // of a microsecond, where most of the map is seen).
    constexpr double kBuildSeconds = 0.5e-6, kRecordSeconds = 0.4e-6;
    Emission emission(scene, emit, run);
    uint64_t traced = 0;
    double seconds = 0;  // that tracing took
    const auto trace = [&](uint64_t paths) {
        const PhaseTimer timer(run, "emit");
        const double start = clock.used();
        emission.trace(traced, paths, run);
        traced += paths;
        seconds += clock.used() - start;
    };
    trace(kFirstRound);
    const double allowed = findSeconds(emission.mapSoFar(run), seconds);
    const double limit = allowed + clock.used();
    while (!run.interrupted()) {
        const uint64_t stored = emission.stored(PhotonClass::Caustic) + emission.stored(PhotonClass::Indirect);
        // Where nothing arrives, more of it will not help.
        if (stored == 0 && traced >= 4 * kFirstRound) break;
        const double later = (kBuildSeconds + kRecordSeconds) * static_cast<double>(stored);
        const double perPath = (seconds + later) / static_cast<double>(traced);
        const double affordable = (limit - clock.used() - later) / perPath;
        if (affordable < static_cast<double>(kFirstRound) / 4) break;
        run.progress("emit", static_cast<double>(traced) / (static_cast<double>(traced) + affordable));
        trace(static_cast<uint64_t>(std::min(affordable, 4.0 * static_cast<double>(traced))));
    }
    const PhaseTimer timer(run, "build");
    return emission.finish(traced, run);
}

}  // namespace lsde
