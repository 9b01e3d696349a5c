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
