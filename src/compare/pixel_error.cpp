#include "compare/pixel_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lsde {

namespace {

// Mean over channels of error(I, R) at pixel i.
template <typename Error>
double channelMean(const RgbImage& image, const RgbImage& reference, size_t i, const Error& error) {
    double sum = 0;
    for (int c = 0; c < 3; ++c)
        sum += error(static_cast<double>(image.pixels[i][c]), static_cast<double>(reference.pixels[i][c]));
    return sum / 3;
}

template <typename Error>
double pictureMean(const RgbImage& image, const RgbImage& reference, const Error& error) {
    double sum = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) sum += channelMean(image, reference, i, error);
    return sum / static_cast<double>(image.pixels.size());
}

}  // namespace

double meanSquaredError(const RgbImage& image, const RgbImage& reference) {
    return pictureMean(image, reference, [](double i, double r) { return square(i - r); });
}

std::vector<double> relativeSquaredErrors(const RgbImage& image, const RgbImage& reference) {
    std::vector<double> errors(image.pixels.size());
    for (size_t p = 0; p < errors.size(); ++p)
        errors[p] = channelMean(image, reference, p,
                                [](double i, double r) { return square(i - r) / (square(r) + kRelMseEpsilon); });
    return errors;
}

double trimmedMean(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto kept = static_cast<std::ptrdiff_t>(static_cast<double>(values.size()) * (1 - kTrimmedShare));
    const auto count = std::max<std::ptrdiff_t>(1, kept);
    return std::accumulate(values.begin(), values.begin() + count, 0.0) / static_cast<double>(count);
}

double smape(const RgbImage& image, const RgbImage& reference) {
    return pictureMean(image, reference, [](double i, double r) {
        return std::abs(i - r) / (std::abs(i) + std::abs(r) + kSmapeEpsilon);
    });
}

double peakSignalToNoiseRatio(const RgbImage& image, const RgbImage& reference, double peak) {
    return 10 * std::log10(square(peak) / meanSquaredError(image, reference));
}

}  // namespace lsde
