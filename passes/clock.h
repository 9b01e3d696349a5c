// The time limit of a run.
#pragma once

#include <optional>

#include "base/run.h"

namespace lsde {

// CPU or wall seconds of the whole run, process start included, against a limit if there is one.
class Clock {
  public:
    Clock(std::optional<double> cpuLimit, std::optional<double> wallLimit)
        : cpu_(cpuLimit.has_value()), limit_(cpu_ ? cpuLimit : wallLimit) {}

    bool limited() const { return limit_.has_value(); }
    double used() const { return cpu_ ? cpuSeconds() : wallSeconds(); }
    double limit() const { return *limit_; }
    double left() const { return *limit_ - used(); }
    // The same clock with an earlier limit, `seconds` from now.
    Clock slice(double seconds) const {
        Clock c = *this;
        c.limit_ = used() + seconds;
        return c;
    }

  private:
    bool cpu_;
    std::optional<double> limit_;
};

}  // namespace lsde
