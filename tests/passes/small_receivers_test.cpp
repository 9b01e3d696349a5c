// Caustics on what is smaller than kernels.
#include <doctest/doctest.h>

#include <numeric>

#include "passes/pictures.h"
#include "support/scenes.h"
#include "support/statistics.h"

using namespace lsde;
using namespace lsde::test;

namespace {

// A hundred white balls of 2 cm, which a mirror lights from below.
std::unique_ptr<Scene> balls() {
    SceneBuilder scene;
    scene.add(plate({0, 0, 0}, 0.7F), metal(0));
    for (const float x : {-0.45F, -0.35F, -0.25F, -0.15F, -0.05F, 0.05F, 0.15F, 0.25F, 0.35F, 0.45F})
        for (const float z : {-0.45F, -0.35F, -0.25F, -0.15F, -0.05F, 0.05F, 0.15F, 0.25F, 0.35F, 0.45F})
            scene.add(sphere({x, 0.4F, z}, 0.01F, 3), lambert(Rgb(0.5F)));
    scene.sun({0.5F, -1, 0.1F}, Rgb(2));
    scene.camera({0, 0.1F, 1.2F}, {0, 0.4F, 0}, 55);
    return scene.build();
}

// A ball of few facets, smoothly shaded, which a mirror lights from below and one side.
std::unique_ptr<Scene> coarseBall() {
    SceneBuilder scene;
    scene.add(plate({0, 0, 0}, 1.5F), metal(0));
    scene.add(sphere({0, 0.8F, 0}, 0.3F, 2), lambert(Rgb(0.5F)));
    scene.sun({0.5F, -1, 0.1F}, Rgb(2));
    scene.camera({0, 0.3F, 1.5F}, {0, 0.8F, 0}, 26);
    return scene.build();
}

// White labels before a blue wall, a sheet and a board, which nothing lights but a lamp in front of them: of the wall's
// light only their backs get any.
std::unique_ptr<Scene> labels() {
    const auto board = [](float x, float z) {
        return quad({x - 0.5F, -0.5F, z}, {x + 0.5F, -0.5F, z}, {x + 0.5F, 0.5F, z}, {x - 0.5F, 0.5F, z});
    };
    SceneBuilder scene;
    scene.add(quad({-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}), lambert({0.1F, 0.1F, 0.8F}));
    scene.add(board(-1, 0.1F), lambert(Rgb(0.8F)));
    scene.add(joined(board(1, 0.1F), flipped(board(1, 0.09F))), lambert(Rgb(0.8F)));
    scene.add(plate({0, 3, 4}, 0.5F, false), emitter(Rgb(20)));
    scene.camera({0, 0, 6}, {0, 0, 0}, 30);
    return scene.build();
}

}  // namespace

TEST_CASE("small balls get all of their light, however few photons each has") {
    const std::unique_ptr<Scene> scene = balls();
    PictureSettings s = settingsFor("light", 64, 400);
    s.only = "LS+DE";
    const double expected = meanOf(render(*scene, s).picture);
    s.integrator = "photon";
    s.spp = 3;  // evenly spread: pixels without a photon are as many as they are
    s.photons = 100000;
    for (const uint32_t passes : {0U, 3U}) {  // progressive ones, whose photons are fewer in each
        CAPTURE(passes);
        s.progressive = passes;
        Mean seen;
        for (const RenderResult& picture : pictures(*scene, s, passes > 0 ? 48 : 16)) {
            CHECK(picture.storedPhotons < 4000);
            seen.add(meanOf(picture.picture));
        }
        MESSAGE(seen.value(), " +- ", seen.standardError(), ", light traced ", expected);
        CHECK(seen.standardError() < 0.02 * expected);
        CHECK(seen.value() / expected == doctest::Approx(1).epsilon(0.05).scale(0));
    }
}

TEST_CASE("a photon weighs by the facet that it met, where shading turns away from it") {
    // By the facet at which it is gathered, the terminator is several times too bright, and all of the ball by 3%.
    const std::unique_ptr<Scene> scene = coarseBall();
    PictureSettings s = settingsFor("light", 64, 1000);
    s.only = "LS+DE";
    const std::vector<double> expected = estimate(*scene, s, 1, 8).mean;
    const auto total = [](const std::vector<double>& blocks) {
        return std::accumulate(blocks.begin(), blocks.end(), 0.0);
    };
    s.integrator = "photon";
    s.spp = 16;
    constexpr int kPictures = 4;  // the brightest of one's noise may be as bright as what is looked for
    for (const auto& [photons, most] : {std::pair<uint64_t, float>(100000, 0.02F), {1000000, 0.01F}}) {
        CAPTURE(photons);
        s.photons = photons;
        const std::vector<double> seen = estimate(*scene, s, kPictures, 8).mean;
        CHECK(total(seen) / total(expected) == doctest::Approx(1).epsilon(most).scale(0));
        double above = 0;
        for (size_t i = 0; i < seen.size(); ++i) above = std::max(above, seen[i] - expected[i]);
        MESSAGE("too bright by ", above);
        CHECK(above < 0.003);  // of .26, the brightest
    }
}

TEST_CASE("kept irradiance of a wall does not light what hangs before it") {
    const std::unique_ptr<Scene> scene = labels();
    PictureSettings s = settingsFor("photon", 48, 8, 300000);
    s.only = "LDD+E";
    const RgbImage seen = render(*scene, s).picture;
    // Fifteen pixels are a metre.
    for (const int x : {9, 39})
        for (int dy = -5; dy < 5; ++dy)
            for (int dx = -5; dx < 5; ++dx) {
                CAPTURE(x + dx);
                CAPTURE(24 + dy);
                CHECK(seen.at(x + dx, 24 + dy).z < 1e-3F);
            }
    CHECK(meanOf(seen) > 1e-4);  // the wall has some from the labels' backs
}
