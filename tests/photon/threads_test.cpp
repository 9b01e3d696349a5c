// What several threads make of photons at once: for ThreadSanitizer, under which the whole room would take minutes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "base/hash.h"
#include "photon/irradiance_cache.h"
#include "photon/square.h"

using namespace lsde;
using test::queryFrom;
using test::Random;
using test::Square;

namespace {

std::vector<PackedPhoton> randomPhotons(size_t count, uint32_t seed) {
    Random random(seed);
    std::vector<PackedPhoton> photons;
    for (size_t i = 0; i < count; ++i) photons.push_back(pack(test::randomPhoton(random, i)));
    // The same place with other payloads, and photons that are equal in all.
    for (size_t i = 0; i + 1 < count; i += 5) photons[i].position = photons[i + 1].position;
    for (size_t i = 0; i + 9 < count; i += 9) photons[i] = photons[i + 2];
    for (size_t i = 0; i < count; i += 2) photons[i].position.z = 0.25F;
    return photons;
}

bool sameBytes(const PhotonTree& a, const PhotonTree& b) {
    const auto same = [](const auto& x, const auto& y) {
        return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
    };
    return a.count == b.count && same(a.blocks, b.blocks) && same(a.nodes, b.nodes) && same(a.payload, b.payload);
}

}  // namespace

TEST_CASE("a tree depends on the set of its photons only, not on their order or on threads") {
    for (const size_t count : {1, 16, 100, 1000, 150'000}) {
        std::vector<PackedPhoton> photons = randomPhotons(count, 5);
        const auto build = [&](int threads) {
            ThreadPool pool(threads);
            return buildPhotonTree(std::vector(photons), pool);
        };
        const PhotonTree tree = build(1);
        for (const uint32_t seed : {1U, 2U}) {
            std::shuffle(photons.begin(), photons.end(), std::mt19937(seed));
            CHECK(sameBytes(tree, build(1)));
            CHECK(sameBytes(tree, build(4)));
        }
    }
}

TEST_CASE("a tree holds exactly its photons") {
    const std::vector<PackedPhoton> photons = randomPhotons(5000, 6);
    ThreadPool pool(2);
    const PhotonTree tree = buildPhotonTree(std::vector(photons), pool);
    std::vector<PackedPhoton> held, expected = photons;
    for (uint32_t i = 0; i < tree.count; ++i) held.push_back({view(tree).position(i), tree.payload[i]});
    std::sort(held.begin(), held.end());
    std::sort(expected.begin(), expected.end());
    REQUIRE(held.size() == expected.size());
    for (size_t i = 0; i < held.size(); ++i) REQUIRE((!(held[i] < expected[i]) && !(expected[i] < held[i])));
    Bounds bounds;
    for (const PackedPhoton& p : photons) bounds.grow(p.position);
    CHECK(tree.bounds.lo == bounds.lo);
    CHECK(tree.bounds.hi == bounds.hi);
}

TEST_CASE("what the cache says depends neither on who asks first nor on the threads") {
    const Square square(7, 5000, 20);
    constexpr IrradianceRule kRule{{20, 1000, 2.5F}, 50};
    constexpr size_t kQueries = 4000;
    const auto position = [](size_t i) {
        return Vec3(toUnitFloat(static_cast<uint32_t>(mix64(i))) - 0.5F,
                    toUnitFloat(static_cast<uint32_t>(mix64(i) >> 32)) - 0.5F, 0);
    };
    struct Answer {
        Bandwidth bandwidth;
        std::vector<Rgb> irradiance;
    };
    const auto ask = [&](int threads, bool backwards) {
        IrradianceCache cache(square.source(), kRule);
        // Each of them twice: halves of the range run at the same time, so that threads meet at records in the making.
        std::vector<Answer> answers(2 * kQueries);
        ThreadPool pool(threads);
        pool.forRange(2 * kQueries, 16, [&](size_t begin, size_t end) {
            BandwidthScratch scratch;
            for (size_t i = begin; i < end; ++i) {
                const size_t at = backwards ? 2 * kQueries - 1 - i : i;
                const CachedLight light = cache.at(queryFrom(position(at % kQueries)), true, scratch);
                answers[at].bandwidth = light.bandwidth;
                answers[at].irradiance.assign(light.irradiance.begin(), light.irradiance.end());
            }
        });
        return answers;
    };
    const std::vector<Answer> one = ask(1, false);
    for (const bool backwards : {false, true}) {
        const std::vector<Answer> two = ask(2, backwards);
        for (size_t i = 0; i < two.size(); ++i) {
            REQUIRE(one[i].bandwidth.radius == two[i].bandwidth.radius);
            REQUIRE(one[i].bandwidth.count == two[i].bandwidth.count);
            REQUIRE(one[i].irradiance == two[i].irradiance);
        }
    }
}
