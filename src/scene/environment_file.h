// Reads a picture of an environment.
#pragma once

#include <filesystem>

#include "scene/description.h"

namespace lsde {

struct EnvironmentSettings {
    std::filesystem::path file;  // equirectangular OpenEXR or Radiance (.hdr), twice as wide as high
    float turnDeg = 0;           // about +Y; 90 moves what is seen along +Z to +X
    float strength = 1;          // factor of the radiance
};

// Values are radiance in the program's units. Throws Error naming the file and what was expected: an unreadable file,
// another shape, pixels (by column and row) that are not finite, negative or above 1e10 (the sun's disc has 1.6e9
// nits), and all black.
EnvironmentDescription loadEnvironment(const EnvironmentSettings& settings);

}  // namespace lsde
