// The time limit of a run.
#pragma once

#include <limits>
#include <optional>

#include "base/run.h"

namespace lsde {

// CPU or wall seconds of the whole run, process start included, against a limit if there is one.
class Clock {
  public:
    Clock(std::optional<double> cpuLimit, std::optional<double> wallLimit)
        : cpu_(cpuLimit.has_value()), limit_(cpuLimit.value_or(wallLimit.value_or(kNone))) {}

    bool wall() const { return !cpu_; }
    bool limited() const { return limit_ < kNone; }
    double used() const { return cpu_ ? cpuSeconds() : wallSeconds(); }
    double limit() const { return limit_; }  // s; infinite if there is none
    double left() const { return limit_ - used(); }
    // The same clock with an earlier limit, `seconds` from now.
    Clock slice(double seconds) const {
        Clock c = *this;
        c.limit_ = used() + seconds;
        return c;
    }

  private:
    static constexpr double kNone = std::numeric_limits<double>::infinity();
    bool cpu_;
    double limit_;
};

}  // namespace lsde
