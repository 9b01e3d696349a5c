#include "sampling/distribution.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"

namespace lsde {

DiscreteDistribution::DiscreteDistribution(std::span<const double> weights) {
    cdf_.reserve(weights.size() + 1);
    cdf_.push_back(0);
    for (size_t i = 0; i < weights.size(); ++i) {
        if (!(weights[i] >= 0) || !std::isfinite(weights[i]))
            throw Error("distribution: weight " + std::to_string(i) + " is " + std::to_string(weights[i]) +
                        ", expected a finite number >= 0");
        total_ += weights[i];
        cdf_.push_back(total_);
    }
    if (!std::isfinite(total_)) throw Error("distribution: the weights' sum overflows, expected a finite number");
    pmf_.assign(weights.size(), 0);
    if (empty()) return;
    for (size_t i = 0; i < weights.size(); ++i) pmf_[i] = static_cast<float>(weights[i] / total_);
    for (double& c : cdf_) c /= total_;
}

size_t DiscreteDistribution::sample(float& u) const {
    LSDE_ASSERT(!empty());
    // The first entry above u ends the interval chosen; one of no weight ends where it begins and is never found.
    const auto end = std::upper_bound(cdf_.begin(), cdf_.end(), static_cast<double>(u));
    const double lower = *(end - 1);
    u = std::min(static_cast<float>((u - lower) / (*end - lower)), kOneMinusEpsilon);
    return static_cast<size_t>(end - cdf_.begin()) - 1;
}

namespace {

int cellOf(float x, int cells) { return std::min(static_cast<int>(x * static_cast<float>(cells)), cells - 1); }

// Place u of the cell in [0,1); a result that rounding has put into a neighbour is moved back.
float placeInCell(size_t cell, float u, int cells) {
    const auto wanted = static_cast<int>(cell);
    float x = std::min((static_cast<float>(wanted) + u) / static_cast<float>(cells), kOneMinusEpsilon);
    while (cellOf(x, cells) > wanted) x = std::nextafter(x, 0.0F);
    while (cellOf(x, cells) < wanted) x = std::nextafter(x, 1.0F);
    return x;
}

}  // namespace

Distribution2D::Distribution2D(std::span<const float> values, int width, int height) {
    if (width <= 0 || height <= 0 || values.size() != static_cast<size_t>(width) * static_cast<size_t>(height))
        throw Error("distribution: " + std::to_string(values.size()) + " values, expected " + std::to_string(width) +
                    " x " + std::to_string(height));
    std::vector<DiscreteDistribution> rows;
    std::vector<double> totals;
    for (size_t y = 0; y < static_cast<size_t>(height); ++y) {
        const auto row = values.subspan(y * static_cast<size_t>(width), static_cast<size_t>(width));
        rows.emplace_back(std::vector<double>(row.begin(), row.end()));
        totals.push_back(rows.back().total());
    }
    marginal_ = DiscreteDistribution(totals);
    if (marginal_.empty()) return;
    rows_ = std::move(rows);
    width_ = width;
    height_ = height;
}

Vec2 Distribution2D::sample(Vec2 u, float& pdf) const {
    const size_t y = marginal_.sample(u.y);
    const size_t x = rows_[y].sample(u.x);
    pdf = marginal_.pmf(y) * rows_[y].pmf(x) * static_cast<float>(width_) * static_cast<float>(height_);
    return {placeInCell(x, u.x, width_), placeInCell(y, u.y, height_)};
}

float Distribution2D::pdf(Vec2 uv) const {
    if (empty() || !(uv.x >= 0 && uv.x < 1 && uv.y >= 0 && uv.y < 1)) return 0;
    const auto x = static_cast<size_t>(cellOf(uv.x, width_)), y = static_cast<size_t>(cellOf(uv.y, height_));
    return marginal_.pmf(y) * rows_[y].pmf(x) * static_cast<float>(width_) * static_cast<float>(height_);
}

}  // namespace lsde
