#include "compare/plane.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lsde {

namespace {

constexpr size_t kRowsPerChunk = 8;

// out += weight * in
void addScaled(std::span<double> out, std::span<const double> in, double weight) {
    for (size_t x = 0; x < out.size(); ++x) out[x] += weight * in[x];
}

}  // namespace

double mean(const Plane& plane) {
    return std::accumulate(plane.values.begin(), plane.values.end(), 0.0) / static_cast<double>(plane.values.size());
}

void forEachRow(int height, ThreadPool& pool, const std::function<void(int y)>& body) {
    pool.forRange(static_cast<size_t>(height), kRowsPerChunk, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y) body(static_cast<int>(y));
    });
}

Plane filterRows(const Plane& in, std::span<const double> kernel, ThreadPool& pool) {
    Plane out(in.width, in.height);
    const size_t radius = kernel.size() / 2;
    forEachRow(in.height, pool, [&](int y) {
        const auto row = in.row(y);
        std::vector<double> padded(row.size() + 2 * radius);
        std::fill_n(padded.begin(), radius, row.front());
        std::copy(row.begin(), row.end(), padded.begin() + static_cast<std::ptrdiff_t>(radius));
        std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, row.back());
        for (size_t i = 0; i < kernel.size(); ++i)
            addScaled(out.row(y), std::span(padded).subspan(i, row.size()), kernel[i]);
    });
    return out;
}

Plane filterColumns(const Plane& in, std::span<const double> kernel, ThreadPool& pool) {
    Plane out(in.width, in.height);
    const int radius = static_cast<int>(kernel.size() / 2);
    forEachRow(in.height, pool, [&](int y) {
        for (size_t i = 0; i < kernel.size(); ++i) {
            const int source = std::clamp(y + static_cast<int>(i) - radius, 0, in.height - 1);
            addScaled(out.row(y), in.row(source), kernel[i]);
        }
    });
    return out;
}

std::vector<double> gaussianKernel(double sigma, int radius) {
    std::vector<double> kernel;
    for (int x = -radius; x <= radius; ++x) kernel.push_back(std::exp(-x * x / (2 * sigma * sigma)));
    const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
    for (double& weight : kernel) weight /= sum;
    return kernel;
}

}  // namespace lsde
