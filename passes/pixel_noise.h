// What the samples of a picture tell of its noise before any pixel has two.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "base/math.h"

namespace lsde {

// What is kept of a pixel's samples.
struct SampleStatistics {
    float first = 0;  // luminance of the first sample
    // Sums over all samples, over those before the last power of two, and before the one before.
    Rgb all{0}, earlier{0}, earliest{0};
    float photons = 0;  // sum of the standard deviations that single samples have by their photons

    void add(uint64_t sample, Rgb value, float photonDeviation) {
        if (sample == 0) first = luminance(value);
        if (std::has_single_bit(sample)) {
            earliest = earlier;
            earlier = all;
        }
        all += value;
        photons += photonDeviation;
    }
};

// Variance of a single sample of each pixel, row by row, as the first samples of the pixels around it tell, but not its
// own: over the square of the brightness there plus that of the picture's mean. Three pixels in a row or in a column
// tell it by how far the middle one is from the straight line through the others, so that a gradient is no noise. An
// edge is: where one runs along pixels, it also runs through them, and samples differ within each.
std::vector<float> relativeVariance(const std::vector<SampleStatistics>& statistics, int width, int height);

// The same in squares of luminance.
std::vector<float> varianceOfOneSample(const std::vector<SampleStatistics>& statistics, int width, int height);

}  // namespace lsde
