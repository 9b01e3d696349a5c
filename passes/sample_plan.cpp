#include "passes/sample_plan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/hash.h"

namespace lsde {

namespace {

constexpr float kLeastRate = 0.125F, kMostRate = 16;
// Pixels up to this far away say what a pixel's noise is.
constexpr int kReach = 3;

}  // namespace

// Standard error of each pixel's mean, as its neighbours show it, relative to the brightness.
std::vector<float> SamplePlan::noiseAround(const std::vector<SampleStatistics>& statistics) const {
    const auto n = static_cast<double>(kUniform);
    double total = 0;
    for (const SampleStatistics& s : statistics) total += (s.sum[0] + s.sum[1]) / n;
    const double mean = total / static_cast<double>(statistics.size());
    std::vector<float> variance(statistics.size());
    for (size_t i = 0; i < variance.size(); ++i) {
        const auto& [first, second] = statistics[i].sum;
        variance[i] =
            static_cast<float>(square((first - second) / n) / (square((first + second) / n) + mean * mean + 1e-30));
    }
    // The sum over the square around each pixel, along the rows and then along the columns.
    const auto at = [this](int x, int y) {
        return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
    };
    const auto around = [](int centre, int size) {
        return std::array{std::max(0, centre - kReach), std::min(size - 1, centre + kReach)};
    };
    std::vector<float> along(variance.size()), noise(variance.size());
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const auto [first, last] = around(x, width_);
            for (int u = first; u <= last; ++u) along[at(x, y)] += variance[at(u, y)];
        }
    for (int y = 0; y < height_; ++y) {
        const auto [top, bottom] = around(y, height_);
        for (int x = 0; x < width_; ++x) {
            float sum = 0;
            for (int v = top; v <= bottom; ++v) sum += v == y ? along[at(x, v)] - variance[at(x, v)] : along[at(x, v)];
            const auto [first, last] = around(x, width_);
            const int count = (last - first + 1) * (bottom - top + 1) - 1;
            if (count > 0) noise[at(x, y)] = std::sqrt(std::max(0.0F, sum) / static_cast<float>(count));
        }
    }
    return noise;
}

void SamplePlan::adapt(const std::vector<SampleStatistics>& statistics) {
    // The sum of sigma^2 / n is least, at a given number of samples, when n goes by sigma.
    const std::vector<float> wanted = noiseAround(statistics);
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
