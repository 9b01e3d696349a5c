// Sums that do not depend on their order: 128-bit fixed point, one a channel.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "base/math.h"

namespace lsde {

__extension__ using Int128 = __int128;

// A value in units of 2^-52: from 2e-16 to 3e22, exact under addition in any order.
inline constexpr int kFixedPointFraction = 52;

// Nearest multiple of 2^-52. Throws Error if not finite or beyond the range.
Int128 toFixedPointSlow(double value);
inline Int128 toFixedPoint(double value) {
    const double scaled = value * 0x1p52;
    // Nearly all values of light fit 64 bits, where the conversion is one instruction.
    if (std::fabs(scaled) < 0x1p62) return std::llrint(scaled);
    return toFixedPointSlow(value);
}

struct FixedRgb {
    std::array<Int128, 3> channel{};

    FixedRgb() = default;
    explicit FixedRgb(Rgb c) : FixedRgb(c.x, c.y, c.z) {}
    FixedRgb(double r, double g, double b) : channel{toFixedPoint(r), toFixedPoint(g), toFixedPoint(b)} {}

    FixedRgb& operator+=(const FixedRgb& b) {
        for (int i = 0; i < 3; ++i) channel[i] += b.channel[i];
        return *this;
    }
    FixedRgb& operator-=(const FixedRgb& b) {
        for (int i = 0; i < 3; ++i) channel[i] -= b.channel[i];
        return *this;
    }
    friend FixedRgb operator+(FixedRgb a, const FixedRgb& b) { return a += b; }
    friend FixedRgb operator-(FixedRgb a, const FixedRgb& b) { return a -= b; }
    friend bool operator==(const FixedRgb&, const FixedRgb&) = default;

    double toDouble(int c) const;
    // 32 hexadecimal digits a channel, most significant first (two's complement): exact on disk.
    std::array<std::string, 3> toHex() const;
    static FixedRgb fromHex(const std::array<std::string, 3>& digits);
};

}  // namespace lsde
