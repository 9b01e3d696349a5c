#include "passes/sample_plan.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <numeric>

using namespace lsde;

namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr size_t kPixels = kWidth * kHeight;

constexpr size_t at(int x, int y) { return static_cast<size_t>(y) * kWidth + static_cast<size_t>(x); }

// First samples that are darker and brighter than the mean by sigma, as the squares of a chessboard.
SampleStatistics withSigma(float mean, float sigma, int x, int y) {
    SampleStatistics s;
    s.add(0, Rgb(mean + ((x + y) % 2 == 0 ? sigma : -sigma)), 0);
    return s;
}

// Even, but for a noisy rectangle.
std::vector<SampleStatistics> noisyWithin(int left, int top, int right, int bottom, float mean = 1) {
    std::vector<SampleStatistics> all(kPixels);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool noisy = left <= x && x < right && top <= y && y < bottom;
            all[at(x, y)] = withSigma(mean, noisy ? mean : 0, x, y);
        }
    return all;
}
std::vector<SampleStatistics> halfNoisy() { return noisyWithin(10, 0, 20, kHeight); }

// Of pixels of mean 1 and a sigma of .05 on the left, of .1 from column 20 on.
SamplePlan planOfTwoSigmas() {
    std::vector<SampleStatistics> statistics(kPixels);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) statistics[at(x, y)] = withSigma(1, x < 20 ? 0.05F : 0.1F, x, y);
    SamplePlan plan(kWidth, kHeight);
    plan.adapt(statistics);
    return plan;
}

// Mean of a pixel's count over what is left to chance.
double expected(const SamplePlan& plan, size_t pixel, uint64_t samples) {
    return SamplePlan::kUniform + plan.rate(pixel) * static_cast<double>(samples - SamplePlan::kUniform);
}

double meanRate(const SamplePlan& plan) {
    double sum = 0;
    for (size_t i = 0; i < kPixels; ++i) sum += plan.rate(i);
    return sum / kPixels;
}

}  // namespace

TEST_CASE("noisy pixels get more samples, all together as many as asked for") {
    SamplePlan plan(kWidth, kHeight);
    plan.adapt(halfNoisy());
    uint64_t total = 0;
    for (size_t i = 0; i < kPixels; ++i) {
        CHECK(plan.count(i, SamplePlan::kUniform) == SamplePlan::kUniform);
        CHECK(plan.count(i, 64) >= 8);  // 1 + 63 / 8, and the power of two below
        total += plan.count(i, 64);
        for (uint64_t n = 1; n < 100; ++n) REQUIRE(plan.count(i, n) >= plan.count(i, n - 1));
    }
    CHECK(static_cast<double>(total) / kPixels == doctest::Approx(64).epsilon(0.04));
    CHECK(meanRate(plan) == doctest::Approx(1).epsilon(0.001));
    CHECK(plan.rate(at(15, 15)) > 3 * plan.rate(at(30, 15)));
}

TEST_CASE("of less than one sample a pixel those that have it lie on a lattice") {
    const SamplePlan plan(kWidth, kHeight);
    for (const int spacing : {2, 4, 8})
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                REQUIRE(plan.count(at(x, y), 1.0 / (spacing * spacing)) ==
                        (x % spacing == 0 && y % spacing == 0 ? 1 : 0));
}

TEST_CASE("numbers of samples may be fractions: as many pixels get one more") {
    const SamplePlan even(kWidth, kHeight);
    const SamplePlan adapted = planOfTwoSigmas();
    for (const SamplePlan* plan : {&even, &adapted})
        for (const double mean : {1.25, 1.75, 7.5, 40.25}) {
            CAPTURE(mean);
            double total = 0;
            for (size_t i = 0; i < kPixels; ++i) {
                total += static_cast<double>(plan->count(i, mean));
                REQUIRE(plan->count(i, mean) >= plan->count(i, mean - 0.25));
            }
            CHECK(total / kPixels == doctest::Approx(mean).epsilon(0.03));
        }
    CHECK(even.count(7, 1) == 1);
    CHECK(even.count(7, 5) == 5);
}

TEST_CASE("without noise every pixel gets the same") {
    for (const float mean : {0.0F, 1.0F}) {
        SamplePlan plan(kWidth, kHeight);
        plan.adapt(noisyWithin(0, 0, 0, 0, mean));
        for (size_t i = 0; i < kPixels; ++i) CHECK(plan.count(i, 37) == 37);
    }
}

TEST_CASE("the samples asked for are given however few pixels are noisy") {
    for (const int side : {1, 3, 8, 20}) {
        CAPTURE(side);
        SamplePlan plan(kWidth, kHeight);
        plan.adapt(noisyWithin(5, 5, 5 + side, 5 + side));
        // Each is one of two powers of two, by chance.
        double total = 0, variance = 0;
        for (size_t i = 0; i < kPixels; ++i) {
            total += static_cast<double>(plan.count(i, 64));
            const double n = expected(plan, i, 64), lower = std::exp2(std::floor(std::log2(n)));
            variance += (n - lower) * (2 * lower - n);
        }
        CHECK(std::fabs(total - 64 * kPixels) < 3 * std::sqrt(variance));
        CHECK(meanRate(plan) == doctest::Approx(1).epsilon(0.001));
    }
}

TEST_CASE("a pixel's own sample moves no share but its neighbours'") {
    // Two that change places keep the picture's mean.
    std::vector<SampleStatistics> statistics = halfNoisy();
    SamplePlan before(kWidth, kHeight), after(kWidth, kHeight);
    before.adapt(statistics);
    std::swap(statistics[at(15, 15)], statistics[at(12, 3)]);
    REQUIRE(statistics[at(15, 15)].first != statistics[at(12, 3)].first);
    after.adapt(statistics);
    const auto growth = [&](int x, int y) { return after.rate(at(x, y)) / before.rate(at(x, y)); };
    // All rates share a factor that keeps their mean; what is left is the pixel's own.
    const float factor = growth(13, 24);
    CHECK(growth(15, 15) == doctest::Approx(factor).epsilon(1e-4));
    CHECK(growth(12, 3) == doctest::Approx(factor).epsilon(1e-4));
    for (const auto& [x, y] : {std::pair(14, 14), std::pair(15, 14), std::pair(16, 15), std::pair(18, 15)})
        CHECK(std::fabs(growth(x, y) / factor - 1) > 0.002F);
}

TEST_CASE("samples go by a power of the variance, of equal means") {
    const SamplePlan plan = planOfTwoSigmas();
    CHECK(plan.rate(at(35, 9)) / plan.rate(at(5, 9)) == doctest::Approx(std::pow(4, 1 / 2.35)).epsilon(0.005));
}

TEST_CASE("counts are powers of two whose mean is the pixel's rate") {
    const SamplePlan plan = planOfTwoSigmas();
    for (const uint64_t samples : {13, 47, 100, 3000}) {
        CAPTURE(samples);
        double left = 0, right = 0;
        for (int y = 5; y < 25; ++y)
            for (int x = 4; x < 15; ++x) {
                REQUIRE(std::has_single_bit(plan.count(at(x, y), samples)));
                left += static_cast<double>(plan.count(at(x, y), samples)) / 220;
                right += static_cast<double>(plan.count(at(x + 20, y), samples)) / 220;
            }
        CHECK(left == doctest::Approx(expected(plan, at(5, 9), samples)).epsilon(0.08));
        CHECK(right == doctest::Approx(expected(plan, at(35, 9), samples)).epsilon(0.08));
    }
}
