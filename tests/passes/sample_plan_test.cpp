#include "passes/sample_plan.h"

#include <doctest/doctest.h>

#include <numeric>

using namespace lsde;

namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr size_t kPixels = kWidth * kHeight;

constexpr size_t at(int x, int y) { return static_cast<size_t>(y) * kWidth + static_cast<size_t>(x); }

// Half of the samples are dark, half twice as bright as the pixel: sigma = mean.
SampleStatistics noisy(float mean) {
    SampleStatistics s;
    for (uint64_t i = 0; i < SamplePlan::kUniform; ++i) s.add(i % 2 == 0 ? 0 : 2 * mean);
    return s;
}
SampleStatistics even(float mean) {
    SampleStatistics s;
    for (uint64_t i = 0; i < SamplePlan::kUniform; ++i) s.add(mean);
    return s;
}

// Even, but for noisy columns 10 to 19.
std::vector<SampleStatistics> halfNoisy() {
    std::vector<SampleStatistics> all(kPixels, even(1));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 10; x < 20; ++x) all[at(x, y)] = noisy(1);
    return all;
}

}  // namespace

TEST_CASE("noisy pixels get more samples, all together as many as asked for") {
    SamplePlan plan(kWidth, kHeight);
    plan.adapt(halfNoisy());
    uint64_t total = 0;
    for (size_t i = 0; i < kPixels; ++i) {
        CHECK(plan.count(i, 8) == 8);
        CHECK(plan.count(i, 64) >= 8 + 56 / 4);
        total += plan.count(i, 64);
        for (uint64_t n = 1; n < 100; ++n) REQUIRE(plan.count(i, n) >= plan.count(i, n - 1));
    }
    CHECK(static_cast<double>(total) / kPixels == doctest::Approx(64).epsilon(0.01));
    CHECK(plan.count(at(15, 15), 64) > 3 * plan.count(at(30, 15), 64));
}

TEST_CASE("a pixel's samples do not depend on its own values") {
    std::vector<SampleStatistics> statistics = halfNoisy();
    SamplePlan before(kWidth, kHeight), after(kWidth, kHeight);
    before.adapt(statistics);
    // Same mean, so that the whole picture's stays: only the noise is another.
    statistics[at(30, 15)] = noisy(1);
    after.adapt(statistics);
    CHECK(after.count(at(30, 15), 1000) <= before.count(at(30, 15), 1000));
    CHECK(after.count(at(31, 15), 1000) > before.count(at(31, 15), 1000));
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
        CHECK(total / kPixels == doctest::Approx(64).epsilon(0.01));
    }
}

TEST_CASE("among the others a pixel's own values move no share but its neighbours'") {
    std::vector<SampleStatistics> statistics = halfNoisy();
    SamplePlan before(kWidth, kHeight), after(kWidth, kHeight);
    before.adapt(statistics);
    statistics[at(15, 15)].sumOfSquares *= 3;
    after.adapt(statistics);
    const auto rate = [](const SamplePlan& plan, int x, int y) {
        return static_cast<double>(plan.count(at(x, y), 1'000'000)) / 1e6;
    };
    // All rates share a factor that keeps their mean; what is left is the pixel's own.
    const double factor = rate(after, 12, 5) / rate(before, 12, 5);
    CHECK(rate(after, 15, 15) / rate(before, 15, 15) == doctest::Approx(factor).epsilon(1e-4));
    for (const auto& [x, y] : {std::pair(14, 14), std::pair(15, 14), std::pair(16, 15), std::pair(14, 16)})
        CHECK(rate(after, x, y) / rate(before, x, y) > 1.05 * factor);
    CHECK(rate(after, 17, 15) / rate(before, 17, 15) == doctest::Approx(factor).epsilon(1e-4));
}

TEST_CASE("samples go by the standard deviation, of equal means") {
    const auto withSigma = [](float sigma) {
        SampleStatistics s;
        for (uint64_t i = 0; i < SamplePlan::kUniform; ++i) s.add(i % 2 == 0 ? 1 - sigma : 1 + sigma);
        return s;
    };
    std::vector<SampleStatistics> statistics(kPixels, withSigma(0.25F));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 20; x < kWidth; ++x) statistics[at(x, y)] = withSigma(0.5F);
    SamplePlan plan(kWidth, kHeight);
    plan.adapt(statistics);
    const auto left = static_cast<double>(plan.count(at(5, 9), 100'000) - SamplePlan::kUniform);
    const auto right = static_cast<double>(plan.count(at(35, 9), 100'000) - SamplePlan::kUniform);
    CHECK(right / left == doctest::Approx(2).epsilon(0.001));
}
