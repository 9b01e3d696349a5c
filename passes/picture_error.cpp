#include "passes/picture_error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

namespace lsde {

namespace {

// The reference's floor in relMSE (compare/metrics.h).
constexpr float kRelativeFloor = 0.01F;
// The variance of the mean of n samples, were they independent, from the sum of all and that of the first ones:
// (m1 - m2)^2 n1 n2 / n^2.
float varianceByParts(Rgb all, float n, Rgb before, float first) {
    const float second = n - first;
    return mean(square(before / first - (all - before) / second)) * first * second / square(n);
}

float firstPart(double count) { return static_cast<float>(std::bit_floor(static_cast<uint64_t>(count) - 1)); }

// By what sequences that are better than independent samples divide the variance at each doubling, for pixels of one
// count: two parts of the first half show what the halves would have shown before.
class Convergence {
  public:
    void add(const SampleStatistics& s, double count, float variance) {
        if (count < 4) return;
        const float first = firstPart(count);
        const double weight = 1 / static_cast<double>(square(mean(s.all) / static_cast<float>(count)) + kRelativeFloor);
        Sums& sums = byCount_[static_cast<uint64_t>(count)];
        sums.now += weight * static_cast<double>(variance);
        sums.before += weight * static_cast<double>(varianceByParts(s.earlier, first, s.earliest, first / 2));
        ++sums.pixels;
    }
    // Of the variance that parts show, if samples were independent. What four converge by, fewer are taken to.
    float factor(double count) const {
        constexpr size_t kLeastPixels = 64;
        count = std::max(count, 4.0);
        const auto sums = byCount_.find(static_cast<uint64_t>(count));
        if (sums == byCount_.end() || sums->second.pixels < kLeastPixels || !(sums->second.before > 0)) return 1;
        const double doublings = std::log2(count / static_cast<double>(firstPart(count)));
        const double ratio = std::pow(sums->second.now / sums->second.before, 1 / doublings);
        return static_cast<float>(std::clamp(2 * ratio, 0.2, 1.0));
    }

  private:
    struct Sums {
        double now = 0, before = 0;
        size_t pixels = 0;
    };
    std::map<uint64_t, Sums> byCount_;
};

}  // namespace

PictureError pictureError(const std::vector<SampleStatistics>& statistics, std::span<const double> counts, int width) {
    std::vector<float> ofOneSample;  // if a pixel has no more
    if (std::any_of(counts.begin(), counts.end(), [](double count) { return count == 1; }))
        ofOneSample = varianceOfOneSample(statistics, width, static_cast<int>(statistics.size()) / width);
    PictureError error;
    Convergence convergence;
    for (size_t i = 0; i < statistics.size(); ++i) {
        const SampleStatistics& s = statistics[i];
        const auto n = static_cast<float>(counts[i]);
        error.camera.push_back(counts[i] > 1 ? varianceByParts(s.all, n, s.earlier, firstPart(counts[i]))
                                             : ofOneSample[i]);
        error.photons.push_back(square(s.photons / n));
        convergence.add(s, counts[i], error.camera.back());
    }
    for (size_t i = 0; i < statistics.size(); ++i)
        if (counts[i] > 1) error.camera[i] *= convergence.factor(counts[i]);
    return error;
}

PictureError::Relative PictureError::relativeTo(const RgbImage& picture) const {
    Relative r;
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        const auto weight = static_cast<double>(mean(1.0F / (square(picture.pixels[i]) + kRelativeFloor)));
        r.camera += weight * static_cast<double>(camera[i]);
        r.photons += weight * static_cast<double>(photons[i]);
    }
    const auto count = static_cast<double>(picture.pixels.size());
    return {r.camera / count, r.photons / count};
}

std::vector<float> PictureError::standardErrors() const {
    std::vector<float> errors(camera.size());
    for (size_t i = 0; i < errors.size(); ++i) errors[i] = std::sqrt(camera[i] + photons[i]);
    return errors;
}

}  // namespace lsde
