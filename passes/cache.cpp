#include "passes/cache.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdlib>

namespace lsde {

std::optional<std::filesystem::path> cachedMapPath(const Scene& scene, const EmitSettings& settings, uint64_t seed) {
    std::filesystem::path folder;
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg != nullptr && *xdg != 0)
        folder = xdg;
    else if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0)
        folder = std::filesystem::path(home) / ".cache";
    else
        return {};
    std::string key = fmt::format("lsde {} map {} scene {} seed {} photons {} depth {} store {} aim {} lights",
                                  LSDE_VERSION, kMapVersion, scene.hash(), seed, settings.photons, settings.maxDepth,
                                  name(settings.store), settings.aim);
    for (const std::string& light : settings.lights) key += fmt::format(" {}:{}", light.size(), light);
    const XXH128_hash_t h = XXH3_128bits(key.data(), key.size());
    return folder / "lsde" / fmt::format("{:016x}{:016x}.lsmap", h.high64, h.low64);
}

}  // namespace lsde
