#include "base/fixed_point.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/error.h"

using namespace lsde;

namespace {

// Powers over 16 decades, of both signs, as light paths bring them.
std::vector<Rgb> randomPowers(size_t count) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<float> exponent(-10, 6), sign(-1, 1);
    std::vector<Rgb> out(count);
    for (Rgb& c : out)
        for (int i = 0; i < 3; ++i) c[i] = std::copysign(std::pow(10.0F, exponent(random)), sign(random));
    return out;
}

}  // namespace

TEST_CASE("values become the nearest multiple of 2^-52") {
    CHECK(toFixedPoint(0) == 0);
    CHECK(toFixedPoint(1) == Int128{1} << 52);
    CHECK(toFixedPoint(-1) == -(Int128{1} << 52));
    CHECK(toFixedPoint(0x1p-52) == 1);
    CHECK(toFixedPoint(0x1.8p-52 + 0x1p-60) == 2);
    CHECK(toFixedPoint(0x0.7p-52) == 0);
    CHECK(toFixedPoint(-0x0.9p-52) == -1);
    CHECK(toFixedPoint(0x1.fffffffffffffp0) == (Int128{1} << 53) - 1);
    CHECK(toFixedPoint(0x1.8p73) == Int128{3} << 124);
    CHECK(toFixedPoint(-0x1.8p73) == -(Int128{3} << 124));
}

TEST_CASE("a value that is not finite or beyond the range is refused") {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN(), 0x1p74, -0x1p74, 1e300}) {
        CAPTURE(bad);
        CHECK_THROWS_AS(toFixedPoint(bad), Error);
        CHECK_THROWS_AS(FixedRgb(0, bad, 0), Error);
    }
}

TEST_CASE("a float comes back as it went in") {
    for (const Rgb c : randomPowers(1000)) {
        const FixedRgb fixed(c);
        for (int i = 0; i < 3; ++i)
            if (std::fabs(c[i]) > 1e-8F)  // 24 bits of it lie above 2^-52
                REQUIRE(fixed.toDouble(i) == static_cast<double>(c[i]));
    }
    CHECK(FixedRgb(0.25, -3, 1e15).toDouble(2) == 1e15);
    CHECK(FixedRgb(0.25, -3, 1e15).toDouble(1) == -3);
}

TEST_CASE("a sum does not depend on its order, and takes back exactly what was added") {
    std::vector<Rgb> powers = randomPowers(20000);
    FixedRgb forward;
    for (const Rgb c : powers) forward += FixedRgb(c);
    std::shuffle(powers.begin(), powers.end(), std::mt19937_64(1));
    FixedRgb shuffled, halves[2];
    for (size_t i = 0; i < powers.size(); ++i) {
        shuffled += FixedRgb(powers[i]);
        halves[i % 2] += FixedRgb(powers[i]);
    }
    CHECK(shuffled == forward);
    CHECK(halves[0] + halves[1] == forward);
    for (const Rgb c : powers) shuffled -= FixedRgb(c);
    CHECK(shuffled == FixedRgb());
    CHECK(forward - forward == FixedRgb());
    CHECK(!(forward == FixedRgb()));
}

TEST_CASE("hexadecimal digits keep every bit of both signs") {
    const FixedRgb value(1, -0x1p-52, 0x1.8p73);
    const auto digits = value.toHex();
    CHECK(digits[0] == "00000000000000000010000000000000");
    CHECK(digits[1] == "ffffffffffffffffffffffffffffffff");
    CHECK(digits[2] == "30000000000000000000000000000000");
    CHECK(FixedRgb::fromHex(digits) == value);
    FixedRgb sum;
    for (const Rgb c : randomPowers(1000)) {
        sum += FixedRgb(c);
        REQUIRE(FixedRgb::fromHex(sum.toHex()) == sum);
    }
}

TEST_CASE("digits that are not 32 lower-case hexadecimal ones are refused") {
    const std::string zero(32, '0');
    CHECK(FixedRgb::fromHex({zero, zero, zero}) == FixedRgb());
    for (const std::string& bad :
         {std::string(), std::string(31, '0'), std::string(33, '0'), std::string(31, '0') + "g",
          std::string(31, '0') + "A", "-" + std::string(31, '0'), std::string(32, ' ')}) {
        CAPTURE(bad);
        CHECK_THROWS_AS(FixedRgb::fromHex({zero, bad, zero}), Error);
    }
}
