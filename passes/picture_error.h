// How far a picture may be off, as its own samples and photons tell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"
#include "passes/sample_plan.h"

namespace lsde {

// Variance of each pixel's mean, row by row; the mean over its channels. Bias is not in it.
struct PictureError {
    std::vector<float> camera;   // by the samples of the pixel
    std::vector<float> photons;  // by the number of photons, which all samples share

    // Mean over pixels and channels of variance / (value^2 + 0.01): what `compare` would call relMSE.
    struct Relative {
        double camera = 0, photons = 0;
        double total() const { return camera + photons; }
    };
    Relative relativeTo(const RgbImage& picture) const;
    // Of each pixel, in the units of the picture. A pixel's own is a rough guess: what its samples say is the
    // difference of two halves. Root mean squares over many pixels are right.
    std::vector<float> standardErrors() const;
};

// counts: samples of each pixel. With one sample nothing is known of a pixel's own noise.
PictureError pictureError(std::span<const SampleStatistics> statistics, std::span<const double> counts);

}  // namespace lsde
