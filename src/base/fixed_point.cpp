#include "base/fixed_point.h"

#include <cmath>

#include "base/error.h"

namespace lsde {

namespace {
__extension__ using UInt128 = unsigned __int128;
}

Int128 toFixedPointSlow(double value) {
    const double scaled = std::ldexp(value, kFixedPointFraction);
    if (!(std::fabs(scaled) < 0x1p126))
        throw Error("a sum of light is not finite or beyond 1e22: " + std::to_string(value));
    return static_cast<Int128>(scaled);  // exact: above 2^53 a double is a whole number
}

double FixedRgb::toDouble(int c) const {
    return std::ldexp(static_cast<double>(channel[static_cast<size_t>(c)]), -kFixedPointFraction);
}

std::array<std::string, 3> FixedRgb::toHex() const {
    std::array<std::string, 3> out;
    for (size_t c = 0; c < 3; ++c) {
        auto bits = static_cast<UInt128>(channel[c]);
        out[c].assign(32, '0');
        for (size_t i = 32; i-- > 0; bits >>= 4) out[c][i] = "0123456789abcdef"[static_cast<unsigned>(bits & 15)];
    }
    return out;
}

FixedRgb FixedRgb::fromHex(const std::array<std::string, 3>& digits) {
    FixedRgb out;
    for (size_t c = 0; c < 3; ++c) {
        if (digits[c].size() != 32 || digits[c].find_first_not_of("0123456789abcdef") != std::string::npos)
            throw Error("fixed-point number \"" + digits[c] + "\": expected 32 hexadecimal digits");
        UInt128 bits = 0;
        for (const char d : digits[c]) bits = (bits << 4) | static_cast<unsigned>(d <= '9' ? d - '0' : d - 'a' + 10);
        out.channel[c] = static_cast<Int128>(bits);
    }
    return out;
}

}  // namespace lsde
