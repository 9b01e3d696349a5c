#include "passes/pixel_noise.h"

#include <algorithm>

#include "passes/int_range.h"

namespace lsde {

namespace {

// What pixels next to each other show is where the noise is, what those further away do is surer. Of the wide square's
// mean so much: enough for the noise that the narrow one happened not to see.
constexpr int kNarrow = 1, kWide = 3;
constexpr float kWideShare = 0.1F;

double meanOf(const std::vector<SampleStatistics>& statistics) {
    double total = 0;
    for (const SampleStatistics& s : statistics) total += static_cast<double>(s.first);
    return total / static_cast<double>(statistics.size());
}

double brightness(float sample, double mean) { return square(static_cast<double>(sample)) + square(mean) + 1e-30; }

// The picture of first samples, and what three of them show.
class Bends {
  public:
    Bends(const std::vector<SampleStatistics>& statistics, int width, int height)
        : statistics_(statistics),
          width_(width),
          height_(height),
          columns_{0, width - 1},
          rows_{0, height - 1},
          middleColumns_{1, width - 2},
          middleRows_{1, height - 2},
          mean_(meanOf(statistics)),
          alongRows_(statistics.size()),
          alongColumns_(statistics.size()) {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                if (x > 0 && x + 1 < width) alongRows_[at(x, y)] = bend(at(x - 1, y), at(x, y), at(x + 1, y));
                if (y > 0 && y + 1 < height) alongColumns_[at(x, y)] = bend(at(x, y - 1), at(x, y), at(x, y + 1));
            }
    }

    // Adds the mean over the square that reaches so far around each pixel, times `share`.
    void addMeans(int reach, float share, std::vector<float>& to) const {
        std::vector<float> sums(statistics_.size());  // of rows
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                const IntRange columns = columns_.around(x, reach);
                for (int u = columns.first; u <= columns.last; ++u)
                    sums[at(x, y)] += alongRows_[at(u, y)] + alongColumns_[at(u, y)];
            }
        for (int y = 0; y < height_; ++y) {
            const IntRange rows = rows_.around(y, reach);
            for (int x = 0; x < width_; ++x) {
                float sum = -withPixel(x, y);
                for (int v = rows.first; v <= rows.last; ++v) sum += sums[at(x, v)];
                const int along = middleColumns_.around(x, reach).count() * rows.count();
                const int across = middleRows_.around(y, reach).count() * columns_.around(x, reach).count();
                const int own = middleColumns_.around(x, 1).count() + middleRows_.around(y, 1).count();
                const int count = along + across - own;
                if (count > 0) to[at(x, y)] += share * std::max(0.0F, sum) / static_cast<float>(count);
            }
        }
    }

  private:
    size_t at(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
    }
    // Relative variance of one sample: that of the second difference of three is six times as large.
    float bend(size_t before, size_t middle, size_t after) const {
        const float a = statistics_[before].first, b = statistics_[middle].first, c = statistics_[after].first;
        return static_cast<float>(static_cast<double>(square(a - 2 * b + c)) /
                                  (6 * brightness((a + b + c) / 3, mean_)));
    }
    // What the pixel's own sample has a part in.
    float withPixel(int x, int y) const {
        float sum = 0;
        const IntRange row = middleColumns_.around(x, 1), column = middleRows_.around(y, 1);
        for (int u = row.first; u <= row.last; ++u) sum += alongRows_[at(u, y)];
        for (int v = column.first; v <= column.last; ++v) sum += alongColumns_[at(x, v)];
        return sum;
    }

    const std::vector<SampleStatistics>& statistics_;
    int width_, height_;
    IntRange columns_, rows_;
    IntRange middleColumns_, middleRows_;  // that have one on both sides
    double mean_;
    std::vector<float> alongRows_, alongColumns_;  // by the middle one of three; 0 at the picture's edge
};

}  // namespace

std::vector<float> relativeVariance(const std::vector<SampleStatistics>& statistics, int width, int height) {
    const Bends bends(statistics, width, height);
    std::vector<float> variance(statistics.size());
    bends.addMeans(kNarrow, 1 - kWideShare, variance);
    bends.addMeans(kWide, kWideShare, variance);
    return variance;
}

std::vector<float> varianceOfOneSample(const std::vector<SampleStatistics>& statistics, int width, int height) {
    std::vector<float> variance = relativeVariance(statistics, width, height);
    const double mean = meanOf(statistics);
    for (size_t i = 0; i < variance.size(); ++i)
        variance[i] *= static_cast<float>(brightness(statistics[i].first, mean));
    return variance;
}

}  // namespace lsde
