// Alpha as coverage: how much a surface covers, and which rays it lets pass.
#include "scene/coverage.h"

#include <doctest/doctest.h>

#include "support/random.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

Material covering(AlphaMode mode, float alpha, Material material = lambert(Rgb(0.5F))) {
    material.alphaMode = mode;
    material.alpha = alpha;
    return material;
}

// A square from (0,0,0) to (1,1,0) whose texture has alpha 51 (0.2) on the left and 255 on the right.
struct HalfCovered {
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    std::vector<Texture> textures{1};

    HalfCovered() {
        mesh.texCoords[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        textures[0].width = 2;
        textures[0].height = 1;
        textures[0].nearest = true;
        textures[0].rgba = {255, 255, 255, 51, 255, 255, 255, 255};
    }
    // At points of the first triangle, x = u + v: left and right of the square's middle.
    float left(const Material& m) const { return coverage(mesh, m, textures, 0, 0.2F, 0.1F); }
    float right(const Material& m) const { return coverage(mesh, m, textures, 0, 0.8F, 0.1F); }
};

}  // namespace

TEST_CASE("coverage is the alpha of factor, texture and vertices; of MASK all or nothing; of OPAQUE all") {
    HalfCovered square;
    Material m = covering(AlphaMode::Blend, 0.5F);
    CHECK(square.left(m) == 0.5F);
    m.baseColorTexture.texture = 0;
    CHECK(square.left(m) == doctest::Approx(0.1));
    CHECK(square.right(m) == 0.5F);
    square.mesh.colors.assign(4, Vec4(1, 1, 1, 0.25F));
    CHECK(square.right(m) == 0.125F);
    m.alphaMode = AlphaMode::Mask;
    m.alphaCutoff = 0.125F;
    CHECK(square.right(m) == 1);  // from the cutoff on
    CHECK(square.left(m) == 0);
    m.alphaCutoff = 1.5F;
    CHECK(square.right(m) == 0);
    m.alphaMode = AlphaMode::Opaque;
    CHECK(square.left(m) == 1);
}

TEST_CASE("what is marked BLEND or MASK and is opaque all over is told from what is not") {
    HalfCovered square;
    const auto partly = [&](const Material& m) { return coversPartly(square.mesh, m, square.textures); };
    CHECK(!partly(covering(AlphaMode::Opaque, 0.5F)));
    CHECK(!partly(covering(AlphaMode::Blend, 1)));
    CHECK(partly(covering(AlphaMode::Blend, 0.99F)));
    CHECK(!partly(covering(AlphaMode::Mask, 0.5F)));
    CHECK(partly(covering(AlphaMode::Mask, 0.49F)));
    Material textured = covering(AlphaMode::Blend, 1);
    textured.baseColorTexture.texture = 0;
    CHECK(partly(textured));
    square.textures[0].rgba[3] = 255;
    CHECK(!partly(textured));
    square.mesh.colors.assign(4, Vec4(1, 1, 1, 0.9F));
    CHECK(partly(textured));
}

TEST_CASE("of many rays as many meet a surface as it covers, each always the same, and what is behind meets the rest") {
    for (const float behind : {0.0F, -0.5F}) {  // in the same plane, and below
        CAPTURE(behind);
        SceneBuilder b;
        b.add(plate({0, 0, 0}, 1), covering(AlphaMode::Blend, 0.3F));
        b.add(plate({0, behind, 0}, 1), lambert(Rgb(0.5F)));
        const auto scene = b.build();
        Random random(3);
        constexpr int kRays = 20000;
        int met = 0;
        std::vector<Hit> all;
        for (int i = 0; i < kRays; ++i) {
            const Ray ray{{random.uniform() - 0.5F, 1, random.uniform() - 0.5F}, {0, -1, 0}, kInfinity};
            Hit hit, again;
            REQUIRE(scene->accel().intersect(ray, hit));
            REQUIRE(scene->accel().intersect(ray, again));
            CHECK(again.mesh == hit.mesh);
            scene->accel().allHits(ray, all);
            const bool there = scene->accel().isThere(ray, all.front());
            // Of two in one plane either may come first where both are there.
            if (behind < 0) CHECK((hit.mesh == 0) == there);
            if (!there) CHECK(hit.mesh == 1);
            CHECK(scene->accel().occluded({ray.origin, ray.direction, 1.25F}) == (there || behind == 0));
            met += there ? 1 : 0;
        }
        CHECK(std::fabs(met - 0.3 * kRays) < 4 * std::sqrt(0.21 * kRays));
    }
}

TEST_CASE("a segment's expected transmittance is the product of what its surfaces leave open") {
    SceneBuilder b;
    b.add(plate({0, 0.5F, 0}, 1), covering(AlphaMode::Blend, 0.25F));
    b.add(plate({0, 0, 0}, 1), covering(AlphaMode::Blend, 0.4F));
    b.add(plate({0, -0.5F, 0}, 1), covering(AlphaMode::Mask, 0.2F));  // nothing of it is there
    b.add(plate({0, -1, 0}, 1), lambert(Rgb(0.5F)));
    const auto scene = b.build();
    std::vector<Hit> hits;
    const auto left = [&](float length) {
        return scene->accel().transmittance({{0.1F, 1, 0.2F}, {0, -1, 0}, length}, hits);
    };
    CHECK(left(0.4F) == 1);
    CHECK(left(0.6F) == 0.75F);
    CHECK(left(1.9F) == doctest::Approx(0.45));
    CHECK(left(2.1F) == 0);
    scene->accel().allHits({{0.1F, 1, 0.2F}, {0, -1, 0}, kInfinity}, hits);
    CHECK(hits.size() == 4);
}

TEST_CASE("a lamp shines only where it is there") {
    HalfCovered square;
    Material lamp = covering(AlphaMode::Blend, 1, emitter(Rgb(2)));
    lamp.baseColorTexture.texture = 0;
    const AreaLight light(square.mesh, lamp, square.textures);
    CHECK(light.power.x == doctest::Approx(0.6 * 2 * kPi).epsilon(0.02));
    CHECK(light.radiance(0, 0.2F, 0.1F) == Rgb(2));
    CHECK(light.emitted(0, 0.2F, 0.1F).x == doctest::Approx(0.4));
    Random random(4);
    Rgb sum(0);
    constexpr int kSamples = 4096;
    for (int i = 0; i < kSamples; ++i) {
        const EmissionPoint e = light.samplePoint(random.uniform2D(), random.uniform());
        sum += e.radiance * (kPi / e.pdfA / kSamples);
    }
    CHECK(sum.x == doctest::Approx(0.6 * 2 * kPi).epsilon(0.02));
}
