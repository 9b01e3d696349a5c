#include "photon/irradiance_cache.h"

#include <doctest/doctest.h>

#include "photon/square.h"
#include "support/statistics.h"

using namespace lsde;
using test::kSquareRule;
using test::queryFrom;
using test::Random;
using test::Square;

namespace {

constexpr IrradianceRule kIrradianceRule{kSquareRule, 50};
constexpr IrradianceRule kManyPhotons{kSquareRule, 400};
constexpr IrradianceRule kFewPhotons{{20, 100, 2.5F}, 20};

}  // namespace

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
    // Green power is 2. Twenty maps with some hundred independent estimates each, of about 70 photons; without the
    // photon in the middle of each they would be 2.8% too low.
    CHECK(sum / known == doctest::Approx(10'000).epsilon(0.01));
    CHECK(first / known == doctest::Approx(5'000).epsilon(0.015));
}

TEST_CASE("the cache answers for its own side, medium and direction only") {
    const Square square(5, 5000, 1);
    IrradianceCache cache(square.source(), kIrradianceRule);
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

TEST_CASE("where many photons are in a disc the cached irradiance is the light's, within its error") {
    test::Mean ratio;
    for (uint32_t seed = 1; seed <= 40; ++seed) {
        const Square square(100 + seed, 5000, 1);
        IrradianceCache cache(square.source(), kManyPhotons);
        BandwidthScratch scratch;
        Random random(seed);
        test::Mean here;
        for (int i = 0; i < 500; ++i) {
            const Vec3 p(random.between(-0.5F, 0.5F), random.between(-0.5F, 0.5F), 0);
            const CachedLight light = cache.at(queryFrom(p), true, scratch);
            if (!light.irradiance.empty()) here.add(static_cast<double>(light.irradiance.back().y) / 10'000);
        }
        ratio.add(here.value());
    }
    MESSAGE("ratio ", ratio.value(), " +- ", ratio.standardError());
    CHECK(ratio.standardError() < 0.003);
    CHECK(std::fabs(ratio.value() - 1) < 0.001 + 3 * ratio.standardError());
}

TEST_CASE("of points side by side the answers differ by less than the noise that they share") {
    const Square square(43, 5000, 1);
    IrradianceCache cache(square.source(), kManyPhotons);
    BandwidthScratch scratch;
    Random random(44);
    test::Mean within, overall, overallSquared;
    for (int place = 0; place < 400; ++place) {
        const Vec3 p(random.between(-0.5F, 0.5F), random.between(-0.5F, 0.5F), 0);
        test::Mean value, squared;
        for (int i = 0; i < 16; ++i) {
            const Vec3 offset(random.between(-1e-4F, 1e-4F), random.between(-1e-4F, 1e-4F), 0);
            const CachedLight light = cache.at(queryFrom(p + offset), true, scratch);
            if (light.irradiance.empty()) continue;
            // It answers for no less than the record that told the bandwidth.
            CHECK(light.over.length() >= light.bandwidth.length());
            const auto e = static_cast<double>(light.irradiance.back().y) / 10'000;
            value.add(e);
            squared.add(e * e);
        }
        if (value.value() == 0) continue;  // no answers
        within.add(squared.value() - value.value() * value.value());
        overall.add(value.value());
        overallSquared.add(value.value() * value.value());
    }
    const double share = within.value() / (overallSquared.value() - overall.value() * overall.value());
    MESSAGE("variance side by side over that from place to place: ", share);
    CHECK(share < 0.08);  // 0.17 if a single record answers
    CHECK(share > 0.01);  // it is dithered
}

TEST_CASE("light that rises evenly is where it belongs, whichever way it rises" * doctest::test_suite("statistics")) {
    // Records of 64 photons stand for places 11 cm wide.
    for (const Vec3 rise : {Vec3(0.8F, 0, 0), Vec3(0, 0.8F, 0), Vec3(0.4F, -0.5F, 0)}) {  // per metre
        test::Mean above;
        for (uint32_t seed = 1; seed <= 20; ++seed) {
            const Square even(400 + seed, 5000, 1);
            Square rising(400 + seed, 5000, 1);
            const auto brightness = [&](Vec3 p) { return 1 + glm::dot(rise, p); };
            for (uint32_t i = 0; i < rising.tree.count; ++i) {
                uint32_t& power = rising.tree.payload[i].power;
                power = packPower(unpackPower(power) * brightness(view(rising.tree).position(i)), i);
            }
            rising.sumBlocks();
            IrradianceCache ofEven(even.source(), kManyPhotons), ofRising(rising.source(), kManyPhotons);
            BandwidthScratch scratch, scratchOfRising;
            Random random(seed);
            test::Mean here;
            for (int i = 0; i < 500; ++i) {
                // Beside what the same photons say of even light, little is left to chance.
                const Vec3 p(random.between(-0.4F, 0.4F), random.between(-0.4F, 0.4F), 0);
                const CachedLight a = ofEven.at(queryFrom(p), true, scratch);
                const CachedLight b = ofRising.at(queryFrom(p), true, scratchOfRising);
                if (a.irradiance.empty() || b.irradiance.empty()) continue;
                here.add(static_cast<double>(b.irradiance.back().y / (brightness(p) * a.irradiance.back().y)) - 1);
            }
            above.add(here.value());
        }
        MESSAGE("above by ", above.value(), " +- ", above.standardError());
        CHECK(above.standardError() < 0.001);
        CHECK(std::fabs(above.value()) < 0.0005 + 3 * above.standardError());
    }
}

TEST_CASE("a bent shading normal sees as much more of slanting light as it leans towards it") {
    // The square's photons come from wherever photonAt() has them come from; here from 60 degrees towards +x.
    Square square(7, 5000, 1);
    const Vec3 from(std::sqrt(0.75F), 0, 0.5F);
    for (PhotonPayload& p : square.tree.payload) p.direction = packDirection(from);
    const PhotonSource source = square.source();
    IrradianceCache cache(source, kIrradianceRule);
    BandwidthScratch scratch;
    int known = 0;
    for (const float lean : {-0.05F, 0.0F, 0.05F})
        for (const float sign : {1.0F, -1.0F}) {
            DensityQuery query = queryFrom({0.1F, 0.2F, 0});
            query.point.ns = sign * Vec3(std::sin(lean), 0, std::cos(lean));
            const CachedLight light = cache.at(query, true, scratch);
            if (light.irradiance.empty()) continue;
            ++known;
            CHECK(light.shading ==
                  doctest::Approx(glm::dot(from, Vec3(std::sin(lean), 0, std::cos(lean))) / 0.5).epsilon(2e-3));
        }
    CHECK(known == 6);
}

TEST_CASE("where light is even almost every point has an answer") {
    int known = 0, all = 0;
    for (uint32_t seed = 1; seed <= 20; ++seed) {
        const Square square(200 + seed, 5000, 1);
        IrradianceCache cache(square.source(), kIrradianceRule);
        BandwidthScratch scratch;
        Random random(seed);
        for (int i = 0; i < 1000; ++i) {
            const Vec3 p(random.between(-0.5F, 0.5F), random.between(-0.5F, 0.5F), 0);
            known += cache.at(queryFrom(p), true, scratch).irradiance.empty() ? 0 : 1;
            ++all;
        }
    }
    const int without = all - known;
    MESSAGE(without, " of ", all, " without");
    CHECK(without < 220);  // 347 if each block answers for itself alone
}

TEST_CASE("light on the back of a sheet takes hardly any answers away, and changes none") {
    int known = 0, all = 0;
    test::Mean ratio;
    for (uint32_t seed = 1; seed <= 20; ++seed) {
        const Square square(300 + seed, 5000, 1, 5000);
        IrradianceCache cache(square.source(), kIrradianceRule);
        BandwidthScratch scratch;
        Random random(seed);
        test::Mean here;
        for (int i = 0; i < 1000; ++i) {
            const Vec3 p(random.between(-0.5F, 0.5F), random.between(-0.5F, 0.5F), 0);
            const CachedLight light = cache.at(queryFrom(p), true, scratch);
            if (!light.irradiance.empty()) here.add(static_cast<double>(light.irradiance.back().y) / 10'000);
            known += light.irradiance.empty() ? 0 : 1;
            ++all;
        }
        ratio.add(here.value());
    }
    const int without = all - known;
    MESSAGE(without, " of ", all, " without; ratio ", ratio.value(), " +- ", ratio.standardError());
    CHECK(without < 600);
    CHECK(std::fabs(ratio.value() - 1) < 0.003 + 3 * ratio.standardError());
}

TEST_CASE("beside an edge the cached irradiance is that of its own side" * doctest::test_suite("statistics")) {
    // Density 2000 and 100000 photons a m2. 3 cm from the edge even discs of 50 photons of the bright side end.
    double darkMost = 0;
    test::Mean dark, bright;
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        const Square square(seed, 2000, 50);
        IrradianceCache cache(square.source(), kIrradianceRule);
        BandwidthScratch scratch;
        Random random(seed);
        for (int i = 0; i < 4000; ++i) {
            const float away = random.between(0.03F, 0.2F);
            for (const float side : {-away, away}) {
                const CachedLight light = cache.at(queryFrom({side, random.between(-0.6F, 0.6F), 0}), true, scratch);
                if (light.irradiance.empty()) continue;
                const double there = static_cast<double>(light.irradiance.back().y) / (side < 0 ? 4000 : 200'000);
                if (side < 0) darkMost = std::max(darkMost, there);
                (side < 0 ? dark : bright).add(there);
            }
        }
    }
    MESSAGE("dark side: mean ", dark.value(), ", at most ", darkMost, "; bright side: mean ", bright.value());
    CHECK(bright.value() == doctest::Approx(1).epsilon(0.02));
    CHECK(dark.value() == doctest::Approx(1).epsilon(0.05));
    CHECK(darkMost < 2);  // 50 photons: a standard error of 16%
}

TEST_CASE("a crease above the surface, up to which records reach, ends what they say of it") {
    // As of a lamp close below a ceiling: dark between them, bright beside it.
    Square square(17, 2000, 50);
    const std::vector<Segment> crease = {{{0, -1, 0.05F}, {0, 1, 0.05F}}};
    square.extent = SurfaceExtent(crease);
    IrradianceCache cache(square.source(), kIrradianceRule);
    BandwidthScratch scratch;
    Random random(18);
    int known = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 p(random.between(-0.03F, 0), random.between(-0.7F, 0.7F), 0);
        const CachedLight light = cache.at(queryFrom(p), true, scratch);
        if (light.irradiance.empty()) continue;
        ++known;
        REQUIRE(light.irradiance.back().y < 2 * 2000 * 1.5F);
    }
    CHECK(known > 1000);
}

TEST_CASE("a group's irradiance is its own photons', and those of no group leave nothing") {
    const Square square(13, 5000, 1);
    IrradianceCache both(square.source(2), kIrradianceRule), one(square.source(1), kIrradianceRule);
    BandwidthScratch scratch;
    Random random(14);
    test::Mean first, alone;
    for (int i = 0; i < 500; ++i) {
        const Vec3 p(random.between(-0.6F, 0.6F), random.between(-0.6F, 0.6F), 0);
        const CachedLight a = both.at(queryFrom(p), true, scratch);
        if (!a.irradiance.empty()) first.add(static_cast<double>(a.irradiance[0].y));
        const CachedLight b = one.at(queryFrom(p), true, scratch);
        if (b.irradiance.empty()) continue;
        REQUIRE(b.irradiance.size() == 2);
        REQUIRE(b.irradiance[0] == b.irradiance[1]);
        alone.add(static_cast<double>(b.irradiance[1].y));
    }
    CHECK(first.value() == doctest::Approx(5000).epsilon(0.05));
    CHECK(alone.value() == doctest::Approx(5000).epsilon(0.05));
}

TEST_CASE("normals as far apart as a cosine of 0.95 share their irradiance, others do not") {
    const Square square(15, 5000, 1);
    IrradianceCache cache(square.source(), kIrradianceRule);
    BandwidthScratch scratch;
    for (const float cosine : {0.96F, 0.94F}) {
        DensityQuery query = queryFrom({0.1F, 0.1F, 0});
        query.sideNormal = {std::sqrt(1 - cosine * cosine), 0, cosine};
        CHECK(cache.at(query, true, scratch).irradiance.empty() == (cosine < 0.95F));
    }
}

TEST_CASE("block by block the irradiance, its groups and its direction are those photon by photon") {
    // Least and most the same: the bandwidth is given, what differs is the sum.
    constexpr IrradianceRule kGiven{{2000, 2000, 2.5F}, 300};
    Square square(31, 20'000, 1.2F);
    for (uint32_t i = 0; i < square.tree.count; ++i) {
        const Vec3 p = view(square.tree).position(i);
        square.tree.payload[i].power = packPower(Rgb(1 + p.x, 2 - p.y, 3), i);
        square.tree.payload[i].direction = packDirection(glm::normalize(Vec3(0.5F + p.x, p.y, 1)));
    }
    square.sumBlocks();
    const PhotonSource source = square.source(2, true), slow = square.source(2, false);
    IrradianceCache blocks(source, kGiven), photons(slow, kGiven);
    BandwidthScratch scratch, scratchOfPhotons;
    Random random(1);
    int known = 0;
    test::Mean red, first;
    for (int i = 0; i < 300; ++i) {
        DensityQuery query = queryFrom({random.between(-0.5F, 0.5F), random.between(-0.5F, 0.5F), 0});
        query.point.ns = glm::normalize(Vec3(0.05F, 0, 1));
        const CachedLight a = blocks.at(query, true, scratch), b = photons.at(query, true, scratchOfPhotons);
        REQUIRE(a.irradiance.size() == b.irradiance.size());
        if (a.irradiance.empty()) continue;
        ++known;
        CHECK(a.over.radius == b.over.radius);
        const auto sum = [](Rgb e) { return e.x + e.y + e.z; };
        CHECK(sum(a.irradiance[2]) == doctest::Approx(sum(b.irradiance[2])).epsilon(1e-4));
        // A block has one middle for all channels and groups: its parts are off by chance, by less than their error.
        for (size_t g = 0; g < 3; ++g)
            for (int c = 0; c < 3; ++c) CHECK(a.irradiance[g][c] == doctest::Approx(b.irradiance[g][c]).epsilon(0.015));
        red.add(static_cast<double>(a.irradiance[2].x / b.irradiance[2].x));
        first.add(static_cast<double>(a.irradiance[0].y / b.irradiance[0].y));
        CHECK(a.variance.y == doctest::Approx(b.variance.y).epsilon(0.02));
        CHECK(a.shading == doctest::Approx(b.shading).epsilon(0.01));
    }
    CHECK(known > 200);
    MESSAGE("red ", red.value(), ", first group ", first.value());
    CHECK(red.value() == doctest::Approx(1).epsilon(0.001));
    CHECK(first.value() == doctest::Approx(1).epsilon(0.001));
}
