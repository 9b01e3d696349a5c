#include "passes/map_source.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "passes/cache.h"

namespace lsde {

namespace {

constexpr uint64_t kFirstRound = 1 << 14;

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

PhotonMap mapByTime(const Scene& scene, const EmitSettings& emit, const Clock& clock, MapLimits limits,
                    RunContext& run) {
    constexpr double kBuildSeconds = 0.35e-6;  // a photon: tree and layout
    const double begin = clock.used();
    Emission emission(scene, emit, run);
    const double start = clock.used();
    const double seconds = limits.seconds - (start - begin);
    uint64_t next = 0;
    {
        const PhaseTimer timer(run, "emit");
        uint64_t round = std::min(kFirstRound, limits.paths);
        while (!run.interrupted()) {
            emission.trace(next, round, run);
            next += round;
            const double used = clock.used() - start;
            run.progress("emit", used / std::max(used, seconds));
            const uint64_t stored = emission.stored(PhotonClass::Caustic) + emission.stored(PhotonClass::Indirect);
            // Where nothing arrives, more of it will not help.
            if (stored == 0 && next >= 16 * kFirstRound) break;
            const double perPath = (used + kBuildSeconds * static_cast<double>(stored)) / static_cast<double>(next);
            const double affordable = seconds / perPath - static_cast<double>(next);
            if (affordable < static_cast<double>(kFirstRound)) break;
            round = static_cast<uint64_t>(std::min(affordable, 4.0 * static_cast<double>(next)));
            round = std::min(round, limits.paths - next);
            if (round == 0) break;
        }
    }
    const PhaseTimer timer(run, "build");
    return emission.finish(next, run);
}

}  // namespace lsde
