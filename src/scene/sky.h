// A clear sky and the sun: Preetham, Shirley & Smits, "A Practical Analytic Model for Daylight" (1999).
#pragma once

#include "scene/description.h"

namespace lsde {

struct SkySettings {
    float sunElevationDeg = 45;  // of the sun's centre above the horizon, 0 to 90
    float sunAzimuthDeg = 0;     // from +Z towards +X
    float turbidity = 3;         // haze: 2 (clear) to 10 (hazy)
    float groundAlbedo = 0.2F;   // 0 to 1
};

// Luminance in nits, as linear Rec. 709.
struct Sky {
    EnvironmentDescription sky;  // "sky"; below the horizon it is the ground: even, as lit by sky and sun
    SunDescription sun;          // "sun": .265 degrees in radius, of even radiance
};

// Throws Error naming the value and what was expected.
Sky makeSky(const SkySettings& settings);

// The sky's radiance in a direction above the horizon, as makeSky() tabulates it. Colours beyond Rec. 709 are moved to
// its border.
Rgb skyRadiance(const SkySettings& settings, Vec3 direction);
// Of the sun's disc, by its spectrum and what the air takes away on its way through it: Rayleigh scattering, aerosols
// and ozone.
Rgb sunRadiance(const SkySettings& settings);
Vec3 sunDirection(const SkySettings& settings);  // unit, to the sun
// Lux on a horizontal surface in the open, of sky and sun.
Rgb openIrradiance(const SkySettings& settings);

}  // namespace lsde
