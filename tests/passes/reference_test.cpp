// Every method against pictures by another program.
#include <doctest/doctest.h>

#include "passes/pictures.h"

using namespace lsde;
using namespace lsde::test;

namespace {

struct Case {
    const char* scene;
    const char* truth;
    const char* integrator;
    uint64_t samples;
    double mean;    // largest relative error of the mean
    double relMse;  // largest noise-corrected relMSE
};

void check(const Case& c, const PictureSettings& settings) {
    CAPTURE(c.scene);
    CAPTURE(c.integrator);
    const Truth truth = truthOf(c.truth);
    const RgbImage picture = shrunk(render(c.scene, settings).picture, truth.mean.width);
    CHECK(meanOf(picture) / meanOf(truth.mean) == doctest::Approx(1).epsilon(c.mean));
    CHECK(noiseCorrectedRelMse(picture, truth) < c.relMse);
}

}  // namespace

TEST_CASE("pictures agree with those of another renderer") {
    // The small scenes have coarser balls than the truth: some of their error is that. What the path tracer and the
    // light tracer are short of is noise.
    const Case photon[] = {
        {"glass-sphere", "glass-sphere", "photon", 16, 0.004, 6e-4},
        {"ring", "ring", "photon", 16, 0.005, 8e-4},
        {"cornell-small", "cornell", "photon", 16, 0.005, 2e-3},
        {"pool-small", "pool", "photon", 16, 0.006, 3e-3},
        {"point-glass-small", "point-glass", "photon", 16, 0.005, 1e-3},
        {"lights", "lights", "photon", 16, 0.003, 6e-4},
    };
    for (const Case& c : photon) check(c, settingsFor("photon", 256, c.samples, 1000000));
    const Case others[] = {
        {"glass-sphere", "glass-sphere", "path", 1024, 0.01, 2e-3},
        {"cornell-small", "cornell", "path", 1024, 0.01, 3e-3},
        {"lights", "lights", "path", 256, 0.003, 3e-4},
        {"point-glass-small", "point-glass.DE-ptracer", "light", 4096, 0.006, 2e-3},
    };
    for (const Case& c : others) check(c, settingsFor(c.integrator, 64, c.samples));
}

TEST_CASE("single layers agree with pictures of just these paths") {
    PictureSettings s = settingsFor("photon", 64, 256, 1000000);
    s.paths = {{"lsde", "LS+DE"}, {"seen", "LS+DS+E"}, {"short", "L[DS]?E"}};
    const RenderResult r = render("glass-sphere", s);
    const auto error = [&](const std::string& layer, const std::string& truth) {
        return meanOf(r.image.layer(layer)) / meanOf(truthOf(truth).mean);
    };
    CHECK(error("lsde", "glass-sphere.LSpDE") == doctest::Approx(1).epsilon(0.006));
    CHECK(error("seen", "glass-sphere.LSpDSpE") == doctest::Approx(1).epsilon(0.015));
    CHECK(error("short", "glass-sphere.LE_LDE_LSE") == doctest::Approx(1).epsilon(0.004));
}

TEST_CASE("progressive passes converge to the same picture") {
    PictureSettings s = settingsFor("photon", 256, 8, 1000000);
    s.progressive = 8;
    check({"glass-sphere", "glass-sphere", "progressive", 8, 0.005, 2e-3}, s);
}

TEST_CASE("the second index gives the same picture as the first, to the bit") {
    PictureSettings s = settingsFor("photon", 32, 4, 100000);
    const RgbImage kd = render("glass-sphere-small", s).picture;
    s.index = IndexKind::Flann;
    const RgbImage flann = render("glass-sphere-small", s).picture;
    CHECK(std::fabs(meanOf(kd) / meanOf(flann) - 1) < 1e-6);
}

TEST_CASE("a path tracer under a point light warns of the paths that it cannot make") {
    RunContext run(0, 1);
    renderPicture(sceneOf("point-glass-small"), integratorByName("path"), settingsFor("path", 8, 1), run);
    REQUIRE(run.warnings().size() == 1);
    CHECK(run.warnings()[0].find("LS+D") != std::string::npos);
}

TEST_CASE("no pixel is anything but a number") {
    for (const char* scene : {"glass-sphere-small", "nested", "rough-metal", "pane-ball"})
        for (const Rgb p : render(scene, settingsFor("photon", 48, 4, 50000)).picture.pixels) REQUIRE(isFinite(p));
}
