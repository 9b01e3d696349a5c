// Means with their standard errors.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/math.h"

namespace lsde::test {

class Mean {
  public:
    void add(double x) {
        ++count_;
        const double d = x - mean_;
        mean_ += d / static_cast<double>(count_);
        squares_ += d * (x - mean_);  // Welford 1962
    }
    double value() const { return mean_; }
    double standardError() const {
        return std::sqrt(squares_ / (static_cast<double>(count_) * static_cast<double>(count_ - 1)));
    }
    // Within `sigmas` standard errors, and the rounding of floats.
    bool agrees(double expected, double sigmas = 4) const {
        return std::fabs(mean_ - expected) <= sigmas * standardError() + 2e-5 * std::fabs(expected);
    }

  private:
    int64_t count_ = 0;
    double mean_ = 0, squares_ = 0;
};

inline bool agree(const Mean& a, const Mean& b, double sigmas = 4) {
    return std::fabs(a.value() - b.value()) <= sigmas * std::hypot(a.standardError(), b.standardError());
}

}  // namespace lsde::test
