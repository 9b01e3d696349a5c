#include "photon/irradiance_cache.h"

#include <doctest/doctest.h>

#include "photon/photons.h"

using namespace lsde;
using test::photonAt;
using test::Random;
using test::treeOf;

namespace {

// Photons of even power on the square [-1, 1]^2 of the plane z = 0, `density` of them a m2 where x < 0 and as many
// times `contrast` where x > 0; every other one in group 1.
struct Square {
    PhotonTree tree;
    AnyIndex index;
    SurfaceExtent extent;
    std::vector<uint16_t> groups;

    Square(uint32_t seed, float density, float contrast)
        : tree(make(seed, density, contrast)), index(KdIndex(view(tree))) {
        for (size_t i = 0; i < tree.count; ++i) groups.push_back(tree.payload[i].light);
    }
    static PhotonTree make(uint32_t seed, float density, float contrast) {
        Random random(seed);
        std::vector<Photon> photons;
        for (const float side : {-1.0F, 1.0F})
            for (uint32_t n = random.poisson(2.0 * density * (side > 0 ? contrast : 1)); n-- > 0;) {
                Photon p = photonAt({side * random.uniform(), random.between(-1, 1), 0}, random.bits());
                p.light = static_cast<uint16_t>(photons.size() % 2);
                photons.push_back(p);
            }
        return treeOf(photons);
    }
    PhotonSource source() const { return {index, extent, groups, 2, 1, 0.5F}; }
};

constexpr IrradianceRule kRule{{20, 1000, 2.5F}, 50};
constexpr IrradianceRule kFewPhotons{{20, 100, 2.5F}, 20};

DensityQuery queryFrom(Vec3 position, Vec3 side = {0, 0, 1}) {
    DensityQuery query;
    query.point.position = position;
    query.point.ng = query.point.ns = {0, 0, 1};
    query.sideNormal = side;
    query.maxRadius = 0.5F;
    return query;
}

}  // namespace

TEST_CASE("where light is even the bandwidth grows as far as it may") {
    const Square square(1, 20'000, 1);
    BandwidthScratch scratch;
    Random random(2);
    int wide = 0;
    for (int i = 0; i < 200; ++i) {
        const auto photon = static_cast<uint32_t>(random.uniform() * static_cast<float>(square.tree.count));
        const Vec3 p = square.index.index() == 0 ? view(square.tree).position(photon) : Vec3(0);
        if (std::max(std::fabs(p.x), std::fabs(p.y)) > 0.8F) continue;
        const Bandwidth b = consistentBandwidth(square.source(), photon, kRule.bandwidth, scratch);
        CHECK(b.count <= 1200);
        CHECK(b.count == doctest::Approx(20'000 * kPi * b.radius * b.radius).epsilon(0.5));
        wide += b.count >= 450 ? 1 : 0;
    }
    CHECK(wide > 90);
}

TEST_CASE("a bandwidth ends at an edge, on its dark side as well") {
    const Square square(3, 2000, 50);
    BandwidthScratch scratch;
    double beyond = 0;
    int dark = 0;
    for (uint32_t i = 0; i < square.tree.count; ++i) {
        const Vec3 p = view(square.tree).position(i);
        if (p.x > 0 || p.x < -0.2F || std::fabs(p.y) > 0.7F) continue;
        const Bandwidth b = consistentBandwidth(square.source(), i, kRule.bandwidth, scratch);
        beyond += std::max(0.0F, b.radius + p.x);
        ++dark;
    }
    MESSAGE("beyond the edge on average: ", beyond / dark, " m");
    // The least disc holds 20 photons, on the dark side within 6 cm, and there reaches a little into the bright one.
    CHECK(beyond / dark < 0.002);
}

TEST_CASE("cached irradiance has no bias where light is even, and keeps groups apart") {
    double sum = 0, first = 0;
    int known = 0;
    for (uint32_t seed = 1; seed <= 20; ++seed) {
        const Square square(seed, 5000, 1);
        IrradianceCache cache(square.source(), kFewPhotons);
        BandwidthScratch scratch;
        Random random(seed);
        for (int i = 0; i < 500; ++i) {
            const Vec3 p(random.between(-0.6F, 0.6F), random.between(-0.6F, 0.6F), 0);
            const CachedLight light = cache.at(queryFrom(p), true, scratch);
            if (light.irradiance.empty()) continue;
            REQUIRE(light.irradiance.size() == 3);
            CHECK(light.irradiance[2].y == doctest::Approx(light.irradiance[0].y + light.irradiance[1].y));
            sum += light.irradiance[2].y;
            first += light.irradiance[0].y;
            ++known;
        }
    }
    CHECK(known > 5000);
    // Green power is 2. Twenty maps with some hundred independent estimates each, of about 70 photons; the photon in
    // the middle of each would add 3%.
    CHECK(sum / known == doctest::Approx(10'000).epsilon(0.012));
    CHECK(first / known == doctest::Approx(5'000).epsilon(0.018));
}

TEST_CASE("the cache answers for its own side, medium and direction only") {
    const Square square(5, 5000, 1);
    IrradianceCache cache(square.source(), kRule);
    BandwidthScratch scratch;
    const auto known = [&](const DensityQuery& query) { return !cache.at(query, true, scratch).irradiance.empty(); };
    const DensityQuery query = queryFrom({0.1F, 0.1F, 0});
    CHECK(known(query));
    CHECK(!known(queryFrom({0.1F, 0.1F, 0}, {0, 0, -1})));
    DensityQuery other = query;
    other.medium = 1;
    CHECK(!known(other));
    other = query;
    other.point.ng = other.sideNormal = glm::normalize(Vec3(1, 0, 1));
    CHECK(!known(other));
    CHECK(cache.at(query, false, scratch).irradiance.empty());
    CHECK(cache.at(query, false, scratch).bandwidth.count > 50);
}

TEST_CASE("what the cache says depends neither on who asks first nor on the threads") {
    const Square square(7, 5000, 20);
    constexpr size_t kQueries = 4000;
    const auto position = [](size_t i) {
        return Vec3(toUnitFloat(static_cast<uint32_t>(mix64(i))) - 0.5F,
                    toUnitFloat(static_cast<uint32_t>(mix64(i) >> 32)) - 0.5F, 0);
    };
    struct Answer {
        Bandwidth bandwidth;
        Rgb irradiance{-1};
    };
    const auto ask = [&](int threads, bool backwards) {
        IrradianceCache cache(square.source(), kRule);
        std::vector<Answer> answers(kQueries);
        ThreadPool pool(threads);
        pool.forRange(kQueries, 16, [&](size_t begin, size_t end) {
            BandwidthScratch scratch;
            for (size_t i = begin; i < end; ++i) {
                const size_t at = backwards ? kQueries - 1 - i : i;
                const CachedLight light = cache.at(queryFrom(position(at)), true, scratch);
                answers[at].bandwidth = light.bandwidth;
                if (!light.irradiance.empty()) answers[at].irradiance = light.irradiance[2];
            }
        });
        return answers;
    };
    const std::vector<Answer> one = ask(1, false);
    for (const bool backwards : {false, true}) {
        const std::vector<Answer> two = ask(2, backwards);
        for (size_t i = 0; i < kQueries; ++i) {
            REQUIRE(one[i].bandwidth.radius == two[i].bandwidth.radius);
            REQUIRE(one[i].bandwidth.count == two[i].bandwidth.count);
            REQUIRE(one[i].irradiance == two[i].irradiance);
        }
    }
}
