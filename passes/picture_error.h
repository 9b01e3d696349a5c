// How far a picture may be off, as its own samples and photons tell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"
#include "passes/pixel_noise.h"

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

// counts: samples of each pixel, at least one; statistics: row by row. Of a pixel that has one its neighbours tell.
PictureError pictureError(const std::vector<SampleStatistics>& statistics, std::span<const double> counts, int width);

}  // namespace lsde
