// Light of one wavelength in a renderer of red, green and blue.
//
// The model: each channel is a sensor, and light and reflectances are even within what a channel sees. White (1, 1, 1)
// is D65; a channel's sensitivity is the one that Rec. 709 gives it, by way of the CIE 1931 2 degree observer, times
// D65's spectrum, scaled to integrate to 1. A path that disperses carries one wavelength, and what its throughput (as
// always: by channel) is worth in each channel is sensitivity / density, the wavelength's weight.
//
// The mean weight over all wavelengths is (1, 1, 1), so that energy and colour of any light are those that it would
// have undispersed, and the order of dispersing surfaces, absorption and reflection does not matter. White light and
// grey surfaces are rendered as by a spectral renderer. Limits: saturated light and surfaces have no spectrum of their
// own, they scale the channels of white's (a red lamp's rainbow is the red channel of a white one's); and spectral
// colours lie outside of Rec. 709, so that weights, and pictures, have negative channels, which only the PNG clamps.
#pragma once

#include <cstdint>

#include "base/math.h"

namespace lsde {

// Number of a wavelength, 1 to kWavelengths in ascending order; kAllWavelengths: light that was not dispersed.
using WavelengthId = uint16_t;
inline constexpr WavelengthId kAllWavelengths = 0;
inline constexpr int kWavelengths = 4095;  // fits 12 bits of a photon's record; neighbours are 0.03 to 1 nm apart

// u in [0,1). All numbers are equally likely: the density of wavelengths goes by the sum of the channels'
// |sensitivity|, which bounds the weights.
WavelengthId sampleWavelength(float u);

float wavelengthNm(WavelengthId wavelength);  // in air; not of kAllWavelengths

// What one of equally likely wavelengths weighs in each channel; (1, 1, 1) of kAllWavelengths.
Rgb wavelengthWeight(WavelengthId wavelength);

// Light (or throughput) as the picture's channels see it.
inline Rgb weighed(Rgb light, WavelengthId wavelength) {
    return wavelength == kAllWavelengths ? light : light * wavelengthWeight(wavelength);
}

// How much light of two dispersed paths is one light, where a path from the eye meets a photon of another wavelength: a
// kernel over numbers, with mean 1 for either of them over all of the other (at the ends it is reflected). What is
// estimated with it is smeared over the kernel's width, `share` of all numbers in (0,1], and consistent as that goes to
// 0.
float wavelengthKernel(WavelengthId a, WavelengthId b, float share);

}  // namespace lsde
