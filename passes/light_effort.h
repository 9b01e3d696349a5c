// How many samples of the lights a pixel's vertices take: more where the lights are partly seen.
#pragma once

#include <cstdint>
#include <vector>

#include "base/run.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "transport/light_sampler.h"

namespace lsde {

inline constexpr uint8_t kFewLightSamples = 4, kManyLightSamples = 16;

// For each pixel of the film, row by row: few or many. Found by a few paths for each block of pixels and those next
// to it, which no picture holds: a number chosen by the values that are averaged would bias their mean (Kirk & Arvo
// 1991). A shadow ray costs a tenth of a pixel's sample or less: in a penumbra, where nearly all of a pixel's noise is
// its lights', many of them come to less than the samples that they save.
std::vector<uint8_t> planLightSamples(const Scene& scene, const Camera& camera, const LightSampler& lights,
                                      RunContext& run);

}  // namespace lsde
