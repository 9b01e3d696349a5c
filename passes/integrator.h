// The interface of the methods that make pictures (passes/integrators/).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/run.h"
#include "passes/gather.h"
#include "passes/layers.h"
#include "passes/picture_error.h"
#include "scene/scene.h"
#include "transport/direct_light.h"

namespace lsde {

// What an integrator is made from. References outlive it.
struct IntegratorInput {
    const Scene& scene;
    const Camera& camera;
    const RenderLayers& layers;
    const std::vector<bool>& lights;        // selected, by index
    const PhotonGather* photons = nullptr;  // for methods that use a map
    uint64_t seed = 0;
};

class Integrator {
  public:
    virtual ~Integrator() = default;
    // Samples [begin, end) of every pixel (or as many light paths as there are pixels, each). Numbers of samples are
    // means over the pixels: of a fraction, as many pixels get one more. The first begin of all is whole.
    virtual void render(double begin, double end, RunContext& run) = 0;
    // The mean of `samples` samples, more than none.
    virtual RgbImage develop(int layer, double samples) const = 0;
    virtual uint64_t notFinite() const = 0;
    // Of that mean; none from methods that do not know.
    virtual std::optional<PictureError> error(double /*samples*/) const { return std::nullopt; }
};

struct IntegratorEntry {
    std::string name;
    std::string description;
    std::string coverage;  // Heckbert expression of the paths that it makes (under lights with area and under delta
                           // lights alike)
    bool usesPhotons = false;
    bool knowsError = false;  // Integrator::error has a value
    std::function<std::unique_ptr<Integrator>(const IntegratorInput&)> make;
    // Paths of this scene that the method cannot make, as a line to warn with; empty: none.
    std::function<std::string(const Scene&)> cannotMake;
};

}  // namespace lsde
