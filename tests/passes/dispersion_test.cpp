// Dispersed light: its energy and colour, and every method against the others.
#include <doctest/doctest.h>

#include "bsdf/cauchy.h"
#include "bsdf/fresnel.h"
#include "passes/pictures.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

constexpr float kIor = 1.78472F, kDispersion = 20 / 25.68F;

Material flint() {
    Material m = glass(kIor);
    m.dispersion = kDispersion;
    return m;
}

glm::dvec3 causticOn(const PhotonMap& map, const std::string& object) {
    const auto& objects = map.header.objects;
    const auto o = static_cast<size_t>(std::find(objects.begin(), objects.end(), object) - objects.begin());
    const FixedRgb& sum = map.header.ledger.flux[static_cast<size_t>(PhotonClass::Caustic) * objects.size() + o];
    return glm::dvec3(sum.toDouble(0), sum.toDouble(1), sum.toDouble(2)) /
           static_cast<double>(map.header.emittedPaths());
}

// Blocks of each channel agree within five standard errors and the kernels' bias, and so does their sum. (What kernels
// spill over edges costs the prism's screen .3% without dispersion too.)
void checkAgreement(const std::vector<RenderResult>& a, const std::vector<RenderResult>& b, const std::string& layer,
                    double bias) {
    CAPTURE(layer);
    for (int c = 0; c < 3; ++c) {
        CAPTURE(c);
        const auto channel = [c](Rgb v) { return v[c]; };
        const Estimate x = estimate(a, 4, layer, channel), y = estimate(b, 4, layer, channel);
        double sumX = 0, sumY = 0, error2 = 0;
        const double most = *std::max_element(y.mean.begin(), y.mean.end());
        for (size_t i = 0; i < x.mean.size(); ++i) {
            CAPTURE(i);
            CAPTURE(x.mean[i]);
            CAPTURE(y.mean[i]);
            CHECK(std::fabs(x.mean[i] - y.mean[i]) < 5 * std::hypot(x.error[i], y.error[i]) + bias * most);
            sumX += x.mean[i];
            sumY += y.mean[i];
            error2 += square(x.error[i]) + square(y.error[i]);
        }
        CAPTURE(sumX / sumY);
        MESSAGE(layer << " channel " << c << ": ratio of means " << sumX / sumY << " +- "
                      << std::sqrt(error2) / std::fabs(sumY));
        CHECK(std::fabs(sumX - sumY) < 4 * std::sqrt(error2) + 0.006 * std::fabs(sumY));
    }
}

}  // namespace

TEST_CASE("through a pane of flint each channel's flux is that of its wavelengths") {
    // What a slab lets through after all inner reflections is (1 - R) / (1 + R), which falls towards the violet.
    SceneBuilder builder;
    builder.add(plate({0, 0, 0}, 1), lambert(Rgb(0.5F)), "floor").switches.receives = true;
    builder.add(box({-2, 0.5F, -2}, {2, 0.7F, 2}), flint(), "pane");
    builder.sun({0, -1, 0}, Rgb(3, 2, 1));
    const auto scene = builder.build();
    glm::dvec3 expected(0);
    for (int n = 1; n <= kWavelengths; ++n) {
        const auto wavelength = static_cast<WavelengthId>(n);
        const double r = fresnelDielectric(1, cauchyIor(kIor, kDispersion, wavelengthNm(wavelength))).reflectance;
        expected += glm::dvec3(wavelengthWeight(wavelength)) * ((1 - r) / (1 + r) / kWavelengths);
    }
    expected *= 4.0 * glm::dvec3(3, 2, 1);  // W on 2 x 2 m
    EmitSettings s;
    s.photons = 1 << 18;
    s.store = Store::Caustic;
    RunContext run(0, 1);
    const PhotonMap map = emitPhotons(*scene, s, run);
    const glm::dvec3 flux = causticOn(map, "floor");
    for (int c = 0; c < 3; ++c) {
        CAPTURE(c);
        CHECK(flux[c] == doctest::Approx(expected[c]).epsilon(0.004));
    }
    CHECK(map.header.ledger.balance() == FixedRgb());
    const PhotonTreeView photons = map.photons(PhotonClass::Caustic);
    glm::dvec3 stored(0);
    for (const PhotonPayload& p : photons.payload) stored += glm::dvec3(rgbPower(p));
    stored /= static_cast<double>(map.header.emittedPaths());
    for (int c = 0; c < 3; ++c) CHECK(stored[c] == doctest::Approx(flux[c]).epsilon(1e-3));
}

TEST_CASE("a prism's rainbow and a lens's coloured rim: photons agree with light tracing, channel by channel") {
    for (const char* scene : {"prism-small", "lens-small"}) {
        CAPTURE(scene);
        PictureSettings photon = settingsFor("photon", 64, 16, 500'000), light = settingsFor("light", 64, 512);
        photon.paths = light.paths = {{"rainbow", "LS+DE"}};
        photon.only = light.only = "LS+DE";
        checkAgreement(pictures(sceneOf(scene), photon, 5), pictures(sceneOf(scene), light, 5), "rainbow", 0.02);
    }
}

TEST_CASE("a flint ball's caustic, seen beside it and through it: photons agree with path tracing") {
    const Scene& scene = sceneOf("flint-ball");
    PictureSettings photon = settingsFor("photon", 32, 32, 500'000), path = settingsFor("path", 32, 1024);
    photon.paths = path.paths = {{"beside", "LS+DE"}, {"through", "LS+DS+E"}};
    photon.only = path.only = "LS*(DS*)?E";
    const auto a = pictures(scene, photon, 5), b = pictures(scene, path, 5);
    for (const char* layer : {"beside", "through"}) checkAgreement(a, b, layer, 0.02);
}

TEST_CASE("prism, gem and magnifying glass throw the light on the floor that they threw before") {
    // Means of a million paths; the prism's beam is a two-hundredth of what the sun sends at it.
    struct Case {
        const char* scene;
        glm::dvec3 watts;
        double tolerance;
    };
    const Case cases[] = {{"prism", {2.64, 2.63, 2.48}, 0.04},
                          {"gem", {1.174, 1.181, 1.169}, 0.015},
                          {"magnifier", {1.356, 1.353, 1.348}, 0.01}};
    for (const Case& c : cases) {
        CAPTURE(c.scene);
        EmitSettings s;
        s.photons = 250'000;
        RunContext run(0, 1);
        const glm::dvec3 flux = causticOn(emitPhotons(sceneOf(c.scene), s, run), "floor");
        for (int channel = 0; channel < 3; ++channel) {
            CAPTURE(channel);
            CHECK(flux[channel] == doctest::Approx(c.watts[channel]).epsilon(c.tolerance));
        }
    }
}
