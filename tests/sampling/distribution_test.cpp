#include "sampling/distribution.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "support/chi_squared.h"
#include "support/random.h"

using namespace lsde;

namespace {

std::vector<double> lopsidedWeights() {
    std::vector<double> weights(200);
    for (size_t i = 0; i < weights.size(); ++i)
        weights[i] = i % 7 == 0 ? 0 : std::exp(0.03 * static_cast<double>(i)) * static_cast<double>(1 + i % 3);
    return weights;
}

std::vector<float> picture(int width, int height) {
    std::vector<float> values;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            values.push_back(y == 3 || (x + y) % 5 == 0 ? 0 : static_cast<float>(1 + x * x % 11 + 2 * y));
    return values;
}

}  // namespace

TEST_CASE("indices are chosen in proportion to their weights") {
    const std::vector<double> weights = lopsidedWeights();
    const DiscreteDistribution d(weights);
    REQUIRE(d.size() == weights.size());
    CHECK(d.total() == doctest::Approx(std::accumulate(weights.begin(), weights.end(), 0.0)));
    constexpr int kSamples = 200'000;
    std::vector<double> observed(d.size()), expected;
    test::Random random(1);
    for (int i = 0; i < kSamples; ++i) {
        float u = random.uniform();
        ++observed[d.sample(u)];
    }
    double sum = 0;
    for (size_t i = 0; i < d.size(); ++i) {
        CHECK(d.pmf(i) == doctest::Approx(weights[i] / d.total()));
        expected.push_back(kSamples * weights[i] / d.total());
        sum += d.pmf(i);
    }
    CHECK(sum == doctest::Approx(1));
    CHECK(test::chiSquared(observed, expected).accepted(1));
}

TEST_CASE("the number that chose an index is uniform again, and independent of the choice") {
    const DiscreteDistribution d(std::vector<double>{1, 2, 1, 4});
    test::Random random(2);
    const auto sample = [&]() -> std::optional<Vec2> {
        float u = random.uniform();
        const size_t i = d.sample(u);
        REQUIRE(u >= 0);
        REQUIRE(u < 1);
        return Vec2((static_cast<float>(i) + 0.5F) / 4, u);
    };
    const auto density = [](double x, double) { return x < 0.25 || (x > 0.5 && x < 0.75) ? 0.5 : x < 0.5 ? 1.0 : 2.0; };
    CHECK(test::chiSquaredOnSquare({4, 50, 1, 200'000}, sample, density).accepted(1));
}

TEST_CASE("an index of weight zero is never chosen, be it first, last or between") {
    const DiscreteDistribution d(std::vector<double>{0, 0, 1, 0, 3, 0});
    for (float u : {0.0F, 0x1p-24F, 0.25F - 0x1p-25F, 0.25F, 0.5F, kOneMinusEpsilon}) {
        const bool low = u < 0.25F;
        CAPTURE(u);
        CHECK(d.sample(u) == (low ? 2U : 4U));
        CHECK(u < 1);
    }
}

TEST_CASE("choices follow the order of the numbers") {
    const DiscreteDistribution d(lopsidedWeights());
    size_t last = 0;
    for (int i = 0; i < 10'000; ++i) {
        float u = static_cast<float>(i) / 10'000;
        const size_t choice = d.sample(u);
        CHECK(choice >= last);
        last = choice;
    }
    CHECK(last == d.size() - 1);
}

TEST_CASE("weights that are all zero, or none, make an empty distribution") {
    CHECK(DiscreteDistribution().empty());
    CHECK(DiscreteDistribution(std::vector<double>{}).empty());
    const DiscreteDistribution zeros(std::vector<double>{0, 0});
    CHECK(zeros.empty());
    CHECK(zeros.pmf(1) == 0);
    CHECK(Distribution2D(std::vector<float>(6, 0.0F), 3, 2).empty());
}

TEST_CASE("weights that are no weights are refused by number") {
    const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(DiscreteDistribution(std::vector<double>{1, -2}),
                         "distribution: weight 1 is -2.000000, expected a finite number >= 0", Error);
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>{infinity}), Error);
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>{nan}), Error);
    CHECK_THROWS_AS(DiscreteDistribution(std::vector<double>{1e308, 1e308}), Error);
    CHECK_THROWS_WITH_AS(Distribution2D(std::vector<float>(5), 2, 3), "distribution: 5 values, expected 2 x 3", Error);
}

TEST_CASE("points of a picture are chosen in proportion to its values") {
    constexpr int kWidth = 17, kHeight = 9;
    const std::vector<float> values = picture(kWidth, kHeight);
    const Distribution2D d(values, kWidth, kHeight);
    test::Random random(3);
    const auto sample = [&]() -> std::optional<Vec2> {
        float pdf = 0;
        const Vec2 uv = d.sample(random.uniform2D(), pdf);
        REQUIRE(pdf > 0);
        REQUIRE(d.pdf(uv) == pdf);
        return uv;
    };
    const double total = std::accumulate(values.begin(), values.end(), 0.0);
    const auto density = [&](double x, double y) {
        const auto cell = static_cast<size_t>(y * kHeight) * kWidth + static_cast<size_t>(x * kWidth);
        return values[cell] / total * kWidth * kHeight;
    };
    // Two grid cells a side of each value: the density within one is even.
    CHECK(test::chiSquaredOnSquare({2 * kWidth, 2 * kHeight, 1, 200'000}, sample, density).accepted(1));
    CHECK(d.pdf({0.5F, -0.1F}) == 0);
    CHECK(d.pdf({1, 0.5F}) == 0);
}

TEST_CASE("a point at the very end of a cell stays in it") {
    // Columns of value in turn with empty ones, so many that rounding would carry a point into its neighbour.
    constexpr int kWidth = 4093;
    std::vector<float> values(kWidth);
    for (size_t i = 0; i < values.size(); i += 2) values[i] = 1;
    const Distribution2D d(values, kWidth, 1);
    for (int i = 0; i < 100'000; ++i) {
        float pdf = 0;
        const float u = std::min((static_cast<float>(i) + 1) / 2047, kOneMinusEpsilon);
        const Vec2 uv = d.sample({std::max(0.0F, u - 0x1p-24F), kOneMinusEpsilon}, pdf);
        REQUIRE(d.pdf(uv) == pdf);
    }
}
