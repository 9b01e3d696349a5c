#include "sampling/sampler.h"

#include <doctest/doctest.h>

#include <functional>
#include <vector>

#include "support/chi_squared.h"

using namespace lsde;

namespace {

constexpr int kFirstPadded = Sampler::kSobolDimensions;

float dimensionOf(Sampler sampler, int dimension) {
    sampler.skipTo(dimension);
    return sampler.next();
}

// A pair of numbers for each n: are they independent and uniform? Joint counts on 16 x 16 cells.
bool independent(const std::function<Vec2(uint32_t)>& pair, int tests) {
    uint32_t n = 0;
    const test::SquareGrid grid{16, 16, 1, 1 << 14};
    const auto result = test::chiSquaredOnSquare(
        grid, [&]() -> std::optional<Vec2> { return pair(n++); }, [](double, double) { return 1.0; });
    INFO("p = ", result.p);
    return result.accepted(tests);
}

// Root mean square error over seeds of the mean of a smooth function with integral 1 over four dimensions, in units of
// what as many independent random points give.
double errorAgainstRandom(const std::function<Sampler(uint64_t seed, uint32_t i)>& sampler, uint32_t points) {
    constexpr int kSeeds = 32;
    double squares = 0;
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
        double sum = 0;
        for (uint32_t i = 0; i < points; ++i) {
            Sampler s = sampler(seed, i);
            double f = 1;
            for (int d = 0; d < 4; ++d) {
                const double x = s.next();
                f *= 0.5 + 1.5 * x * x;
            }
            sum += f;
        }
        squares += square(sum / points - 1);
    }
    const double factorVariance = 2.25 * (1.0 / 5 - 1.0 / 9);
    const double variance = std::pow(1 + factorVariance, 4) - 1;
    return std::sqrt(squares / kSeeds) / std::sqrt(variance / points);
}

}  // namespace

TEST_CASE("the same key gives the same numbers, and every part of a key changes them") {
    const auto first = [](Sampler s) { return std::vector<float>{s.next(), s.next(), s.next()}; };
    const auto sequence = first(Sampler::sequence(1, Stage::Emission, 5));
    CHECK(sequence == first(Sampler::sequence(1, Stage::Emission, 5)));
    CHECK(sequence != first(Sampler::sequence(2, Stage::Emission, 5)));
    CHECK(sequence != first(Sampler::sequence(1, Stage::EmissionPilot, 5)));
    CHECK(sequence != first(Sampler::sequence(1, Stage::Emission, 6)));
    CHECK(sequence != first(Sampler::sequence(1, Stage::Emission, 5 + (uint64_t{1} << 32))));
    const auto pixel = first(Sampler::pixel(1, Stage::Camera, 3, 4, 5));
    CHECK(pixel == first(Sampler::pixel(1, Stage::Camera, 3, 4, 5)));
    CHECK(pixel != first(Sampler::pixel(1, Stage::Reference, 3, 4, 5)));
    CHECK(pixel != first(Sampler::pixel(1, Stage::Camera, 4, 3, 5)));
    CHECK(pixel != first(Sampler::pixel(1, Stage::Camera, 3, 4, 6)));
}

TEST_CASE("every dimension is uniform in [0,1), low-discrepancy or not") {
    for (const bool perPixel : {false, true})
        for (const int d : {0, 1, 4, 7, 8, 9, 11, 12, 100, 5001}) {
            CAPTURE(perPixel);
            CAPTURE(d);
            constexpr uint32_t kSamples = 1 << 14;
            double sum = 0, squares = 0;
            for (uint32_t i = 0; i < kSamples; ++i) {
                const float u = dimensionOf(
                    perPixel ? Sampler::pixel(1, Stage::Test, 8, 9, i) : Sampler::sequence(1, Stage::Test, i), d);
                REQUIRE(u >= 0);
                REQUIRE(u < 1);
                sum += u;
                squares += static_cast<double>(u) * u;
            }
            // 4 sigma of random numbers.
            CHECK(sum / kSamples == doctest::Approx(0.5).epsilon(0.009 / 0.5));
            CHECK(squares / kSamples == doctest::Approx(1.0 / 3).epsilon(0.0094 * 3));
        }
}

TEST_CASE("a dimension keeps its number whatever was drawn before it") {
    for (const Sampler& start : {Sampler::sequence(7, Stage::Test, 123), Sampler::pixel(7, Stage::Test, 1, 2, 3)})
        for (const int d : {3, 6, 8, 13, 30}) {
            Sampler idle = start, busy = start;
            for (int i = 0; i < d - 1; ++i) busy.next();
            idle.skipTo(d);
            busy.skipTo(d);
            CAPTURE(d);
            CHECK(idle.next() == busy.next());
            CHECK(idle.next2D() == busy.next2D());
        }
    Sampler s = Sampler::sequence(7, Stage::Test, 123), same = s;
    s.skipTo(5);
    same.skipTo(5);
    s.skipTo(2);
    CHECK(s.next() == same.next());
}

TEST_CASE("pairs are drawn from one set of dimensions") {
    const Sampler start = Sampler::pixel(3, Stage::Test, 5, 6, 7);
    for (const int last : {kFirstPadded - 1, kFirstPadded + Sampler::kSetDimensions - 1}) {
        Sampler atLast = start, atNext = start;
        atLast.skipTo(last);
        atNext.skipTo(last + 1);
        CHECK(atLast.next2D() == atNext.next2D());
    }
}

TEST_CASE("streams of different seeds, stages, pixels and branches are independent") {
    const auto pixel = [](uint32_t x, uint32_t y) { return Sampler::pixel(1, Stage::Camera, x, y, 5); };
    constexpr int kTests = 5 * 4;
    for (const int d : {0, 3, 8, 14}) {
        CAPTURE(d);
        CHECK(independent(
            [&](uint32_t n) {
                return Vec2(dimensionOf(Sampler::sequence(n, Stage::Emission, 9), d),
                            dimensionOf(Sampler::sequence(n + 1, Stage::Emission, 9), d));
            },
            kTests));
        CHECK(independent(
            [&](uint32_t n) {
                return Vec2(dimensionOf(Sampler::sequence(n, Stage::Emission, 9), d),
                            dimensionOf(Sampler::sequence(n, Stage::LightTracer, 9), d));
            },
            kTests));
        CHECK(independent(
            [&](uint32_t n) { return Vec2(dimensionOf(pixel(n, 3), d), dimensionOf(pixel(n + 1, 3), d)); }, kTests));
        CHECK(independent([&](uint32_t n) { return Vec2(dimensionOf(pixel(n, 3), d), dimensionOf(pixel(3, n), d)); },
                          kTests));
        CHECK(independent(
            [&](uint32_t n) {
                Sampler parent = pixel(n, 3);
                parent.skipTo(6);
                const int branched = kFirstPadded + d;
                return Vec2(dimensionOf(parent.fork(0), branched), dimensionOf(parent.fork(1), branched));
            },
            kTests));
    }
}

TEST_CASE("over the samples of one pixel, sets of dimensions and branches are independent of each other") {
    const auto sample = [](uint32_t n) { return Sampler::pixel(11, Stage::Test, 40, 50, n); };
    constexpr int kTests = 5;
    const auto pair = [&](int a, int b) {
        return [=](uint32_t n) { return Vec2(dimensionOf(sample(n), a), dimensionOf(sample(n), b)); };
    };
    CHECK(independent(pair(0, kFirstPadded), kTests));
    CHECK(independent(pair(kFirstPadded, kFirstPadded + Sampler::kSetDimensions), kTests));
    CHECK(independent(pair(kFirstPadded + 1, kFirstPadded + 10 * Sampler::kSetDimensions + 1), kTests));
    const auto fork = [&](uint32_t n, uint32_t branch) {
        Sampler s = sample(n);
        s.skipTo(6);
        return s.fork(branch).next();
    };
    CHECK(independent([&](uint32_t n) { return Vec2(fork(n, 0), fork(n, 1)); }, kTests));
    CHECK(independent([&](uint32_t n) { return Vec2(fork(n, 0), dimensionOf(sample(n), kFirstPadded)); }, kTests));
}

TEST_CASE("a fork leaves its parent as it was, and depends on where it happens") {
    Sampler parent = Sampler::pixel(1, Stage::Test, 2, 3, 4), twin = parent;
    parent.next();
    twin.next();
    Sampler early = parent.fork(0);
    CHECK(parent.next() == twin.next());
    Sampler late = parent.fork(0);
    CHECK(early.next() != late.next());
}

TEST_CASE("the mean of a smooth function over four dimensions converges faster than by random points") {
    constexpr uint32_t kPoints = 1 << 12;
    const auto sequence = [](uint64_t seed, uint32_t i) { return Sampler::sequence(seed, Stage::Test, i); };
    const auto beyond = [](uint64_t seed, uint32_t i) {
        return Sampler::sequence(seed, Stage::Test, (uint64_t{5} << 32) + i);
    };
    const auto padded = [](uint64_t seed, uint32_t i) {
        Sampler s = Sampler::pixel(seed, Stage::Test, 1, 2, i);
        s.skipTo(kFirstPadded + Sampler::kSetDimensions);
        return s;
    };
    const auto branch = [](uint64_t seed, uint32_t i) { return Sampler::pixel(seed, Stage::Test, 1, 2, i).fork(1); };
    const auto hashed = [](uint64_t seed, uint32_t i) {
        Sampler s = Sampler::sequence(seed, Stage::Test, i);
        s.skipTo(kFirstPadded);
        return s;
    };
    const double errors[] = {errorAgainstRandom(sequence, kPoints), errorAgainstRandom(beyond, kPoints),
                             errorAgainstRandom(padded, kPoints), errorAgainstRandom(branch, kPoints)};
    for (const double error : errors) CHECK(error < 0.1);
    const double random = errorAgainstRandom(hashed, kPoints);
    CHECK(random > 0.6);
    CHECK(random < 1.4);
    MESSAGE("error against random points: sequence ", errors[0], ", beyond 2^32 ", errors[1], ", padded set ",
            errors[2], ", branch ", errors[3], ", hashed ", random);
}

TEST_CASE("the number of a path's wavelength is stratified, independent of the others, and always the same") {
    for (const bool pixel : {false, true}) {
        CAPTURE(pixel);
        const auto sampler = [pixel](uint32_t i) {
            return pixel ? Sampler::pixel(3, Stage::Test, 5, 7, i) : Sampler::sequence(3, Stage::Test, i);
        };
        std::vector<bool> taken(256);
        for (uint32_t i = 0; i < 256; ++i) taken[static_cast<size_t>(256 * sampler(i).wavelengthNumber())] = true;
        CHECK(std::count(taken.begin(), taken.end(), true) == 256);
        for (const int d : {0, 1, 4, 6, 7, 8, 9, 20}) {
            CAPTURE(d);
            CHECK(independent(
                [&](uint32_t i) { return Vec2(sampler(i).wavelengthNumber(), dimensionOf(sampler(i), d)); }, 16));
        }
        Sampler drawn = sampler(9);
        for (int i = 0; i < 11; ++i) drawn.next();
        CHECK(drawn.wavelengthNumber() == sampler(9).wavelengthNumber());
    }
}
