// Solids: what is around a path, what it is refracted by, and what the media take from it.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "support/scenes.h"
#include "transport/walking.h"

using namespace lsde;
using test::SceneBuilder;

namespace {

constexpr float kWater = 1.33F, kGlass = 1.5F;

// A tub of glass, open at the top: an outer and an inner box without lids, joined by a rim.
Mesh tub() {
    Mesh m = test::box({-0.5F, 0, -0.5F}, {0.5F, 1, 0.5F});
    test::append(m, test::flipped(test::box({-0.4F, 0.1F, -0.4F}, {0.4F, 1, 0.4F})));
    std::erase_if(m.triangles, [&](const Triangle& t) {
        return std::all_of(t.begin(), t.end(), [&](uint32_t v) { return m.positions[v].y == 1; });
    });
    for (const float s : {-1.0F, 1.0F}) {
        const auto at = [s](float x, float z) { return Vec3(s * x, 1, s * z); };
        test::append(m, test::quad(at(-0.5F, 0.5F), at(0.5F, 0.5F), at(0.4F, 0.4F), at(-0.4F, 0.4F)));
        test::append(m, test::quad(at(0.5F, 0.5F), at(0.5F, -0.5F), at(0.4F, -0.4F), at(0.4F, 0.4F)));
    }
    return m;
}

enum class Contact { Exact, Overlap, OverlapGlassWins, OverlapWaterWins };

// Water in the tub up to y = .7, its sides on the glass or reaching into it; nodes in either order.
std::unique_ptr<Scene> waterInGlass(Contact contact, bool waterFirst) {
    const float reach = contact == Contact::Exact ? 0 : 0.05F;
    const Mesh body = test::box({-0.4F - reach, 0.1F - reach, -0.4F - reach}, {0.4F + reach, 0.7F, 0.4F + reach});
    SceneBuilder scene;
    const auto addWater = [&] {
        scene.add(body, test::glass(kWater)).priority = contact == Contact::OverlapWaterWins ? 2 : 1;
    };
    if (waterFirst) addWater();
    scene.add(tub(), test::glass(kGlass)).priority = contact == Contact::OverlapGlassWins ? 2 : 1;
    if (!waterFirst) addWater();
    return scene.build();
}

// Index ratios (far side over near side) at all interfaces on the way out.
std::vector<float> ratiosAlong(const Scene& scene, PathState path) {
    std::vector<float> ratios;
    WalkScratch scratch;
    Vertex v;
    while (advance(scene, path, v, scratch)) {
        const auto lobe = test::deltaLobe(v, true);
        if (!lobe || !scatter(v, *lobe, Quantity::Radiance, path)) break;
        ratios.push_back(lobe->eta);
    }
    CHECK(path.media.size() == 0);
    return ratios;
}

void checkRatios(const std::vector<float>& got, const std::vector<float>& expected) {
    REQUIRE(got.size() == expected.size());
    for (size_t i = 0; i < got.size(); ++i) CHECK(got[i] == doctest::Approx(expected[i]));
}

}  // namespace

TEST_CASE("between water and the glass that holds it there is no air, touching or overlapping, in any order of nodes") {
    for (const Contact contact :
         {Contact::Exact, Contact::Overlap, Contact::OverlapGlassWins, Contact::OverlapWaterWins})
        for (const bool waterFirst : {false, true}) {
            CAPTURE(static_cast<int>(contact));
            CAPTURE(waterFirst);
            const auto scene = waterInGlass(contact, waterFirst);
            const std::vector<float> across = {kGlass, kWater / kGlass, kGlass / kWater, 1 / kGlass};
            checkRatios(ratiosAlong(*scene, test::startAt(*scene, {-2, 0.4F, 0.11F}, {1, 0.01F, 0.02F})), across);
            checkRatios(ratiosAlong(*scene, test::startAt(*scene, {0.13F, 0.3F, 2}, {0.01F, 0.01F, -1})), across);
            const std::vector<float> down = {kWater, kGlass / kWater, 1 / kGlass};
            checkRatios(ratiosAlong(*scene, test::startAt(*scene, {0.1F, 2, 0.07F}, {0.01F, -1, 0.02F})), down);
            const std::vector<float> up = {kGlass, kWater / kGlass, 1 / kWater};
            checkRatios(ratiosAlong(*scene, test::startAt(*scene, {0.1F, -2, 0.07F}, {0.01F, 1, 0.02F})), up);
        }
}

TEST_CASE("a path that starts within a solid knows what it is in") {
    for (const Contact contact : {Contact::Exact, Contact::Overlap}) {
        const auto scene = waterInGlass(contact, false);
        checkRatios(ratiosAlong(*scene, test::startAt(*scene, {0.03F, 0.4F, 0.02F}, {1, 0.01F, 0.02F})),
                    {kGlass / kWater, 1 / kGlass});
        checkRatios(ratiosAlong(*scene, test::startAt(*scene, {0.47F, 0.4F, 0.02F}, {1, 0.01F, 0.02F})), {1 / kGlass});
        checkRatios(ratiosAlong(*scene, test::startAt(*scene, {0.47F, 0.4F, 0.02F}, {-1, 0.01F, 0.02F})),
                    {kWater / kGlass, kGlass / kWater, 1 / kGlass});
        CHECK(scene->mediaAt({0.03F, 0.9F, 0}).size() == 0);
    }
}

TEST_CASE("a ball of glass, in a block of ice, in water: every interface is between its own two media") {
    SceneBuilder builder;
    builder.add(test::box({-3, -3, -3}, {3, 3, 3}), test::glass(kWater)).priority = 1;
    builder.add(test::box({-2, -2, -2}, {2, 2, 2}), test::glass(1.31F)).priority = 2;
    builder.add(test::sphere({0, 0, 0}, 1, 3), test::glass(kGlass)).priority = 3;
    const auto scene = builder.build();
    const std::vector<float> through = {kWater,         1.31F / kWater, kGlass / 1.31F,
                                        1.31F / kGlass, kWater / 1.31F, 1 / kWater};
    checkRatios(ratiosAlong(*scene, test::startAt(*scene, {-5, 0.1F, 0.2F}, {1, 0.01F, 0.02F})), through);
    const MediaStack inside = scene->mediaAt({0.1F, 0.1F, 0.1F});
    CHECK(inside.size() == 3);
    CHECK(scene->media()[inside.dominant(scene->media())].ior == kGlass);
}

TEST_CASE("where solids of equal priority overlap, the one entered first stays") {
    SceneBuilder builder;
    builder.add(test::box({0, 0, 0}, {2, 1, 1}), test::glass(1.2F));
    builder.add(test::box({1, -0.5F, -0.5F}, {3, 1.5F, 1.5F}), test::glass(1.8F));
    const auto scene = builder.build();
    const auto interfaceBetween = [&](float from, float direction) {
        PathState path = test::startAt(*scene, {from, 0.4F, 0.3F}, {direction, 0, 0});
        test::pass(*scene, path);
        return test::pass(*scene, path).surface.position.x;
    };
    CHECK(interfaceBetween(-1, 1) == doctest::Approx(2));
    CHECK(interfaceBetween(4, -1) == doctest::Approx(1));
}

TEST_CASE("a medium absorbs by Beer and Lambert's law over the true path, whatever the order of nodes") {
    const VolumeProperties red{{0.8F, 0.4F, 0.1F}, 0.5F}, blue{{0.2F, 0.5F, 1}, 2};
    for (const bool redFirst : {false, true}) {
        SceneBuilder builder;
        const auto addRed = [&] { builder.add(test::box({0, -9, -9}, {0.3F, 9, 9}), test::glass(1.5F, red)); };
        if (redFirst) addRed();
        builder.add(test::box({0.3F, -9, -9}, {1, 9, 9}), test::glass(1.5F, blue));
        if (!redFirst) addRed();
        const auto scene = builder.build();
        const Vec3 direction = glm::normalize(Vec3(1, 1, 0));
        PathState path = test::startAt(*scene, {-1, 0, 0}, direction);
        WalkScratch scratch;
        Vertex v;
        test::pass(*scene, path);
        const Rgb entered = path.throughput;
        REQUIRE(advance(*scene, path, v, scratch));
        const float cosine = std::sqrt(1 - square(direction.y / 1.5F));
        for (int c = 0; c < 3; ++c)
            CHECK(path.throughput[c] / entered[c] ==
                  doctest::Approx(std::pow(red.attenuationColor[c], 0.3F / cosine / 0.5F)).epsilon(1e-5));
        // Equal indices: nothing is reflected where the two touch.
        REQUIRE(scatter(v, *test::deltaLobe(v, true), Quantity::Radiance, path));
        const Rgb passed = path.throughput;
        REQUIRE(advance(*scene, path, v, scratch));
        CHECK(v.distance == doctest::Approx(0.7F / cosine));
        for (int c = 0; c < 3; ++c)
            CHECK(path.throughput[c] / passed[c] ==
                  doctest::Approx(std::pow(blue.attenuationColor[c], 0.7F / cosine / 2)).epsilon(1e-5));
    }
}

TEST_CASE("an open sheet is entered and left by its facing, from whichever side a path comes") {
    SceneBuilder builder;
    builder.add(test::plate({0, 1, 0}, 2), test::glass(kWater, {{0.5F, 0.5F, 0.5F}, 1})).openEdges = 4;
    builder.add(test::plate({0, 0, 0}, 9), test::lambert(Rgb(0.5F)));
    const auto scene = builder.build();
    WalkScratch scratch;
    // Down through the sheet to the floor.
    PathState path = test::startAt(*scene, {0.1F, 2, 0.1F}, {0, -1, 0});
    CHECK(path.media.size() == 0);
    Vertex v = test::pass(*scene, path);
    CHECK(path.media.size() == 1);
    const Rgb entered = path.throughput;
    REQUIRE(advance(*scene, path, v, scratch));
    CHECK(v.medium == 1);
    CHECK(path.throughput.x / entered.x == doctest::Approx(0.5F));
    // From outside its edge, below it, up: nobody knew of the water.
    path = test::startAt(*scene, {4, 0.5F, 0.1F}, {-3.5F, 0.5F, 0});
    CHECK(path.media.size() == 0);
    REQUIRE(advance(*scene, path, v, scratch));
    CHECK(v.medium == 1);
    CHECK(v.behind.size() == 0);
    CHECK(path.throughput.x == doctest::Approx(std::pow(0.5F, v.distance)));
}

TEST_CASE("light that leaves the water beside an open sheet is not lost to an undefined number") {
    SceneBuilder builder;
    builder.add(test::plate({0, 1, 0}, 1), test::glass(kWater, {{0.5F, 1, 1}, 1})).openEdges = 4;
    builder.add(test::plate({0, 0, 0}, 9), test::lambert(Rgb(0.5F)));
    const auto scene = builder.build();
    WalkScratch scratch;
    PathState path = test::startAt(*scene, {0.9F, 2, 0}, {0, -1, 0});
    test::pass(*scene, path);
    Vertex v;
    REQUIRE(advance(*scene, path, v, scratch));
    const Visibility toSun = visibility(*scene, v, glm::normalize(Vec3(1, 1, 0)), kInfinity, scratch);
    CHECK(toSun.transmittance == Rgb(0, 1, 1));
}

TEST_CASE("a glass that stands on a table touches it: light goes on from the table, within the glass") {
    for (const bool tableFirst : {false, true})
        for (const float height : {0.0F, 0.37F, 74.3F}) {
            CAPTURE(tableFirst);
            CAPTURE(height);
            SceneBuilder builder;
            const auto addTable = [&] {
                builder.add(test::plate({0.3F, height, 0.1F}, 3), test::lambert(Rgb(0.5F)), "table");
            };
            if (tableFirst) addTable();
            builder.add(test::box({-1, height, -1}, {1, height + 1, 1}), test::glass(kGlass), "glass");
            if (!tableFirst) addTable();
            const auto scene = builder.build();
            test::Random random(5);
            WalkScratch scratch;
            for (int i = 0; i < 1000; ++i) {
                const Vec2 u = random.uniform2D(), w = random.uniform2D();
                PathState path =
                    test::startAt(*scene, {u.x - 0.5F, height + 3, u.y - 0.5F}, {w.x - 0.5F, -3, w.y - 0.5F});
                test::pass(*scene, path);
                Vertex v;
                REQUIRE(advance(*scene, path, v, scratch));
                REQUIRE(scene->description().meshes[v.surface.mesh].object == "table");
                REQUIRE(v.medium == 1);
                REQUIRE_FALSE(v.interface);
                REQUIRE(v.behind == v.before);
            }
        }
}
