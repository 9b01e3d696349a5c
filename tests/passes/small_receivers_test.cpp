// Caustics on what is smaller than kernels.
#include <doctest/doctest.h>

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
        for (const RenderResult& picture : pictures(*scene, s, passes > 0 ? 40 : 16)) {
            CHECK(picture.storedPhotons < 4000);
            seen.add(meanOf(picture.picture));
        }
        MESSAGE(seen.value(), " +- ", seen.standardError(), ", light traced ", expected);
        CHECK(seen.standardError() < 0.02 * expected);
        CHECK(seen.value() / expected == doctest::Approx(1).epsilon(0.05).scale(0));
    }
}
