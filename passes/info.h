// What a scene, a map or an image holds, and whether it is sound.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/run.h"
#include "passes/scene_source.h"

namespace lsde {

struct InfoResult {
    std::vector<std::string> lines;  // for people
    // Not null; machine-readable: kind ("scene", "map", "image") and its figures. Flux of a map in watts, as
    // flux.CLASS.OBJECT = [R, G, B].
    std::unique_ptr<nlohmann::json> json;
    InfoResult();
    ~InfoResult();
    InfoResult(InfoResult&&) noexcept;
};

struct InfoSettings {
    bool verify = false;  // check every byte of a map
    SceneSettings scene;
};

// Tells scene, map and image apart by their first bytes and loads them as fully as render does. Throws Error on
// whatever render would refuse as invalid; a missing light or camera is reported only.
InfoResult describeFile(const std::filesystem::path& file, const InfoSettings& settings, RunContext& run);

}  // namespace lsde
