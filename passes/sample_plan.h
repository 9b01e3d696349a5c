// How many samples each pixel gets: one at first, then more where the picture is noisier.
#pragma once

#include <cstdint>
#include <vector>

#include "passes/pixel_noise.h"

namespace lsde {

// The mean number of samples a pixel, S, says how many each has: a function of S and of the first kUniform samples
// alone, so that a picture stopped by time can be made again by count. A pixel's share depends on the noise of its
// neighbours, and on its own samples only through the factor that all pixels share: a count chosen by the values that
// it averages would bias the mean (Kirk & Arvo 1991). Rates are bounded; what the bounds leave over all get alike.
// Counts are powers of two, at which Sobol's points are distributed best: the larger or the smaller one by chance, so
// that the mean is right. Of less than one, pixels far from each other are the first (Bayer 1973): a fourth of a sample
// is one for each square of two by two.
class SamplePlan {
  public:
    static constexpr uint64_t kUniform = 1;

    SamplePlan(int width, int height) : width_(width), height_(height) {}

    // Gives out what comes after the first samples, by relativeVariance.
    void adapt(const std::vector<SampleStatistics>& statistics);

    // Samples of the pixel for each one of the mean, after the first.
    float rate(size_t pixel) const { return rates_.empty() ? 1 : rates_[pixel]; }

    // Samples of the lights at a vertex, for each pixel: powers of four.
    void sampleLights(std::vector<uint8_t> samples) { lightSamples_ = std::move(samples); }
    int lightSamples(size_t pixel) const { return lightSamples_.empty() ? 1 : lightSamples_[pixel]; }

    // Samples of the pixel when the mean is `samples`, at least 1.
    uint64_t count(size_t pixel, double samples) const;

  private:
    bool isAmong(double share, size_t pixel) const;

    int width_, height_;
    std::vector<float> rates_;           // empty: 1
    std::vector<uint8_t> lightSamples_;  // empty: 1
};

}  // namespace lsde
