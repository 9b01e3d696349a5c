#include "base/hash.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "base/math.h"

using namespace lsde;

TEST_CASE("mix64 gives the published sequence of SplitMix64") {
    // Its state starts at 0 and grows by the golden ratio; mix64 adds that itself.
    CHECK(mix64(0) == 0xe220a8397b1dcdafULL);
    CHECK(mix64(0x9e3779b97f4a7c15ULL) == 0x6e789e6aa1b965f4ULL);
    CHECK(mix64(2 * 0x9e3779b97f4a7c15ULL) == 0x06c45d188009454fULL);
}

TEST_CASE("mix64 maps different numbers to different ones") {
    std::vector<uint64_t> values;
    for (uint64_t i = 0; i < 100000; ++i) {
        values.push_back(mix64(i));
        values.push_back(mix64(i << 40 | 1));
    }
    std::ranges::sort(values);
    const auto duplicates = std::ranges::unique(values);
    CHECK(duplicates.size() == 1);  // 0 << 40 | 1 is 1
}

TEST_CASE("each bit of the input turns about half of mix64's bits") {
    constexpr int kTrials = 4096;
    for (int bit = 0; bit < 64; ++bit) {
        int turned = 0;
        for (uint64_t i = 0; i < kTrials; ++i) {
            const uint64_t x = i * 0x2545f4914f6cdd1dULL;
            turned += std::popcount(mix64(x) ^ mix64(x ^ (uint64_t{1} << bit)));
        }
        // 64 kTrials fair coins: mean 32 kTrials, standard deviation sqrt(64 kTrials) / 2, here within 5 of them.
        CAPTURE(bit);
        CHECK(std::abs(turned - 32 * kTrials) < 5 * 4 * 64);
    }
}

TEST_CASE("hashCombine depends on the order of its arguments") {
    CHECK(hashCombine(1, 2) != hashCombine(2, 1));
    CHECK(hashCombine(0, 0) != 0);
    CHECK(hashCombine(1, 2) == hashCombine(1, 2));
}

TEST_CASE("toUnitFloat is in [0,1), in even steps of 2^-24") {
    CHECK(toUnitFloat(0) == 0);
    CHECK(toUnitFloat(255) == 0);
    CHECK(toUnitFloat(256) == 0x1p-24F);
    CHECK(toUnitFloat(0x80000000U) == 0.5F);
    CHECK(toUnitFloat(0xffffffffU) == kOneMinusEpsilon);
    CHECK(kOneMinusEpsilon < 1);
}
