// The scene that a command works on: a glTF file, and the light from beyond it that the user asks for.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/run.h"
#include "scene/environment_file.h"
#include "scene/gltf.h"
#include "scene/scene.h"
#include "scene/sky.h"

namespace lsde {

struct SceneSettings {
    GltfOptions gltf;                                // onWarning is set by the loader
    std::optional<EnvironmentSettings> environment;  // a picture of what surrounds the scene; or
    std::optional<SkySettings> sky;                  // sun and sky, but not both
};

// Warnings go to the run. Throws Error naming file, object, value and what was expected.
std::unique_ptr<Scene> loadScene(const std::filesystem::path& file, const SceneSettings& settings, RunContext& run);

// What is said where a scene has no light and something is to be lit.
std::string noLightError(const Scene& scene);

}  // namespace lsde
