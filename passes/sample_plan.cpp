#include "passes/sample_plan.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"

namespace lsde {

namespace {

constexpr float kLeastRate = 0.25F, kMostRate = 16;

}  // namespace

void SamplePlan::adapt(const std::vector<SampleStatistics>& statistics) {
    const auto n = static_cast<double>(kUniform);
    double total = 0;
    for (const SampleStatistics& s : statistics) total += s.sum / n;
    const double mean = total / static_cast<double>(statistics.size());
    std::vector<float> noise(statistics.size());
    for (size_t i = 0; i < noise.size(); ++i) {
        const double own = statistics[i].sum / n;
        const double variance = std::max(0.0, statistics[i].sumOfSquares / n - own * own);
        noise[i] = static_cast<float>(variance / (own * own + mean * mean + 1e-30));
    }
    std::vector<float> wanted(noise.size());
    double sum = 0;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            float around = 0;
            int count = 0;
            for (int v = std::max(0, y - 1); v <= std::min(height_ - 1, y + 1); ++v)
                for (int u = std::max(0, x - 1); u <= std::min(width_ - 1, x + 1); ++u) {
                    if (u == x && v == y) continue;
                    around += noise[static_cast<size_t>(v) * static_cast<size_t>(width_) + static_cast<size_t>(u)];
                    ++count;
                }
            // The sum of sigma^2 / n is least, at a given number of samples, when n goes by sigma.
            const float w = count > 0 ? std::sqrt(around / static_cast<float>(count)) : 0;
            wanted[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)] = w;
            sum += w;
        }
    if (!(sum > 0)) return;
    rates_.resize(wanted.size());
    // The bounds change the sum: a few rounds find the factor that brings the mean to one.
    double factor = static_cast<double>(wanted.size()) / sum;
    double reached = 0;
    for (int round = 0; round < 8; ++round) {
        reached = 0;
        for (size_t i = 0; i < wanted.size(); ++i) {
            rates_[i] = std::clamp(static_cast<float>(factor) * wanted[i], kLeastRate, kMostRate);
            reached += rates_[i];
        }
        factor *= static_cast<double>(wanted.size()) / reached;
    }
    // Where few pixels are noisy, these have the most that is allowed, and the others get what is left.
    const double left = (static_cast<double>(wanted.size()) - reached) / static_cast<double>(wanted.size());
    for (float& rate : rates_) rate = std::max(kLeastRate, rate + static_cast<float>(left));
}

uint64_t SamplePlan::count(size_t pixel, uint64_t samples) const {
    if (samples <= kUniform || rates_.empty()) return samples;
    // Rounded up as often as the fraction says.
    const double u = static_cast<double>(mix64(pixel) >> 40) * 0x1p-24;
    return kUniform +
           static_cast<uint64_t>(static_cast<double>(rates_[pixel]) * static_cast<double>(samples - kUniform) + u);
}

}  // namespace lsde
