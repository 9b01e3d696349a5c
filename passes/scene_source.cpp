#include "passes/scene_source.h"

#include <fmt/format.h>

namespace lsde {

std::unique_ptr<Scene> loadScene(const std::filesystem::path& file, const SceneSettings& settings, RunContext& run) {
    const PhaseTimer timer(run, "load scene");
    GltfOptions options = settings.gltf;
    options.onWarning = [&run](const std::string& warning) { run.warn(warning); };
    SceneDescription description = loadGltf(file, options);
    if (settings.environment) description.environment = loadEnvironment(*settings.environment);
    if (settings.sky) {
        Sky sky = makeSky(*settings.sky);
        description.environment = std::move(sky.sky);
        description.sun = std::move(sky.sun);
    }
    auto scene = std::make_unique<Scene>(std::move(description));
    for (const std::string& warning : scene->description().warnings) run.warn(warning);
    return scene;
}

std::string noLightError(const Scene& scene) {
    return fmt::format(
        "{}: no light in the scene: expected an emissive material or a light of KHR_lights_punctual; --sky and "
        "--environment FILE add one",
        scene.description().file.string());
}

}  // namespace lsde
