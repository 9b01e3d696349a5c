// Who owns a path, rendered: multi-pass photon mapping against methods that share none of its estimates.
#include <doctest/doctest.h>

#include "passes/pictures.h"

using namespace lsde;
using namespace lsde::test;

namespace {

// One seed's random numbers meet the same surfaces at the same places, but for rounding.
void checkSamePaths(const std::string& a, const std::string& b) {
    const Estimate ofA = estimate(a, settingsFor("path", 32, 64), 2, 8);
    const Estimate ofB = estimate(b, settingsFor("path", 32, 64), 2, 8);
    for (size_t i = 0; i < ofA.mean.size(); ++i) {
        CAPTURE(i);
        CHECK(ofA.mean[i] == doctest::Approx(ofB.mean[i]).epsilon(0.01));
    }
}

}  // namespace

TEST_CASE("a lamp behind a pane, with and without a glass ball: photons agree with path tracing") {
    for (const char* scene : {"pane", "pane-ball"}) {
        CAPTURE(scene);
        checkAgreement(estimate(scene, settingsFor("photon", 32, 64), 6, 4),
                       estimate(scene, settingsFor("path", 32, 1024), 6, 4), 0.02);
    }
}

TEST_CASE("highlights on rough metal and the light that it throws: photons agree with path tracing under a lamp") {
    checkAgreement(estimate("rough-metal-area", settingsFor("photon", 32, 64), 6, 4),
                   estimate("rough-metal-area", settingsFor("path", 32, 512), 6, 4), 0.02);
}

TEST_CASE("and with light tracing under a point light") {
    PictureSettings photon = settingsFor("photon", 32, 64), light = settingsFor("light", 32, 512);
    // What the camera sees in the metal is not the light tracer's: paths that end on the floor are.
    photon.paths = light.paths = {{"floor", "L.*DE"}};
    checkAgreement(estimate("rough-metal", photon, 6, 4, "floor"), estimate("rough-metal", light, 6, 4, "floor"), 0.02);
    // The highlight itself is L G E: direct light for one, a connection for the other.
    photon.paths = light.paths = {{"highlight", "LGE"}};
    checkAgreement(estimate("rough-metal", photon, 6, 4, "highlight"),
                   estimate("rough-metal", light, 6, 4, "highlight"), 0.02);
}

TEST_CASE("a caustic on bent shading normals: photons agree with path tracing and with light tracing") {
    const Estimate photon = estimate("bent-normals", settingsFor("photon", 32, 64), 6, 4);
    checkAgreement(photon, estimate("bent-normals", settingsFor("path", 32, 1024), 6, 4), 0.02);
}

TEST_CASE(
    "water in a glass, as overlapping and as exact meshes: photons agree with path tracing, and both with each other") {
    const Estimate overlap = estimate("water-glass-overlap", settingsFor("photon", 32, 64), 6, 4);
    const Estimate exact = estimate("water-glass-exact", settingsFor("photon", 32, 64), 6, 4);
    checkAgreement(overlap, exact, 0.02);
    checkSamePaths("water-glass-overlap", "water-glass-exact");
    const Estimate path = estimate("water-glass-exact", settingsFor("path", 32, 2048), 6, 4);
    checkAgreement(exact, path, 0.03);
    checkAgreement(overlap, path, 0.03);
}

TEST_CASE("ice afloat in a glass of water, as overlapping and as touching meshes: paths are the same ones") {
    checkSamePaths("iced-water-overlap", "iced-water-exact");
}

TEST_CASE("and photons of both agree with each other") {
    checkAgreement(estimate("iced-water-overlap", settingsFor("photon", 32, 16), 4, 4),
                   estimate("iced-water-exact", settingsFor("photon", 32, 16), 4, 4), 0.02);
}
