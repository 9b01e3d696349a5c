// Errors that look at each pixel on its own. I is the picture, R its reference, both of one size and finite.
#pragma once

#include <vector>

#include "image/image.h"

namespace lsde {

inline constexpr double kRelMseEpsilon = 0.01;
inline constexpr double kSmapeEpsilon = 0.01;
inline constexpr double kTrimmedShare = 0.001;  // of the pixels, left out by the trimmed mean

// Mean of (I-R)^2 over pixels and channels.
double meanSquaredError(const RgbImage& image, const RgbImage& reference);

// For every pixel the mean over channels of (I-R)^2 / (R^2 + kRelMseEpsilon). Their mean is relMSE.
std::vector<double> relativeSquaredErrors(const RgbImage& image, const RgbImage& reference);

// Mean without the largest kTrimmedShare of the values, but of one value at least: what a few fireflies cannot spoil.
double trimmedMean(std::vector<double> values);

// Symmetric mean absolute percentage error as in Vogels et al. 2018, section 5.3: mean over pixels and channels of
// |I-R| / (|I| + |R| + kSmapeEpsilon), in [0,1].
double smape(const RgbImage& image, const RgbImage& reference);

// 10 log10(peak^2 / MSE) in dB; infinite for equal pictures.
double peakSignalToNoiseRatio(const RgbImage& image, const RgbImage& reference, double peak);

}  // namespace lsde
