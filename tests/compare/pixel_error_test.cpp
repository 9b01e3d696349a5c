#include "compare/pixel_error.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

using namespace lsde;

namespace {

// Two pixels: the first differs in red and green, the second is equal.
RgbImage image() {
    RgbImage out(2, 1, Rgb(0.5F));
    out.at(0, 0) = Rgb(0.75F, 0, -1);
    return out;
}
RgbImage reference() {
    RgbImage out(2, 1, Rgb(0.5F));
    out.at(0, 0) = Rgb(0.25F, 2, -1);
    return out;
}

}  // namespace

TEST_CASE("the mean squared error is over pixels and channels") {
    CHECK(meanSquaredError(image(), reference()) == doctest::Approx((0.25 + 4) / 6));
}

TEST_CASE("the relative squared error divides by the reference, kept from zero") {
    const auto errors = relativeSquaredErrors(image(), reference());
    REQUIRE(errors.size() == 2);
    CHECK(errors[0] == doctest::Approx((0.25 / 0.0725 + 4 / 4.01) / 3));
    CHECK(errors[1] == 0);
    // Picture and reference are not exchangeable.
    CHECK(relativeSquaredErrors(reference(), image())[0] == doctest::Approx((0.25 / 0.5725 + 4 / 0.01) / 3));
}

TEST_CASE("the trimmed mean leaves out one value of a thousand, wherever it is") {
    std::vector<double> values(2000, 1.0);
    values[7] = 1e30;
    values[1500] = 1e20;
    CHECK(trimmedMean(values) == 1);
    values[3] = 1001;  // a third one stays in: 1998 values of which one is 1001
    CHECK(trimmedMean(values) == doctest::Approx(1 + 1000.0 / 1998));
}

TEST_CASE("the trimmed mean of few values keeps all but the last, and one at least") {
    // int(n * 0.999), as in the yardstick of the project's ground truth.
    CHECK(trimmedMean({3, 1, 2}) == 1.5);
    CHECK(trimmedMean({5}) == 5);
}

TEST_CASE("the symmetric error takes both magnitudes, also of negative values") {
    CHECK(smape(image(), reference()) == doctest::Approx((0.5 / 1.01 + 2 / 2.01) / 6));
    CHECK(smape(reference(), image()) == smape(image(), reference()));
    CHECK(smape(RgbImage(1, 1, Rgb(-1)), RgbImage(1, 1, Rgb(1))) == doctest::Approx(2 / 2.01));
}

TEST_CASE("the peak signal-to-noise ratio falls by 20 dB when the error grows tenfold") {
    const RgbImage black(3, 2);
    CHECK(peakSignalToNoiseRatio(RgbImage(3, 2, Rgb(0.1F)), black, 1) == doctest::Approx(20));
    CHECK(peakSignalToNoiseRatio(RgbImage(3, 2, Rgb(1)), black, 1) == doctest::Approx(0));
    CHECK(peakSignalToNoiseRatio(RgbImage(3, 2, Rgb(1)), black, 10) == doctest::Approx(20));
    CHECK(std::isinf(peakSignalToNoiseRatio(black, black, 1)));
}
