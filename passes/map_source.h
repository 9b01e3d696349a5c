// Where a picture's photon map comes from: a file, the cache, or an emission of its own.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>

#include "passes/clock.h"
#include "passes/emit.h"

namespace lsde {

inline constexpr uint64_t kDefaultPhotons = 1000000;

struct MapRequest {
    std::filesystem::path file;  // empty: from the cache, or emitted
    bool cache = true;           // look for the map in the user's cache folder, keep it there
    bool otherScene = false;     // take a map of another scene
    EmitSettings emit;
};

struct SourcedMap {
    PhotonMap map;
    std::filesystem::path cached;  // where it was found or is kept
};

// A map of a number of light paths that is known beforehand. Throws Error if the file's scene is another.
SourcedMap mapByCount(const Scene& scene, const MapRequest& request, RunContext& run);

struct MapLimits {
    double seconds;  // by the clock
    uint64_t paths = std::numeric_limits<uint64_t>::max();
};
// A map for what may be used of time, for the pilot, emission and tree together, and of light paths; emit.photons is
// not looked at.
PhotonMap mapByTime(const Scene& scene, const EmitSettings& emit, const Clock& clock, MapLimits limits,
                    RunContext& run);

}  // namespace lsde
