#include "passes/time_balance.h"

#include <doctest/doctest.h>

#include "passes/integrators/registry.h"
#include "scene/gltf.h"

using namespace lsde;

namespace {

constexpr double kSeconds = 30, kFirstSeconds = 0.2;

FirstLook looked(double sampleSeconds, double camera, double photons) { return {sampleSeconds, 4, {camera, photons}}; }

double shareOf(const FirstLook& look) { return photonSeconds(look, kFirstSeconds, kSeconds) / kSeconds; }

}  // namespace

TEST_CASE("photons get more of the time where they are noisier, less where samples are noisier or dearer") {
    const double share = shareOf(looked(1, 2e-4, 2e-4));
    CHECK(share > 0.3);
    CHECK(share < 0.7);
    CHECK(shareOf(looked(1, 2e-4, 1e-3)) > share + 0.05);
    CHECK(shareOf(looked(1, 1e-3, 2e-4)) < share - 0.05);
    CHECK(shareOf(looked(2, 2e-4, 2e-4)) < share - 0.05);
}

TEST_CASE("neither photons nor samples are left without time") {
    CHECK(shareOf(looked(1, 1, 0)) == doctest::Approx(0.2));
    CHECK(shareOf(looked(1, 0, 1)) > 0.7);
    CHECK(shareOf(looked(1, 0, 1)) < 0.8);
}

TEST_CASE("tiles tell what the whole picture's samples are like") {
    const Scene scene(loadGltf(LSDE_SCENES "/glass-sphere-small.glb"));
    RunContext run;
    const std::vector<bool> lights = scene.lightSelection({});
    const RenderLayers layers({}, {});
    const IntegratorEntry& method = integratorByName("path");
    const MakeIntegrator make = [&](const Camera& c) { return method.make({scene, c, layers, lights, nullptr, 1}); };
    const Camera camera(scene.camera(""), 96, 96);
    const Clock clock({}, {});
    const FirstLook tiles = lookAtTiles(camera, 0.25, make, clock, run),
                    whole = lookAtTiles(camera, 1, make, clock, run);
    CHECK(tiles.samples == whole.samples);
    CHECK(tiles.sampleSeconds > 0);
    CHECK(tiles.error.camera == doctest::Approx(whole.error.camera).epsilon(0.5));
    CHECK(tiles.error.camera > 0);
    CHECK(tiles.error.photons == 0);
}
