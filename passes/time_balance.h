// How a time limit is shared between photons and samples of the camera: by what both cost, and how noisy both are, in a
// few tiles of the picture with a first small map.
#pragma once

#include <functional>
#include <memory>

#include "passes/clock.h"
#include "passes/integrator.h"

namespace lsde {

// What was seen with a first map.
struct FirstLook {
    double sampleSeconds = 0;        // of one sample of every pixel
    double samples = 0;              // of each pixel, of
    PictureError::Relative error{};  // this
};

using MakeIntegrator = std::function<std::unique_ptr<Integrator>(const Camera&)>;

// Takes a few samples of tiles that are spread over the camera's film and make up `share` of it, in (0, 1].
FirstLook lookAtTiles(const Camera& camera, double share, const MakeIntegrator& make, const Clock& clock,
                      RunContext& run);

// Seconds of `seconds` that photons are to have, where the first map took firstSeconds: those that give the least
// error. That of samples falls as the square of their number, since these are stratified and go where the noise is;
// that of photons as its power 2/3, since kernels shrink where photons are many. Photons weigh more: their noise is
// blotchy, and comes with bias, which their error leaves out.
double photonSeconds(const FirstLook& look, double firstSeconds, double seconds);

}  // namespace lsde
