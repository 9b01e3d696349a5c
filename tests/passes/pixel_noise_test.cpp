#include "passes/pixel_noise.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "support/random.h"
#include "support/statistics.h"

using namespace lsde;

namespace {

constexpr int kWidth = 40, kHeight = 24;

constexpr size_t at(int x, int y) { return static_cast<size_t>(y) * kWidth + static_cast<size_t>(x); }

// One sample of each pixel.
std::vector<SampleStatistics> pictureOf(const std::function<float(int, int)>& value) {
    std::vector<SampleStatistics> all(kWidth * kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) all[at(x, y)].add(0, Rgb(value(x, y)), 0);
    return all;
}

// Of mean 1 and a standard deviation of .1.
std::vector<SampleStatistics> noise(uint32_t seed) {
    test::Random random(seed);
    return pictureOf([&](int, int) { return random.uniform() < 0.5F ? 0.9F : 1.1F; });
}

}  // namespace

TEST_CASE("single samples of neighbours tell their variance, at the picture's edges as well") {
    test::Mean inside, edge, corner, absolute;
    for (uint32_t seed = 0; seed < 600; ++seed) {
        const std::vector<SampleStatistics> statistics = noise(seed);
        const std::vector<float> relative = relativeVariance(statistics, kWidth, kHeight);
        inside.add(static_cast<double>(relative[at(9, 9)]));
        edge.add(static_cast<double>(relative[at(0, 12)]));
        corner.add(static_cast<double>(relative[at(kWidth - 1, kHeight - 1)]));
        absolute.add(static_cast<double>(varianceOfOneSample(statistics, kWidth, kHeight)[at(30, 12)]));
    }
    const double expected = 0.01 / 2;  // over 1 of the pixel and 1 of the picture
    for (const test::Mean& mean : {inside, edge, corner}) {
        CHECK(std::fabs(mean.value() / expected - 1) < 0.1);
        CHECK(mean.standardError() < 0.03 * expected);
    }
    CHECK(std::fabs(absolute.value() / 0.01 - 1) < 0.1);
}

TEST_CASE("a gradient is no noise") {
    const std::vector<float> relative = relativeVariance(
        pictureOf([](int x, int y) { return 1 + 0.02F * static_cast<float>(x) + 0.01F * static_cast<float>(y); }),
        kWidth, kHeight);
    for (const float v : relative) CHECK(v < 1e-9F);
}

TEST_CASE("an edge is noise where it is") {
    const std::vector<float> relative =
        relativeVariance(pictureOf([](int x, int) { return x < 30 ? 1.0F : 0.2F; }), kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
        for (const int x : {29, 30}) CHECK(relative[at(x, y)] > 0.02F);
        // Further away only the wide square sees it.
        for (const int x : {26, 33}) CHECK(relative[at(x, y)] < 0.1F * relative[at(30, y)]);
        for (const int x : {25, 34}) CHECK(relative[at(x, y)] == 0);
    }
}

TEST_CASE("a pixel's own sample tells nothing of its noise, but of its neighbours'") {
    std::vector<SampleStatistics> statistics = noise(1);
    const std::vector<float> before = relativeVariance(statistics, kWidth, kHeight);
    // Two that change places, so that the picture's mean stays.
    size_t dark = at(10, 8), bright = at(30, 15);
    while (statistics[dark].first > 1) ++dark;
    while (statistics[bright].first < 1) ++bright;
    std::swap(statistics[dark], statistics[bright]);
    const std::vector<float> after = relativeVariance(statistics, kWidth, kHeight);
    for (const size_t pixel : {dark, bright}) {
        CHECK(std::fabs(after[pixel] / before[pixel] - 1) < 1e-4F);
        for (const size_t neighbour : {pixel - 1, pixel + 1, pixel - kWidth, pixel + kWidth + 1})
            CHECK(after[neighbour] != before[neighbour]);
    }
}

TEST_CASE("in pictures too small for three pixels no noise is seen") {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(2, 2), std::pair(2, 1)}) {
        std::vector<SampleStatistics> statistics(static_cast<size_t>(width) * static_cast<size_t>(height));
        for (size_t i = 0; i < statistics.size(); ++i) statistics[i].add(0, Rgb(static_cast<float>(i)), 0);
        for (const float v : relativeVariance(statistics, width, height)) CHECK(v == 0);
    }
    std::vector<SampleStatistics> line(5);
    for (size_t i = 0; i < line.size(); ++i) line[i].add(0, Rgb(i == 2 ? 1.0F : 0.0F), 0);
    CHECK(relativeVariance(line, 5, 1)[0] > 0);
    CHECK(relativeVariance(line, 1, 5)[0] > 0);
}

TEST_CASE("samples after the first change nothing of what the first one said") {
    SampleStatistics s;
    s.add(0, Rgb(2), 0);
    s.add(1, Rgb(100), 0);
    CHECK(s.first == doctest::Approx(2));
}
