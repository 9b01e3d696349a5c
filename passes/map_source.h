// Where a picture's photon map comes from: a file, the cache, or an emission of its own.
#pragma once

#include <filesystem>
#include <functional>
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

// Seconds that a map may cost from now on, found out with a first one and what that took.
using FindMapSeconds = std::function<double(const PhotonMap& first, double firstSeconds)>;

// A map of as many light paths as the seconds allow: their emission, the tree, and what the camera pass spends once on
// each photon.
PhotonMap mapByTime(const Scene& scene, const EmitSettings& emit, const Clock& clock, const FindMapSeconds& findSeconds,
                    RunContext& run);

}  // namespace lsde
