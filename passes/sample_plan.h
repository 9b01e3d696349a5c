// How many samples each pixel gets: the same number at first, then more where the picture is noisier.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"

namespace lsde {

// A pixel's samples so far.
struct SampleStatistics {
    float sum = 0, sumOfSquares = 0;  // of the samples' luminance

    void add(float luminance) {
        sum += luminance;
        sumOfSquares += luminance * luminance;
    }
};

// The mean number of samples a pixel, S, says how many each has: a function of S and of the first kUniform samples
// alone, so that a picture stopped by time can be made again by count. A pixel's share depends on the noise of its
// neighbours, and on its own samples only through the factor that all pixels share: a count chosen by the values that
// it averages would bias the mean (Kirk & Arvo 1991). Rates are bounded; what the bounds leave over all get alike.
class SamplePlan {
  public:
    static constexpr uint64_t kUniform = 8;

    SamplePlan(int width, int height) : width_(width), height_(height) {}

    // Gives out what comes after the first samples, by relative variance: sigma^2 / (mean^2 + (mean of the picture)^2).
    void adapt(const std::vector<SampleStatistics>& statistics);

    // Samples of the pixel when the mean is `samples`.
    uint64_t count(size_t pixel, uint64_t samples) const;

  private:
    int width_, height_;
    std::vector<float> rates_;  // samples for each one of the mean, after the first; empty: 1
};

}  // namespace lsde
