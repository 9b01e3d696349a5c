#include "photon/dispersion.h"

#include <doctest/doctest.h>

#include "photon/photons.h"
#include "sampling/sampler.h"
#include "support/statistics.h"

using namespace lsde;

namespace {

constexpr size_t kParts = 16, kPerPart = 1024;

// Of a unit square, by successive points of one sequence.
Vec3 pointOf(uint64_t seed, uint64_t index) {
    const Vec2 at = Sampler::sequence(seed, Stage::Emission, index).next2D();
    return {at.x, at.y, 0};
}

template <typename Point>
Dispersion dispersionOf(size_t perPart, const Point& point) {
    std::vector<std::vector<PackedPhoton>> parts(kParts);
    for (size_t i = 0; i < kParts * perPart; ++i) parts[i / perPart].push_back(pack(test::photonAt(point(i), i)));
    ThreadPool pool(1);
    return measureDispersion(parts, pool);
}

}  // namespace

TEST_CASE("numbers of independent photons vary as they would by Poisson") {
    test::Random random(1);
    const Dispersion d = dispersionOf(kPerPart, [&](size_t) { return random.inCube(); });
    for (const float measured : d.at4TimesPowersOf2) CHECK(measured == doctest::Approx(1).epsilon(0.15));
}

TEST_CASE("those of a sequence's photons as they do from one sequence to another") {
    const Dispersion d = dispersionOf(kPerPart, [](size_t i) { return pointOf(1, i); });
    for (const float expected : {16.0F, 64.0F}) {
        CAPTURE(expected);
        // In a disc that holds so many of the points of one part.
        const float radius = std::sqrt(expected / (kPi * kPerPart));
        test::Mean variance;
        for (uint64_t seed = 100; seed < 500; ++seed) {
            float count = 0;
            for (uint64_t i = 0; i < kPerPart; ++i)
                if (glm::distance(pointOf(seed, i), Vec3(0.4F, 0.55F, 0)) < radius) ++count;
            variance.add(square(count - expected));
        }
        const double relative = variance.value() / expected;
        CAPTURE(relative);
        CHECK(relative < 0.5);
        CHECK(d.at(expected) > 0.6 * relative);
        CHECK(d.at(expected) < 1.6 * relative);
    }
}

TEST_CASE("of few photons nothing is known") {
    CHECK(dispersionOf(4, [](size_t i) { return pointOf(1, i); }) == Dispersion());
}

TEST_CASE("between two counts it goes by their logarithm") {
    Dispersion d;
    d.at4TimesPowersOf2 = {1, 0.8F, 0.6F, 0.5F, 0.4F, 0.3F, 0.2F, 0.1F};
    CHECK(d.at(1) == 1);
    CHECK(d.at(8) == doctest::Approx(0.8));
    CHECK(d.at(8 * std::sqrt(2.0F)) == doctest::Approx(0.7));
    CHECK(d.at(1e6F) == doctest::Approx(0.1));
}

TEST_CASE("of two the larger holds, count by count") {
    Dispersion a, b;
    a.at4TimesPowersOf2[2] = 0.5F;
    b.at4TimesPowersOf2[2] = 0.25F;
    b.at4TimesPowersOf2[3] = 0.125F;
    CHECK(larger(a, b).at4TimesPowersOf2 == std::array{1.0F, 1.0F, 0.5F, 1.0F, 1.0F, 1.0F, 1.0F, 1.0F});
    CHECK(larger(a, b) == larger(b, a));
}
