// The stages render and reference: a map where the method uses one, samples until the counts or the time are reached,
// a picture with its layers.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/run.h"
#include "image/exr.h"
#include "passes/crop.h"
#include "passes/emit.h"
#include "passes/gather.h"
#include "passes/integrator.h"
#include "passes/layers.h"
#include "scene/scene.h"

namespace lsde {

struct RenderSettings {
    std::filesystem::path map;         // empty: emitted here, or found in the cache
    bool cache = true;                 // look for the map in the user's cache folder, keep it there
    bool otherScene = false;           // take a map of another scene
    std::optional<uint64_t> photons;   // default 1,000,000 without a time limit
    std::optional<double> spp;         // default 64 without a time limit
    std::optional<double> wallLimit;   // s, of the whole run, process start included
    std::optional<double> cpuLimit;    // s, all threads
    std::optional<double> errorLimit;  // of the estimated relMSE (PictureError::relativeTo)
    std::optional<std::array<int, 2>> size;
    std::optional<Crop> crop;
    std::string camera;
    std::vector<LayerRequest> paths;
    std::optional<std::string> only;
    std::vector<std::string> lights;
    IndexKind index = IndexKind::Kd;
    bool indirectFromMap = true;  // else light that met a diffuse surface before is followed by paths
    uint32_t progressive = 0;     // passes; 0: one map, no shrinking radius
};

struct RenderResult {
    ImageFile image;
    ExrMetadata metadata;
    RgbImage picture;                                     // the full one
    double samples = 0;                                   // per pixel, reached
    std::optional<PictureError::Relative> relativeError;  // estimated, where the method can
    uint32_t passes = 0;                                  // progressive ones, reached
    uint64_t photons = 0;                                 // paths emitted for it, or those of the map
    uint64_t storedPhotons = 0;                           // of the caustic class
    uint64_t storedIndirect = 0;
    uint64_t notFinite = 0;  // contributions left out because they were not finite
    std::filesystem::path cachedMap;
    bool interrupted = false;
};

// A picture of each camera, in order, all by one map that is emitted or loaded once (settings.camera is not looked at).
// A time limit is of the whole run; the pictures share evenly what emission leaves. onPicture gets the camera's index;
// after an interrupt no further picture is begun. Throws Error (bad input: names what differs), UsageError (settings
// that do not go together).
using OnPicture = std::function<void(size_t camera, RenderResult&& result)>;
void renderPictures(const Scene& scene, const IntegratorEntry& method, const RenderSettings& settings,
                    std::span<const CameraDescription> cameras, RunContext& run, const OnPicture& onPicture);

// The picture of settings.camera.
RenderResult renderPicture(const Scene& scene, const IntegratorEntry& method, const RenderSettings& settings,
                           RunContext& run);

}  // namespace lsde
