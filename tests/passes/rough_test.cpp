// Rough glass and rough metal, across the roughness at which vertices change their class: photons against methods that
// share none of their estimates.
#include <doctest/doctest.h>

#include <vector>

#include "passes/pictures.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

Material rough(Material m, float roughness) {
    m.roughness = roughness;
    return m;
}

// A ball over a floor under a lamp.
std::unique_ptr<Scene> ballScene(const Material& material) {
    SceneBuilder b;
    b.add(plate({0, 0, 0}, 3), lambert(Rgb(0.7F)), "floor");
    b.add(sphere({0, 0.8F, 0}, 0.5F, 4), material, "ball");
    b.add(plate({0.5F, 3, 0}, 0.3F, false), emitter(Rgb(50)), "lamp");
    b.camera({0, 2.5F, 4}, {0, 0.4F, 0}, 35);
    return b.build();
}

// A plate that throws light onto the floor beside it.
std::unique_ptr<Scene> plateScene(const Material& material) {
    SceneBuilder b;
    b.add(plate({0, 0, 0}, 2), lambert(Rgb(0.7F)), "floor");
    b.add(quad({-0.8F, 0, 1.2F}, {-0.8F, 0, -1}, {-0.8F, 1.6F, -1}, {-0.8F, 1.6F, 1.2F}), material, "plate");
    b.add(quad({1, 1.15F, -0.15F}, {1, 1.15F, 0.15F}, {1, 0.85F, 0.15F}, {1, 0.85F, -0.15F}), emitter(Rgb(60)), "lamp");
    b.camera({1.6F, 1.3F, 2.2F}, {-0.4F, 0.45F, 0.2F}, 45);
    return b.build();
}

// Blocks that are a hundred times darker than the picture are left out: paths rarely find what little light they have,
// and four seeds do not tell how rarely.
Estimate bright(const Estimate& e, const Estimate& by) {
    double mean = 0;
    for (const double m : by.mean) mean += m / static_cast<double>(by.mean.size());
    Estimate out;
    for (size_t i = 0; i < e.mean.size(); ++i)
        if (by.mean[i] > 0.01 * mean) {
            out.mean.push_back(e.mean[i]);
            out.error.push_back(e.error[i]);
        }
    return out;
}

void checkPhotonsAgainstPaths(const Scene& scene) {
    const Estimate photons = estimate(scene, settingsFor("photon", 32, 32, 100000), 4, 4);
    const Estimate paths = estimate(scene, settingsFor("path", 32, 384), 4, 4);
    checkAgreement(bright(photons, paths), bright(paths, paths), 0.02);
}

}  // namespace

TEST_CASE("a ball of rough glass: photons agree with path tracing on both sides of the split") {
    for (const float roughness : {0.1F, 0.24F, 0.26F, 0.5F}) {
        CAPTURE(roughness);
        checkPhotonsAgainstPaths(*ballScene(rough(glass(1.5F), roughness)));
    }
}

TEST_CASE("a rough metal plate: photons agree with path tracing on both sides of the split") {
    for (const float roughness : {0.24F, 0.26F}) {
        CAPTURE(roughness);
        checkPhotonsAgainstPaths(*plateScene(metal(roughness)));
    }
}

TEST_CASE("a ball of milky glass, smooth and rough, and one of rough thin walls: photons agree with path tracing") {
    Material milky = glass(1.5F, {Rgb(0.5F, 0.8F, 0.9F), 0.5F});
    milky.transmission = 0.6F;
    milky.baseColor = Rgb(0.9F, 0.7F, 0.5F);
    for (const Material& m : {milky, rough(milky, 0.2F), rough(milky, 0.4F), rough(thinWall(Rgb(0.9F)), 0.15F),
                              rough(thinWall(Rgb(0.9F)), 0.4F)}) {
        CAPTURE(m.roughness);
        CAPTURE(m.isSolid());
        checkPhotonsAgainstPaths(*ballScene(m));
    }
}

TEST_CASE("varnish, cloth, brushed metal and films: photons agree with path tracing") {
    Material paint = metal(0.4F, Rgb(0.8F, 0.3F, 0.2F));
    paint.metallic = 0.5F;
    Material cloth = lambert(Rgb(0.4F));
    cloth.sheen = SheenProperties{Rgb(0.8F), 0.4F};
    Material brushed = metal(0.15F);
    brushed.anisotropy = AnisotropyProperties{0.6F, 0.4F};
    Material film = metal(0.1F, Rgb(0.7F));
    film.iridescence = IridescenceProperties{1};
    std::vector<Material> all = {cloth, brushed, film};
    for (const float roughness : {0.0F, 0.15F, 0.4F}) {
        paint.clearcoat = ClearcoatProperties{1, roughness};
        all.push_back(paint);
    }
    for (const Material& m : all) {
        CAPTURE(m.roughness);
        CAPTURE(m.clearcoat.has_value());
        checkPhotonsAgainstPaths(*plateScene(m));
    }
}

TEST_CASE("a caustic on a floor with a normal texture, and a furnace of such walls: photons agree with path tracing") {
    Texture bumps;
    bumps.width = bumps.height = 16;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const Vec3 n = glm::normalize(Vec3(0.5F * std::sin(0.785F * static_cast<float>(x)),
                                               0.5F * std::sin(0.393F * static_cast<float>(y)), 1));
            for (const float c : {n.x, n.y, n.z}) bumps.rgba.push_back(static_cast<uint8_t>(127.5F * c + 128));
            bumps.rgba.push_back(255);
        }
    for (const bool furnace : {false, true}) {
        CAPTURE(furnace);
        SceneBuilder b;
        Material wall = lambert(Rgb(0.7F));
        wall.normalTexture = b.texture(bumps);
        if (furnace) wall.emission = Rgb(0.3F);
        const std::vector<Vec2> corners = {{0, 3}, {3, 3}, {3, 0}, {0, 0}};
        b.add(plate({0, 0, 0}, 2), wall, "floor").texCoords[0] = corners;
        if (furnace) b.add(plate({0, 2, 0}, 2, false), wall, "ceiling").texCoords[0] = corners;
        b.add(sphere({0, 0.8F, 0}, 0.5F, 4), glass(1.5F), "ball");
        b.add(plate({0.3F, 1.95F, 0}, 0.2F, false), emitter(Rgb(60)), "lamp");
        b.camera({0, 1.7F, 3}, {0, 0.3F, 0}, 40);
        checkPhotonsAgainstPaths(*b.build());
    }
}

TEST_CASE("light by a mirror that comes through a rough pane to the eye is gathered behind it") {
    SceneBuilder b;
    b.add(quad({-1, 0, -2}, {1, 0, -2}, {1, 2, -2}, {-1, 2, -2}), metal(0), "mirror");
    b.add(quad({-1, 0, 0}, {1, 0, 0}, {1, 2, 0}, {-1, 2, 0}), rough(thinWall(Rgb(1)), 0.4F), "pane");
    b.add(quad({-0.3F, 2, -0.3F}, {0.3F, 2, -0.3F}, {0.3F, 2.4F, -0.5F}, {-0.3F, 2.4F, -0.5F}), emitter(Rgb(30), true),
          "lamp");
    b.camera({0, 1, 3}, {0, 1, 0}, 38);
    checkPhotonsAgainstPaths(*b.build());
}

TEST_CASE("under a point light, photons at rough glass and behind it agree with light tracing") {
    for (const float roughness : {0.15F, 0.4F}) {
        CAPTURE(roughness);
        SceneBuilder b;
        b.add(plate({0, 0, 0}, 3), lambert(Rgb(0.7F)), "floor");
        b.add(box({-0.6F, 0.6F, -0.6F}, {0.6F, 1, 0.6F}), rough(glass(1.5F), roughness), "block");
        b.add(quad({-1.2F, 0, 1}, {-1.2F, 0, -1}, {-1.2F, 2, -1}, {-1.2F, 2, 1}), metal(0), "mirror");
        b.point({0.6F, 2.2F, 0.2F}, Rgb(20));
        b.camera({0.8F, 2.5F, 3}, {0, 0.5F, 0}, 40);
        const auto scene = b.build();
        // What the camera sees in the mirror is not the light tracer's.
        PictureSettings photon = settingsFor("photon", 32, 32, 100000), light = settingsFor("light", 32, 512);
        photon.paths = light.paths = {{"seen", "L.*DE"}};
        checkAgreement(estimate(*scene, photon, 4, 4, "seen"), estimate(*scene, light, 4, 4, "seen"), 0.02);
    }
}
