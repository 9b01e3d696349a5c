// The scenes made to be looked at (scenes/README.md): their light, held against unaimed emission and light tracing.
#include <doctest/doctest.h>

#include <numeric>

#include "passes/pictures.h"
#include "passes/scene_source.h"

using namespace lsde;
using namespace lsde::test;

namespace {

struct Sun {
    float elevationDeg, azimuthDeg;
};

struct Exhibit {
    const char* name;
    std::optional<Sun> sun;  // of --sky, by which it is lit
    glm::dvec3 watts;        // that land as L S+ D on all objects
    double wattsTolerance;
    double photonsPerPath;  // of the caustic class
};

const Exhibit& exhibit(const std::string& name) {
    // Flux: `emit --no-aim`, 40 million paths (chandelier and pool: 4 million, glass blocks: 16 million).
    static const Exhibit all[] = {
        {"wine-glass", {}, {0.01969, 0.01471, 0.01325}, 0.02, 0.436},
        {"chandelier", {}, {49.54, 42.09, 32.15}, 0.002, 0.930},
        {"pool-net", Sun{55, 140}, {1.6077e6, 1.8711e6, 2.1218e6}, 0.005, 0.513},
        {"glass-blocks", Sun{38, -78}, {1.2064e5, 1.1476e5, 1.0732e5}, 0.01, 0.494},
    };
    return *std::find_if(std::begin(all), std::end(all), [&](const Exhibit& e) { return e.name == name; });
}

const Scene& sceneOf(const Exhibit& e) {
    static std::map<std::string, std::unique_ptr<Scene>> loaded;
    std::unique_ptr<Scene>& scene = loaded[e.name];
    if (!scene) {
        SceneSettings settings;
        if (e.sun) {
            settings.sky.emplace();
            settings.sky->sunElevationDeg = e.sun->elevationDeg;
            settings.sky->sunAzimuthDeg = e.sun->azimuthDeg;
        }
        RunContext run(0, 0);
        scene = loadScene(std::string(LSDE_SCENES) + "/" + e.name + ".glb", settings, run);
    }
    return *scene;
}

const PhotonMap& mapOf(const Exhibit& e) {
    static std::map<std::string, std::unique_ptr<PhotonMap>> emitted;
    std::unique_ptr<PhotonMap>& map = emitted[e.name];
    if (!map) {
        EmitSettings settings;
        settings.photons = 120'000;
        settings.store = Store::Caustic;
        RunContext run(0, 1);
        map = std::make_unique<PhotonMap>(emitPhotons(sceneOf(e), settings, run));
    }
    return *map;
}

// Approx alone adds 1 to what its epsilon is a share of.
doctest::Approx within(double share, double value) { return doctest::Approx(value).epsilon(share).scale(0); }

void checkFlux(const std::string& name) {
    const Exhibit& e = exhibit(name);
    const PhotonMap& map = mapOf(e);
    const size_t objects = map.header.objects.size(), first = static_cast<size_t>(PhotonClass::Caustic) * objects;
    const auto paths = static_cast<double>(map.header.emittedPaths());
    for (int c = 0; c < 3; ++c) {
        CAPTURE(c);
        double watts = 0;
        for (size_t o = 0; o < objects; ++o) watts += map.header.ledger.flux[first + o].toDouble(c) / paths;
        CHECK(watts == within(e.wattsTolerance, e.watts[c]));
    }
    CHECK(static_cast<double>(map.photons(PhotonClass::Caustic).count) / paths == within(0.01, e.photonsPerPath));
    CHECK(map.header.ledger.balance() == FixedRgb());
}

// Means of the upper rows of a picture 32 pixels wide and high, of what the camera sees neither in mirrors nor through
// glass (or of the caustics in it); by light tracing, 50 CPU seconds at 64 x 64.
struct Mean {
    const char* paths;
    int rows;
    glm::dvec3 radiance;
    double tolerance;  // the picture's noise, and what kernels and cached irradiance are off by
};

void checkPicture(const std::string& name, const std::vector<Mean>& means) {
    // Means by 200,000 paths and 6 samples differ by .6 to .9%: it would depend on how a processor rounds which of them
    // are within the tolerances.
    PictureSettings s = settingsFor("photon", 32, 24, 800'000);
    for (const Mean& mean : means)
        s.paths.push_back({mean.paths == std::string("LS+DE") ? "thrown" : "seen", mean.paths});
    const RenderResult result = render(sceneOf(exhibit(name)), s);
    for (size_t i = 0; i < means.size(); ++i) {
        const Mean& mean = means[i];
        CAPTURE(mean.paths);
        const RgbImage image = result.image.layer(s.paths[i].name);
        const auto end = image.pixels.begin() + static_cast<std::ptrdiff_t>(mean.rows) * image.width;
        const Rgb sum = std::accumulate(image.pixels.begin(), end, Rgb(0));
        for (int c = 0; c < 3; ++c) {
            CAPTURE(c);
            CHECK(sum[c] / static_cast<float>(mean.rows * image.width) == within(mean.tolerance, mean.radiance[c]));
        }
    }
}

}  // namespace

TEST_CASE("a glass of red wine throws as much light on the table, as red, as without aiming") {
    checkFlux("wine-glass");
}
TEST_CASE("so does a chandelier of fifty lamps in its room") { checkFlux("chandelier"); }
TEST_CASE("so does water on the tiles of a pool under sun and sky") { checkFlux("pool-net"); }
TEST_CASE("so do glass blocks in a window, the room's only light") { checkFlux("glass-blocks"); }

TEST_CASE("each of the chandelier's fifty lamps has its caustic, as sure as the surest within a factor of three") {
    const PhotonMap& map = mapOf(exhibit("chandelier"));
    std::map<std::string, std::array<double, 2>> moments;  // of each lamp's photons: sums of power and its square
    const PhotonTreeView photons = map.photons(PhotonClass::Caustic);
    for (const PhotonPayload& p : photons.payload) {
        auto& [power, squares] = moments[map.header.lights[p.light]];
        power += luminance(unpackPower(p.power));
        squares += square(luminance(unpackPower(p.power)));
    }
    double least = 1, most = 0;
    int lamps = 0;
    for (const auto& [name, sums] : moments) {
        if (!name.starts_with("lamp-")) continue;
        ++lamps;
        const double error = std::sqrt(sums[1]) / sums[0];
        least = std::min(least, error);
        most = std::max(most, error);
    }
    CHECK(lamps == 50);
    CHECK(most < 3 * least);
}

TEST_CASE("a small picture of the wine glass is as bright as light tracing has it") {
    checkPicture("wine-glass",
                 {{"LS+DE", 32, {0.01169, 0.00699, 0.00568}, 0.015}, {"L.*DE", 32, {0.2540, 0.2247, 0.1851}, 0.003}});
}

// The ceiling alone: a few samples of thin brass tubes, whose kernels are small and mostly empty, say little.
TEST_CASE("so is the ceiling over the chandelier") {
    checkPicture("chandelier",
                 {{"LS+DE", 8, {0.4061, 0.3220, 0.2196}, 0.01}, {"L.*DE", 8, {0.5074, 0.3653, 0.2364}, 0.01}});
}

TEST_CASE("so are the borders of the pool") { checkPicture("pool-net", {{"L.*DE", 32, {4785, 4094, 3895}, 0.008}}); }

TEST_CASE("so is the room behind glass blocks") {
    checkPicture("glass-blocks", {{"LS+DE", 32, {607.6, 568.5, 476.7}, 0.03}, {"L.*DE", 32, {1168, 1070, 868}, 0.03}});
}
