// The user's folder of photon maps.
#pragma once

#include <filesystem>
#include <optional>

#include "passes/emit.h"

namespace lsde {

// Where the map of this scene and these settings lies: XDG_CACHE_HOME/lsde (or ~/.cache/lsde) under a hash of scene,
// settings, seed and the versions of map and program. None if neither XDG_CACHE_HOME nor HOME is set.
std::optional<std::filesystem::path> cachedMapPath(const Scene& scene, const EmitSettings& settings, uint64_t seed);

}  // namespace lsde
