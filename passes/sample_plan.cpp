#include "passes/sample_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/hash.h"

namespace lsde {

namespace {

constexpr float kLeastRate = 0.125F, kMostRate = 16;
// By what power of n the variance of n of Sobol's points falls, roughly, where an edge or a gradient crosses the pixel.
constexpr float kConvergence = 1.35F;

}  // namespace

void SamplePlan::adapt(const std::vector<SampleStatistics>& statistics) {
    // The sum of sigma^2 / n^a is least, at a given number of samples, when n goes by (sigma^2)^(1 / (1 + a)).
    std::vector<float> wanted = relativeVariance(statistics, width_, height_);
    for (float& w : wanted) w = std::pow(w, 1 / (1 + kConvergence));
    const double sum = std::accumulate(wanted.begin(), wanted.end(), 0.0);
    if (!(sum > 0)) return;
    const auto pixels = static_cast<double>(wanted.size());
    rates_.resize(wanted.size());
    // The bounds change the sum: a few rounds find the factor that brings the mean to one.
    double factor = pixels / sum, reached = 0;
    for (int round = 0; round < 8; ++round) {
        reached = 0;
        for (size_t i = 0; i < wanted.size(); ++i) {
            rates_[i] = std::clamp(static_cast<float>(factor) * wanted[i], kLeastRate, kMostRate);
            reached += rates_[i];
        }
        factor *= pixels / reached;
    }
    // Where few pixels are noisy, these have the most that is allowed, and the others get what is left.
    const auto left = static_cast<float>((pixels - reached) / pixels);
    for (float& rate : rates_) rate = std::max(kLeastRate, rate + left);
}

// Whether the pixel is in a share of all that is evenly spread over the picture. Bayer's ordered dither: of two bits
// for each power of two in x and y, those of the least one weigh most in the order of pixels.
bool SamplePlan::isAmong(double share, size_t pixel) const {
    const auto width = static_cast<size_t>(width_);
    const size_t y = pixel / width, odd = (pixel % width) ^ y;
    double order = 0, weight = 1;
    for (size_t bit = 0; order < share && order + weight > share; ++bit) {
        weight /= 4;
        order += weight * static_cast<double>(2 * (odd >> bit & 1) + (y >> bit & 1));
    }
    return order < share;
}

uint64_t SamplePlan::count(size_t pixel, double samples) const {
    if (samples <= kUniform || rates_.empty()) {
        const double whole = std::floor(samples);
        return static_cast<uint64_t>(whole) + (isAmong(samples - whole, pixel) ? 1 : 0);
    }
    const double u = static_cast<double>(mix64(pixel) >> 40) * 0x1p-24;
    const double n = kUniform + static_cast<double>(rates_[pixel]) * (samples - kUniform);
    const uint64_t lower = std::bit_floor(static_cast<uint64_t>(n));
    return static_cast<double>(lower) * (1 + u) < n ? 2 * lower : lower;
}

}  // namespace lsde
