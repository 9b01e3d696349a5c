// Alpha as coverage, for rays of the camera, shadow rays and photons alike, against pictures and fluxes known exactly.
#include <doctest/doctest.h>

#include "passes/pictures.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

Material blend(Material material, float alpha) {
    material.alphaMode = AlphaMode::Blend;
    material.alpha = alpha;
    return material;
}

// Emits 1 and reflects half.
Material wall() {
    Material m = lambert(Rgb(0.5F));
    m.emission = Rgb(1);
    m.doubleSided = true;
    return m;
}

// Mean of the picture from the middle of the scene, and its standard error over seeds.
struct Mean {
    double value = 0, error = 0;
};
Mean meanRadiance(const Scene& scene, const std::string& integrator) {
    constexpr int kSeeds = 6;
    double sum = 0, squares = 0;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
        RunContext run(0, seed);
        const double mean = meanOf(
            renderPicture(scene, integratorByName(integrator), settingsFor(integrator, 16, 16, 20000), run).picture);
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / kSeeds;
    return {mean, std::sqrt(std::max(0.0, squares / kSeeds - mean * mean) / (kSeeds - 1))};
}

}  // namespace

TEST_CASE("in a white furnace what covers half of the rest is not seen, and a black veil takes its share") {
    for (const bool thinWalls : {false, true})
        for (const char* integrator : {"path", "photon"}) {
            CAPTURE(thinWalls);
            CAPTURE(integrator);
            SceneBuilder b;
            b.add(flipped(box({-2, -2, -2}, {2, 2, 2})), wall());
            b.add(box({-1, -1.5F, -1.9F}, {1, 0.5F, -1.5F}), blend(wall(), 0.5F));
            // Behind the camera, so that shadow rays have to ask for walls one by one.
            if (thinWalls) b.add(quad({-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}), thinWall(Rgb(1)));
            SceneDescription furnace = b.build()->description();
            CameraDescription eye;
            eye.position = Vec3(0.1F, 0.2F, 0.3F);
            eye.yfov = 1.2F;
            furnace.cameras = {eye};
            const Mean open = meanRadiance(Scene(furnace), integrator);
            CHECK(std::fabs(open.value - 2) < 5 * open.error + 0.004);

            // 10 cm before the camera, and far from all else.
            Mesh veil = quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
            for (Vec3& p : veil.positions) p = 0.2F * p + Vec3(0.1F, 0.2F, 0.2F);
            veil.material = static_cast<uint32_t>(furnace.materials.size());
            furnace.meshes.push_back(veil);
            furnace.materials.push_back(blend(lambert(Rgb(0)), 0.25F));
            const Mean veiled = meanRadiance(Scene(furnace), integrator);
            // It hides from the room a quarter of 0.04 of 96 m2, seen from both sides.
            CHECK(std::fabs(veiled.value - 1.5) < 5 * veiled.error + 0.01);
        }
}

TEST_CASE("photons pass what they are not covered by, without an event, towards the caustic and after it") {
    const auto caustic = [](float before, float after) {
        SceneBuilder b;
        // A sun from above, a mirror at 45 degrees, a wall that receives.
        b.sun({0, -1, 0}, Rgb(1));
        b.add(quad({-1, -1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, 1, -1}), metal(0), "mirror");
        b.add(flipped(quad({-2, -2, 4}, {2, -2, 4}, {2, 2, 4}, {-2, 2, 4})), lambert(Rgb(0.5F)), "wall");
        b.add(plate({0, 2, 0}, 1.5F), blend(lambert(Rgb(0)), before), "veil");
        b.add(quad({-2, -2, 3}, {2, -2, 3}, {2, 2, 3}, {-2, 2, 3}), blend(lambert(Rgb(0)), after), "veil");
        const auto scene = b.build();
        EmitSettings settings;
        settings.photons = 40000;
        settings.store = Store::Caustic;
        RunContext run(0, 1);
        const PhotonMap map = emitPhotons(*scene, settings, run);
        CHECK(map.header.ledger.balance() == FixedRgb());
        const PhotonTreeView photons = map.photons(PhotonClass::Caustic);
        double sum = 0;
        for (uint32_t i = 0; i < photons.count; ++i) {
            if (photons.position(i).z < 3.5F) continue;
            sum += unpackPower(photons.payload[i].power).y;
        }
        return sum / static_cast<double>(map.header.emittedPaths());
    };
    // The mirror meets 4 m2 of the sun.
    CHECK(caustic(0, 0) == doctest::Approx(4).epsilon(0.01));
    CHECK(caustic(0.25F, 0) == doctest::Approx(3).epsilon(0.02));
    CHECK(caustic(0.25F, 0.5F) == doctest::Approx(1.5).epsilon(0.03));
}
