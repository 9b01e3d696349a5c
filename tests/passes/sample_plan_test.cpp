#include "passes/sample_plan.h"

#include <doctest/doctest.h>

#include <bit>
#include <numeric>

using namespace lsde;

namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr size_t kPixels = kWidth * kHeight;

constexpr size_t at(int x, int y) { return static_cast<size_t>(y) * kWidth + static_cast<size_t>(x); }

// One half of the samples is darker than the pixel, the other brighter, by sigma.
SampleStatistics withSigma(float mean, float sigma) {
    SampleStatistics s;
    for (uint64_t i = 0; i < SamplePlan::kUniform; ++i)
        s.add(i, Rgb(mean + (i < SamplePlan::kUniform / 2 ? -sigma : sigma)), 0);
    return s;
}
SampleStatistics noisy(float mean) { return withSigma(mean, mean); }
SampleStatistics even(float mean) { return withSigma(mean, 0); }

// Even, but for noisy columns 10 to 19.
std::vector<SampleStatistics> halfNoisy() {
    std::vector<SampleStatistics> all(kPixels, even(1));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 10; x < 20; ++x) all[at(x, y)] = noisy(1);
    return all;
}

// Of pixels of mean 1 and a sigma of .25 on the left, of .5 from column 20 on.
SamplePlan planOfTwoSigmas() {
    std::vector<SampleStatistics> statistics(kPixels, withSigma(1, 0.25F));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 20; x < kWidth; ++x) statistics[at(x, y)] = withSigma(1, 0.5F);
    SamplePlan plan(kWidth, kHeight);
    plan.adapt(statistics);
    return plan;
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
        CHECK(plan.count(i, 64) >= 8);  // 2 + 62 / 8, and the power of two below
        total += plan.count(i, 64);
        for (uint64_t n = 1; n < 100; ++n) REQUIRE(plan.count(i, n) >= plan.count(i, n - 1));
    }
    CHECK(static_cast<double>(total) / kPixels == doctest::Approx(64).epsilon(0.04));
    CHECK(meanRate(plan) == doctest::Approx(1).epsilon(0.001));
    CHECK(plan.rate(at(15, 15)) > 3 * plan.rate(at(30, 15)));
}

TEST_CASE("a pixel's samples do not depend on its own values") {
    std::vector<SampleStatistics> statistics = halfNoisy();
    SamplePlan before(kWidth, kHeight), after(kWidth, kHeight);
    before.adapt(statistics);
    // Same mean, so that the whole picture's stays: only the noise is another.
    statistics[at(30, 15)] = noisy(1);
    after.adapt(statistics);
    CHECK(after.rate(at(30, 15)) <= before.rate(at(30, 15)));
    CHECK(after.rate(at(31, 15)) > before.rate(at(31, 15)));
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
        plan.adapt(std::vector<SampleStatistics>(kPixels, even(mean)));
        for (size_t i = 0; i < kPixels; ++i) CHECK(plan.count(i, 37) == 37);
    }
}

TEST_CASE("the samples asked for are given however few pixels are noisy") {
    for (const int side : {1, 3, 8, 20}) {
        CAPTURE(side);
        std::vector<SampleStatistics> statistics(kPixels, even(1));
        for (int y = 5; y < 5 + side; ++y)
            for (int x = 5; x < 5 + side; ++x) statistics[at(x, y)] = noisy(1);
        SamplePlan plan(kWidth, kHeight);
        plan.adapt(statistics);
        double total = 0;
        for (size_t i = 0; i < kPixels; ++i) total += static_cast<double>(plan.count(i, 64));
        CHECK(total / kPixels == doctest::Approx(64).epsilon(0.04));
        CHECK(meanRate(plan) == doctest::Approx(1).epsilon(0.001));
    }
}

TEST_CASE("among the others a pixel's own values move no share but its neighbours'") {
    std::vector<SampleStatistics> statistics = halfNoisy();
    SamplePlan before(kWidth, kHeight), after(kWidth, kHeight);
    before.adapt(statistics);
    statistics[at(15, 15)] = withSigma(1, 10);
    after.adapt(statistics);
    const auto rate = [](const SamplePlan& plan, int x, int y) { return plan.rate(at(x, y)); };
    // All rates share a factor that keeps their mean; what is left is the pixel's own.
    const float factor = rate(after, 12, 5) / rate(before, 12, 5);
    CHECK(rate(after, 15, 15) / rate(before, 15, 15) == doctest::Approx(factor).epsilon(1e-4));
    for (const auto& [x, y] : {std::pair(14, 14), std::pair(15, 14), std::pair(16, 15), std::pair(18, 12)})
        CHECK(rate(after, x, y) / rate(before, x, y) > 1.05F * factor);
    CHECK(rate(after, 19, 15) / rate(before, 19, 15) == doctest::Approx(factor).epsilon(1e-4));
}

TEST_CASE("samples go by the standard deviation, of equal means") {
    const SamplePlan plan = planOfTwoSigmas();
    CHECK(plan.rate(at(35, 9)) / plan.rate(at(5, 9)) == doctest::Approx(2).epsilon(0.001));
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
        const auto expected = [&](size_t pixel) {
            return SamplePlan::kUniform + plan.rate(pixel) * static_cast<double>(samples - SamplePlan::kUniform);
        };
        CHECK(left == doctest::Approx(expected(at(5, 9))).epsilon(0.08));
        CHECK(right == doctest::Approx(expected(at(35, 9))).epsilon(0.08));
    }
}

TEST_CASE("samples after the first change nothing") {
    SampleStatistics s = noisy(1);
    s.add(SamplePlan::kUniform, Rgb(100), 0);
    CHECK(s.sum[0] == noisy(1).sum[0]);
    CHECK(s.sum[1] == noisy(1).sum[1]);
}
