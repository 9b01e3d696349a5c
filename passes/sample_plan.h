// How many samples each pixel gets: the same number at first, then more where the picture is noisier.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "base/math.h"

namespace lsde {

// What is known of a pixel's noise. Samples are seen in two halves, each as evenly distributed as the whole: their
// difference shows the noise that is left, where the spread of single samples does not.
struct SampleStatistics {
    // Few: what every pixel must have is lost to those that need more.
    static constexpr uint64_t kSamples = 2;

    float sum[2] = {0, 0};  // luminance of the first samples
    // Sums over all samples, over those before the last power of two, and before the one before.
    Rgb all{0}, earlier{0}, earliest{0};
    float photons = 0;  // sum of the standard deviations that single samples have by their photons

    void add(uint64_t sample, Rgb value, float photonDeviation) {
        if (sample < kSamples) sum[sample / (kSamples / 2)] += luminance(value);
        if (std::has_single_bit(sample)) {
            earliest = earlier;
            earlier = all;
        }
        all += value;
        photons += photonDeviation;
    }
};

// The mean number of samples a pixel, S, says how many each has: a function of S and of the first kUniform samples
// alone, so that a picture stopped by time can be made again by count. A pixel's share depends on the noise of its
// neighbours, and on its own samples only through the factor that all pixels share: a count chosen by the values that
// it averages would bias the mean (Kirk & Arvo 1991). Rates are bounded; what the bounds leave over all get alike.
// Counts are powers of two, at which Sobol's points are distributed best: the larger or the smaller one by chance, so
// that the mean is right. Of less than one, pixels far from each other are the first (Bayer 1973): a fourth of a sample
// is one for each square of two by two.
class SamplePlan {
  public:
    static constexpr uint64_t kUniform = SampleStatistics::kSamples;

    SamplePlan(int width, int height) : width_(width), height_(height) {}

    // Gives out what comes after the first samples, by relative variance: sigma^2 / (mean^2 + (mean of the picture)^2).
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
    std::vector<float> noiseAround(const std::vector<SampleStatistics>& statistics) const;

    int width_, height_;
    std::vector<float> rates_;           // empty: 1
    std::vector<uint8_t> lightSamples_;  // empty: 1
};

}  // namespace lsde
