#include "sampling/wavelength.h"

#include <doctest/doctest.h>

#include <array>

#include "support/random.h"

using namespace lsde;

namespace {

// Mean weight of the wavelengths in [from, to) nm, over all of them: what light of that band alone looks like.
glm::dvec3 bandOf(double from, double to) {
    glm::dvec3 sum(0);
    for (int n = 1; n <= kWavelengths; ++n) {
        const double nm = wavelengthNm(static_cast<WavelengthId>(n));
        if (nm >= from && nm < to)
            sum += glm::dvec3(wavelengthWeight(static_cast<WavelengthId>(n))) / double{kWavelengths};
    }
    return sum;
}

}  // namespace

TEST_CASE("the mean weight of all wavelengths is one in every channel, and weights are bounded") {
    glm::dvec3 mean(0);
    float largest = 0;
    for (int n = 1; n <= kWavelengths; ++n) {
        const Rgb w = wavelengthWeight(static_cast<WavelengthId>(n));
        mean += glm::dvec3(w) / double{kWavelengths};
        largest = std::max(largest, maxComponent(glm::abs(w)));
    }
    for (int c = 0; c < 3; ++c) CHECK(mean[c] == doctest::Approx(1).epsilon(1e-6));
    CHECK(largest < 4.5);
    CHECK(wavelengthWeight(kAllWavelengths) == Rgb(1));
    CHECK(weighed(Rgb(1, 2, 3), kAllWavelengths) == Rgb(1, 2, 3));
}

// Sums over 1 nm of CIE 1931 (1 nm) times D65 (5 nm, linear between), through the matrix of Rec. 709, by the package
// Colour: another table, another interpolation.
TEST_CASE("bands of the spectrum have the colours that the observer's own tables give them") {
    struct Band {
        double from, to;
        glm::dvec3 rgb;
    };
    const Band bands[] = {
        {360, 430, {0.02206, -0.01982, 0.14408}},    {430, 470, {0.04310, -0.06135, 0.73428}},
        {470, 500, {-0.11997, 0.09383, 0.21965}},    {500, 530, {-0.25239, 0.32993, 0.00503}},
        {530, 560, {-0.09071, 0.42942, -0.04677}},   {560, 590, {0.35078, 0.24211, -0.03692}},
        {590, 620, {0.60792, 0.02201, -0.01497}},    {620, 660, {0.38854, -0.03077, -0.00403}},
        {660, 780.5, {0.05067, -0.00536, -0.00036}},
    };
    for (const Band& b : bands) {
        CAPTURE(b.from);
        const glm::dvec3 rgb = bandOf(b.from, b.to);
        for (int c = 0; c < 3; ++c) {
            CAPTURE(c);
            // Either end of a band falls between two wavelengths, which weigh up to 4.5 / 4095 each.
            CHECK(std::fabs(rgb[c] - b.rgb[c]) < 3e-3);
        }
    }
}

TEST_CASE("wavelengths ascend with their numbers, and a number from 0 to 1 draws each alike") {
    for (int n = 2; n <= kWavelengths; ++n)
        REQUIRE(wavelengthNm(static_cast<WavelengthId>(n)) > wavelengthNm(static_cast<WavelengthId>(n - 1)));
    CHECK(wavelengthNm(1) > 360);
    CHECK(wavelengthNm(kWavelengths) < 780);
    CHECK(sampleWavelength(0) == 1);
    CHECK(sampleWavelength(0.5F) == (kWavelengths + 1) / 2);
    CHECK(sampleWavelength(kOneMinusEpsilon) == kWavelengths);
}

TEST_CASE("the kernel between two wavelengths has the mean one over either, at the ends as well") {
    for (const float share : {0.01F, 0.1F, 0.7F, 1.0F})
        for (const int n : {1, 2, 40, 2048, 4000, kWavelengths}) {
            double sum = 0;
            for (int other = 1; other <= kWavelengths; ++other) {
                const auto a = static_cast<WavelengthId>(n), b = static_cast<WavelengthId>(other);
                REQUIRE(wavelengthKernel(a, b, share) == wavelengthKernel(b, a, share));
                sum += wavelengthKernel(a, b, share);
            }
            CAPTURE(share);
            CAPTURE(n);
            CHECK(sum / kWavelengths == doctest::Approx(1).epsilon(1e-5));
        }
    CHECK(wavelengthKernel(2000, 2300, 0.1F) == 0);
    CHECK(wavelengthKernel(2000, 2100, 0.1F) > 0);
}
