// One value a pixel, and the separable filters that SSIM and FLIP are made of.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "base/parallel.h"

namespace lsde {

// Row by row, top row first.
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<double> values;

    Plane() = default;
    Plane(int w, int h) : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h)) {}
    std::span<double> row(int y) { return {values.data() + offset(y), static_cast<size_t>(width)}; }
    std::span<const double> row(int y) const { return {values.data() + offset(y), static_cast<size_t>(width)}; }

  private:
    size_t offset(int y) const { return static_cast<size_t>(y) * static_cast<size_t>(width); }
};

double mean(const Plane& plane);

// Calls body(y) for every row, on several threads.
void forEachRow(int height, ThreadPool& pool, const std::function<void(int y)>& body);

// out[x] = sum_i kernel[i] in[x + i - radius] along rows or columns, for a kernel of 2 radius + 1 weights; the pixels
// of the border are repeated beyond it.
Plane filterRows(const Plane& in, std::span<const double> kernel, ThreadPool& pool);
Plane filterColumns(const Plane& in, std::span<const double> kernel, ThreadPool& pool);

// exp(-x^2 / (2 sigma^2)) at x = -radius ... radius, scaled to the sum 1; sigma in pixels.
std::vector<double> gaussianKernel(double sigma, int radius);

}  // namespace lsde
