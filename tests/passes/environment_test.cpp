// Light from beyond the scene, rendered: by photons, by paths and by light tracing.
#include <doctest/doctest.h>

#include "passes/pictures.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

void addCamera(SceneDescription& d, Vec3 position, Vec3 target, float yfov) {
    CameraDescription c;
    c.position = position;
    c.back = glm::normalize(position - target);
    c.right = glm::normalize(glm::cross(Vec3(0, 1, 0), c.back));
    c.up = glm::cross(c.back, c.right);
    c.yfov = yfov;
    c.aspectRatio = 1;
    d.cameras.push_back(c);
}

// A glass ball and a mirror ball on a floor.
SceneBuilder balls() {
    SceneBuilder builder;
    builder.add(plate({0, 0, 0}, 4), lambert(Rgb(0.6F)), "floor");
    builder.add(sphere({-0.7F, 0.61F, 0}, 0.6F, 4), glass(1.5F), "glass");
    builder.add(sphere({0.8F, 0.51F, 0.3F}, 0.5F, 4), metal(0, Rgb(0.9F)), "mirror");
    return builder;
}

std::unique_ptr<Scene> seenFromAbove(const SceneBuilder& builder) {
    SceneDescription d = builder.description();
    addCamera(d, {0, 3, 4.5F}, {0, 0.3F, 0}, 0.6F);
    return std::make_unique<Scene>(d);
}

// A closed room, 4 x 3 x 4 m, with a pane of glass in its one window, towards +X; seen from the wall across.
std::unique_ptr<Scene> roomWithWindow() {
    SceneBuilder builder;
    const Material white = lambert(Rgb(0.7F)), red = lambert(Rgb(0.7F, 0.2F, 0.2F));
    builder.add(quad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}), white, "floor");
    builder.add(quad({-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}), white, "ceiling");
    builder.add(quad({-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}), red, "far wall");
    builder.add(quad({-2, 0, 2}, {-2, 3, 2}, {2, 3, 2}, {2, 0, 2}), white, "near wall");
    builder.add(quad({-2, 0, 2}, {-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}), white, "left wall");
    const auto strip = [&](float y0, float y1, float z0, float z1) {
        return quad({2, y0, z1}, {2, y1, z1}, {2, y1, z0}, {2, y0, z0});
    };
    Mesh windowWall = strip(0, 1, -2, 2);
    append(windowWall, strip(2.2F, 3, -2, 2));
    append(windowWall, strip(1, 2.2F, -2, -0.8F));
    append(windowWall, strip(1, 2.2F, 0.8F, 2));
    builder.add(windowWall, white, "window wall");
    builder.add(strip(1, 2.2F, -0.8F, 0.8F), thinWall(Rgb(1)), "pane");
    builder.environment(spottedSky(), 1.2F);
    builder.sunDisc({1, 0.7F, 0.2F}, 3, Rgb(300));
    SceneDescription d = builder.description();
    addCamera(d, {-1.8F, 1.5F, 1.7F}, {0.6F, 0.9F, -0.6F}, 1);
    return std::make_unique<Scene>(d);
}

}  // namespace

TEST_CASE("caustics under an environment: photons agree with path tracing") {
    SceneBuilder builder = balls();
    builder.environment(spottedSky(), 1.2F);
    const auto scene = seenFromAbove(builder);
    checkAgreement(estimate(*scene, settingsFor("photon", 32, 64), 5, 4),
                   estimate(*scene, settingsFor("path", 32, 1024), 5, 4), 0.02);
}

TEST_CASE("and with light tracing, on all that is not seen in mirrors or through glass") {
    SceneBuilder builder = balls();
    builder.environment(spottedSky(), 1.2F);
    const auto scene = seenFromAbove(builder);
    PictureSettings photon = settingsFor("photon", 32, 64), light = settingsFor("light", 32, 768);
    photon.paths = light.paths = {{"floor", "L.*DE"}};
    checkAgreement(estimate(*scene, photon, 5, 4, "floor"), estimate(*scene, light, 5, 4, "floor"), 0.02);
}

TEST_CASE("caustics under a wide sun and a sky: photons agree with path tracing") {
    SceneBuilder builder = balls();
    builder.environment(RgbImage(4, 2, Rgb(0.3F, 0.4F, 0.6F)));
    builder.sunDisc({0.6F, 0.8F, -0.3F}, 6, Rgb(40, 35, 25));
    const auto scene = seenFromAbove(builder);
    checkAgreement(estimate(*scene, settingsFor("photon", 32, 64), 5, 4),
                   estimate(*scene, settingsFor("path", 32, 1536), 5, 4), 0.02);
}

TEST_CASE("a closed room lit through the pane of its window by sky and sun: photons agree with path tracing") {
    const auto scene = roomWithWindow();
    checkAgreement(estimate(*scene, settingsFor("photon", 32, 64, 500000), 5, 4),
                   estimate(*scene, settingsFor("path", 32, 1024), 5, 4), 0.02);
}

TEST_CASE("in even light from all around lossless bodies vanish, and a grey floor is its albedo") {
    SceneBuilder builder;
    builder.add(sphere({0, 0.61F, 0}, 0.6F, 4), glass(1.5F), "glass");
    builder.add(sphere({1.2F, 0.61F, 0}, 0.5F, 4), metal(0), "mirror");
    builder.environment(RgbImage(4, 2, Rgb(2)));
    const auto scene = seenFromAbove(builder);
    for (const char* integrator : {"path", "photon"}) {
        const Estimate e = estimate(*scene, settingsFor(integrator, 32, 64, 10000), 4, 4);
        for (const double mean : e.mean) CHECK(mean == doctest::Approx(2).epsilon(0.002));
    }
    SceneBuilder floor;
    floor.add(plate({0, 0, 0}, 50), lambert(Rgb(0.6F)), "floor");
    floor.environment(RgbImage(4, 2, Rgb(2)));
    SceneDescription d = floor.description();
    addCamera(d, {0, 3, 4.5F}, {0, 0.3F, 0}, 0.6F);
    const Scene open(d);
    for (const char* integrator : {"path", "photon", "light"}) {
        CAPTURE(integrator);
        const Estimate e = estimate(open, settingsFor(integrator, 32, 256, 10000), 4, 2);
        for (size_t i = 0; i < e.mean.size(); ++i) CHECK(std::fabs(e.mean[i] - 1.2) < 5 * e.error[i] + 0.001);
    }
}
