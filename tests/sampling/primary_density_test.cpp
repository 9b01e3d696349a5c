#include "sampling/primary_density.h"

#include <doctest/doctest.h>

#include <cmath>

#include "support/chi_squared.h"
#include "support/random.h"
#include "support/statistics.h"

using namespace lsde;

namespace {

PrimaryPoint randomPoint(test::Random& random) {
    return {random.uniform(), random.uniform(), random.uniform(), random.uniform()};
}

// Worth 10 in a corner of two dimensions, 1 in the rest of half of the cube, nothing in the other half.
float worthOf(const PrimaryPoint& u) {
    if (u[0] < 0.25F && u[3] >= 0.75F) return 10;
    return u[1] < 0.5F ? 1 : 0;
}

std::vector<PrimaryDensity::Trial> trials(size_t count, uint32_t seed = 1) {
    test::Random random(seed);
    std::vector<PrimaryDensity::Trial> all(count);
    for (PrimaryDensity::Trial& t : all) {
        t.u = randomPoint(random);
        t.worth = worthOf(t.u);
    }
    return all;
}

}  // namespace

TEST_CASE("a density that has learnt nothing is even") {
    float pdf = 0;
    const PrimaryPoint u = {0.1F, 0.2F, 0.3F, 0.4F};
    for (const PrimaryDensity& density : {PrimaryDensity(), PrimaryDensity({}, 4), PrimaryDensity(trials(40), 4)}) {
        CHECK(density.even());
        CHECK(density.sample(u, pdf) == u);
        CHECK(pdf == 1);
        CHECK(density.pdf(u) == 1);
    }
    std::vector<PrimaryDensity::Trial> worthless = trials(5000);
    for (PrimaryDensity::Trial& t : worthless) t.worth = 0;
    CHECK(PrimaryDensity(worthless, 4).even());
}

TEST_CASE("samples have the density that is claimed for them") {
    const PrimaryDensity density(trials(20'000), 4);
    test::Random random(7);
    constexpr int kCells = 16;  // a side, of the plane of two dimensions
    const std::array<std::array<size_t, 2>, 3> planes = {{{0, 3}, {1, 2}, {0, 1}}};
    for (const auto& plane : planes) {
        const auto cellOf = [&](const PrimaryPoint& u) {
            return static_cast<size_t>(u[plane[0]] * kCells) * kCells + static_cast<size_t>(u[plane[1]] * kCells);
        };
        std::vector<double> observed(kCells * kCells), expected(kCells * kCells);
        constexpr int kSamples = 200'000;
        int otherwise = 0;
        for (int i = 0; i < kSamples; ++i) {
            float pdf = 0;
            const PrimaryPoint u = density.sample(randomPoint(random), pdf);
            otherwise += pdf == density.pdf(u) ? 0 : 1;
            ++observed[cellOf(u)];
        }
        CHECK(otherwise == 0);
        // Exact where no dimension is halved more than five times, nearly so else.
        constexpr uint32_t kSide = 32, kPoints = kSide * kSide * kSide * kSide;
        for (uint32_t i = 0; i < kPoints; ++i) {
            PrimaryPoint u{};
            for (size_t d = 0; d < 4; ++d) u[d] = (static_cast<float>(i >> (5 * d) & (kSide - 1)) + 0.5F) / kSide;
            expected[cellOf(u)] += static_cast<double>(density.pdf(u)) * kSamples / kPoints;
        }
        CHECK(test::chiSquared(observed, expected).accepted(3));
    }
}

TEST_CASE("what is worth more is sampled more, by its root mean square, and nothing is left out") {
    const PrimaryDensity density(trials(100'000), 4);
    const float corner = density.pdf({0.1F, 0.2F, 0.5F, 0.9F}), lit = density.pdf({0.9F, 0.2F, 0.5F, 0.4F});
    const float worthless = density.pdf({0.9F, 0.9F, 0.5F, 0.4F});
    CHECK(corner / lit == doctest::Approx(10).epsilon(0.1));
    // The mean of the boxes' root mean squares: 10 in a sixteenth, 1 in half of the rest.
    CHECK(worthless == doctest::Approx(PrimaryDensity::kFloor).epsilon(0.2));
    test::Mean mean, evenNoise;
    test::Random random(3);
    for (int i = 0; i < 100'000; ++i) {
        float pdf = 0;
        const float worth = worthOf(density.sample(randomPoint(random), pdf));
        mean.add(worth / pdf);
        evenNoise.add(worthOf(randomPoint(random)));
    }
    CHECK(mean.agrees(10.0 / 16 + 0.5 * 15 / 16));
    CHECK(mean.standardError() < 0.3 * evenNoise.standardError());
}

TEST_CASE("numbers that are not told apart stay even") {
    const PrimaryDensity density(trials(20'000), 2);
    test::Random random(5);
    for (int i = 0; i < 1000; ++i) {
        const PrimaryPoint even = randomPoint(random);
        float pdf = 0;
        const PrimaryPoint u = density.sample(even, pdf);
        CHECK(u[2] == even[2]);
        CHECK(u[3] == even[3]);
    }
}

TEST_CASE("a map of strata keeps them: each box has its share of a grid's points, to one in a row") {
    const PrimaryDensity density(trials(20'000), 4);
    // Along one axis, all others fixed: the map is monotone.
    for (size_t d = 0; d < 4; ++d) {
        float last = -1;
        for (int i = 0; i < 1000; ++i) {
            PrimaryPoint u = {0.3F, 0.6F, 0.2F, 0.7F};
            u[d] = (static_cast<float>(i) + 0.5F) / 1000;
            float pdf = 0;
            const float x = density.sample(u, pdf)[d];
            CHECK(x > last);
            last = x;
        }
    }
}
