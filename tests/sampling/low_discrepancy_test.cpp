#include "sampling/low_discrepancy.h"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <set>
#include <vector>

#include "support/random.h"

using namespace lsde;

namespace {

// Whether each of the 2^m elementary intervals of 2^splitX by 2^(m - splitX) parts holds one of the 2^m points.
bool onePointEach(const std::vector<uint32_t>& x, const std::vector<uint32_t>& y, int m, int splitX) {
    std::vector<bool> taken(size_t{1} << m);
    for (size_t i = 0; i < taken.size(); ++i) {
        // By way of 64 bits: a shift by all 32 is no shift.
        const auto column = static_cast<size_t>(static_cast<uint64_t>(x[i]) >> (32 - splitX));
        const auto row = static_cast<size_t>(static_cast<uint64_t>(y[i]) >> (32 - (m - splitX)));
        const size_t cell = column << (m - splitX) | row;
        if (taken[cell]) return false;
        taken[cell] = true;
    }
    return true;
}

bool isNet(const std::vector<uint32_t>& x, const std::vector<uint32_t>& y, int m) {
    for (int splitX = 0; splitX <= m; ++splitX)
        if (!onePointEach(x, y, m, splitX)) return false;
    return true;
}

std::vector<uint32_t> scrambledBlock(uint64_t first, int m, int dimension, uint64_t seed) {
    std::vector<uint32_t> out;
    for (uint64_t i = 0; i < (uint64_t{1} << m); ++i) out.push_back(scrambledSobol(first + i, dimension, seed));
    return out;
}

using Point = std::array<uint32_t, kSobolTableDimensions>;

Point sobolPoint(uint64_t index) {
    Point p{};
    for (int d = 0; d < kSobolTableDimensions; ++d) p[static_cast<size_t>(d)] = sobolReversed(index, d);
    return p;
}

// Starts of aligned blocks of 2^12: low, beyond one byte table each, beyond 2^32.
constexpr std::array<uint64_t, 4> kBlocks = {0, uint64_t{5} << 12, uint64_t{3} << 32, 0xfedcba9876543000};

}  // namespace

TEST_CASE("reversing bits swaps the first with the last") {
    CHECK(reverseBits(1) == 0x80000000U);
    CHECK(reverseBits(0x0000f002U) == 0x400f0000U);
    CHECK(reverseBits(reverseBits(0x12345678U)) == 0x12345678U);
}

TEST_CASE("the first points are those that Joe and Kuo print") {
    // Their program walks in the order of the Gray code. Three dimensions, as multiples of 1/16.
    constexpr std::array<std::array<int, 3>, 8> kExpected = {
        {{0, 0, 0}, {8, 8, 8}, {12, 4, 4}, {4, 12, 12}, {6, 6, 10}, {14, 14, 2}, {10, 2, 14}, {2, 10, 6}}};
    for (uint64_t i = 0; i < kExpected.size(); ++i)
        for (int d = 0; d < 3; ++d) {
            CAPTURE(i);
            CAPTURE(d);
            CHECK(static_cast<int>(reverseBits(sobolReversed(i ^ (i >> 1), d)) >> 28) ==
                  kExpected[i][static_cast<size_t>(d)]);
        }
}

TEST_CASE("direction numbers are those of the published table, and of its recurrence worked out by hand") {
    constexpr std::array<uint32_t, kSobolTableDimensions> kFourth = {1, 15, 9, 5, 11, 3, 13, 5, 5},
                                                          kFifth = {1, 17, 29, 31, 31, 25, 11, 17, 5};
    for (int d = 0; d < kSobolTableDimensions; ++d) {
        CAPTURE(d);
        const uint32_t fourth = reverseBits(sobolReversed(1 << 3, d)) >> 28;
        const uint32_t fifth = reverseBits(sobolReversed(1 << 4, d)) >> 27;
        CHECK(fourth == kFourth[static_cast<size_t>(d)]);
        CHECK(fifth == kFifth[static_cast<size_t>(d)]);
    }
}

TEST_CASE("the first 2^9 points hit each of the 2^9 sub-cubes of half the side once") {
    // Sobol's property A, which the direction numbers were chosen for.
    std::set<uint32_t> orthants;
    for (uint64_t i = 0; i < 512; ++i) {
        uint32_t orthant = 0;
        for (const uint32_t digits : sobolPoint(i)) orthant = orthant << 1 | (digits & 1);
        orthants.insert(orthant);
    }
    CHECK(orthants.size() == 512);
}

TEST_CASE("a point is the exclusive or of the points of its index's bits, over all 64 of them") {
    test::Random random(1);
    for (int n = 0; n < 1000; ++n) {
        const uint64_t index = random.bits64();
        Point sum{};
        for (int bit = 0; bit < 64; ++bit)
            if (((index >> bit) & 1) != 0)
                for (size_t d = 0; d < sum.size(); ++d) sum[d] ^= sobolPoint(uint64_t{1} << bit)[d];
        REQUIRE(sobolPoint(index) == sum);
    }
}

TEST_CASE("points do not repeat after 2^32 of them") {
    // Over the two-element field: as many independent directions as index bits, so no two of 2^64 points agree.
    std::vector<Point> basis;
    for (int bit = 0; bit < 64; ++bit) {
        Point p = sobolPoint(uint64_t{1} << bit);
        for (const Point& b : basis) {
            size_t d = 0;
            while (b[d] == 0) ++d;
            if (((p[d] >> std::countr_zero(b[d])) & 1) != 0)
                for (size_t k = 0; k < p.size(); ++k) p[k] ^= b[k];
        }
        CAPTURE(bit);
        REQUIRE(p != Point{});
        basis.push_back(p);
    }
}

TEST_CASE("every scrambled dimension alone puts one point in each of 2^m intervals, in every aligned block") {
    for (int d = 0; d < kSobolTableDimensions; ++d)
        for (const uint64_t first : kBlocks)
            for (const int m : {1, 5, 8, 12}) {
                const auto x = scrambledBlock(first, m, d, 77 + static_cast<uint64_t>(d));
                CAPTURE(d);
                CAPTURE(first);
                CAPTURE(m);
                CHECK(onePointEach(x, x, m, m));
            }
}

TEST_CASE("the first two dimensions, scrambled apart, are a (0,m,2)-net in every aligned block") {
    test::Random random(2);
    for (int n = 0; n < 8; ++n)
        for (const uint64_t first : kBlocks)
            for (int m = 1; m <= 12; ++m) {
                const uint64_t seedX = random.bits64(), seedY = random.bits64();
                REQUIRE(isNet(scrambledBlock(first, m, 0, seedX), scrambledBlock(first, m, 1, seedY), m));
            }
}

TEST_CASE("the scramble leaves no trace of where the sequence begins") {
    // Over many seeds, the first four digits of point 0 and of point 1 take all values evenly; their first digits
    // differ, as they must, and the rest of them is independent.
    constexpr int kSeeds = 64'000;
    test::Random random(3);
    std::vector<double> counts(256);
    for (int n = 0; n < kSeeds; ++n) {
        const uint64_t seed = random.bits64();
        ++counts[scrambledSobol(0, 0, seed) >> 28 << 4 | scrambledSobol(1, 0, seed) >> 28];
    }
    for (size_t cell = 0; cell < counts.size(); ++cell) {
        const bool differ = ((cell ^ (cell >> 4)) & 8) != 0;
        CAPTURE(cell);
        // 500 expected, 5 sigma.
        CHECK(std::fabs(counts[cell] - (differ ? kSeeds / 128.0 : 0)) <= (differ ? 112 : 0));
    }
}

TEST_CASE("a digit of the input changes each later digit of the scramble half of the time, and none before it") {
    constexpr int kTrials = 4000;
    test::Random random(4);
    for (int in = 0; in < 24; ++in) {
        std::array<int, 32> flips{};
        for (int n = 0; n < kTrials; ++n) {
            const uint64_t seed = random.bits64();
            const auto x = static_cast<uint32_t>(random.bits64());
            const uint32_t d = owenScrambleReversed(x, seed) ^ owenScrambleReversed(x ^ (1U << in), seed);
            for (size_t out = 0; out < 32; ++out) flips[out] += static_cast<int>((d >> out) & 1);
        }
        CAPTURE(in);
        for (int out = 0; out < 32; ++out) {
            const int count = flips[static_cast<size_t>(out)];
            CAPTURE(out);
            if (out < in) CHECK(count == 0);
            if (out == in) CHECK(count == kTrials);
            if (out > in) CHECK(std::abs(count - kTrials / 2) < 160);  // 5 sigma
        }
    }
}

TEST_CASE("a shuffle permutes each aligned block of indices onto one") {
    for (const uint64_t seed : {uint64_t{1}, uint64_t{0x123456789abcdef0}})
        for (const uint64_t first : kBlocks)
            for (const int m : {0, 1, 4, 10}) {
                std::set<uint64_t> blocks, images;
                for (uint64_t i = 0; i < (uint64_t{1} << m); ++i) {
                    images.insert(shuffledIndex(first + i, seed));
                    blocks.insert(shuffledIndex(first + i, seed) >> m);
                }
                CHECK(images.size() == size_t{1} << m);
                CHECK(blocks.size() == 1);
            }
}
