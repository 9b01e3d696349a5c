#include "compare/ssim.h"

#include <limits>

#include "base/math.h"

namespace lsde {

namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = square(0.01);  // (K1 L)^2
constexpr double kC2 = square(0.03);  // (K2 L)^2

// Mean of a*b over the window around every pixel.
Plane windowMean(const Plane& a, const Plane& b, std::span<const double> kernel, ThreadPool& pool) {
    Plane product(a.width, a.height);
    for (size_t i = 0; i < product.values.size(); ++i) product.values[i] = a.values[i] * b.values[i];
    return filterColumns(filterRows(product, kernel, pool), kernel, pool);
}

}  // namespace

double structuralSimilarity(const Plane& image, const Plane& reference, ThreadPool& pool) {
    const int width = image.width - 2 * kRadius;
    const int height = image.height - 2 * kRadius;
    if (width <= 0 || height <= 0) return std::numeric_limits<double>::quiet_NaN();

    const auto kernel = gaussianKernel(kSigma, kRadius);
    const Plane meanI = filterColumns(filterRows(image, kernel, pool), kernel, pool);
    const Plane meanR = filterColumns(filterRows(reference, kernel, pool), kernel, pool);
    const Plane meanII = windowMean(image, image, kernel, pool);
    const Plane meanRR = windowMean(reference, reference, kernel, pool);
    const Plane meanIR = windowMean(image, reference, kernel, pool);
    double sum = 0;
    for (int y = kRadius; y < kRadius + height; ++y) {
        const auto x0 = static_cast<size_t>(kRadius);
        for (size_t x = x0; x < x0 + static_cast<size_t>(width); ++x) {
            const double i = meanI.row(y)[x];
            const double r = meanR.row(y)[x];
            const double variances = meanII.row(y)[x] - i * i + meanRR.row(y)[x] - r * r;
            const double covariance = meanIR.row(y)[x] - i * r;
            // eq. 13 of the paper
            sum += (2 * i * r + kC1) * (2 * covariance + kC2) / ((i * i + r * r + kC1) * (variances + kC2));
        }
    }
    return sum / (static_cast<double>(width) * static_cast<double>(height));
}

}  // namespace lsde
