// Lights: their power, what they send towards a point, and the density of the points that they are sampled by.
#include <doctest/doctest.h>

#include "base/error.h"
#include "support/chi_squared.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/statistics.h"

using namespace lsde;
using namespace lsde::test;

namespace {

bool near(Rgb a, Rgb b, float tolerance = 1e-5F) {
    return maxComponent(glm::abs(a - b)) <= tolerance * maxComponent(glm::abs(b));
}

// A lamp of 1 x 1 m in z = 0, front +z, with a texture of two texels across x: dark red, bright green.
struct TexturedLamp {
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    Material material = emitter(Rgb(2));
    std::vector<Texture> textures{1};

    TexturedLamp() {
        mesh.texCoords[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        textures[0].width = 2;
        textures[0].height = 1;
        textures[0].rgba = {255, 0, 0, 255, 0, 255, 0, 255};
        textures[0].nearest = true;
        material.emissiveTexture.texture = 0;
    }
    AreaLight light() const { return {mesh, material, textures}; }
};

PointLight spotLight(float innerDeg, float outerDeg) {
    SceneBuilder b;
    b.add(plate({0, -1, 0}, 1), lambert(Rgb(1)));
    b.spot({0, 0, 0}, {0, -1, 0}, Rgb(3), innerDeg, outerDeg);
    return std::get<PointLight>(b.build()->lights()[0].shape);
}

}  // namespace

TEST_CASE("an area light's power is pi times radiance and area, twice that if it is double-sided") {
    const std::vector<Texture> none;
    const Mesh mesh = sphere({3, 0, 0}, 0.5F, 5);
    double area = 0;
    for (const Triangle& t : mesh.triangles)
        area += 0.5 * glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                             mesh.positions[t[2]] - mesh.positions[t[0]]));
    const Material one = emitter(Rgb(2, 1, 0)), two = emitter(Rgb(2, 1, 0), true);
    const Rgb expected = Rgb(2, 1, 0) * (kPi * static_cast<float>(area));
    CHECK(near(AreaLight(mesh, one, none).power, expected));
    CHECK(near(AreaLight(mesh, two, none).power, 2.0F * expected));
}

TEST_CASE("a textured light's power and samples follow its texture") {
    const TexturedLamp lamp;
    const AreaLight light = lamp.light();
    CHECK(near(light.power, kPi * Rgb(1, 1, 0), 0.05F));  // by a fixed grid of points
    Random random(1);
    Mean red, green;
    for (int i = 0; i < 20000; ++i) {
        const EmissionPoint e = light.samplePoint(random.uniform2D(), random.uniform());
        CHECK(e.radiance == (e.position.x < 0.5F ? Rgb(2, 0, 0) : Rgb(0, 2, 0)));
        red.add(kPi * e.radiance.x / e.pdfA);
        green.add(kPi * e.radiance.y / e.pdfA);
    }
    CHECK(red.agrees(kPi));
    CHECK(green.agrees(kPi));
}

TEST_CASE("points on a light have the density that they claim, from samplePoint and from sampleToward") {
    // Two triangles of unequal size and no right angle, in z = 0.
    Mesh mesh = polygonFan({{0, 0, 0}, {1, 0.1F, 0}, {0.9F, 0.8F, 0}, {0.1F, 0.5F, 0}});
    const Material material = emitter(Rgb(1));
    const std::vector<Texture> none;
    const AreaLight light(mesh, material, none);
    const auto inside = [&](double x, double y) -> int {
        for (int t = 0; t < 2; ++t) {
            bool in = true;
            for (size_t i = 0; i < 3; ++i) {
                const Vec3 a = mesh.positions[mesh.triangles[static_cast<size_t>(t)][i]];
                const Vec3 b = mesh.positions[mesh.triangles[static_cast<size_t>(t)][(i + 1) % 3]];
                in &= (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) >= 0;
            }
            if (in) return t;
        }
        return -1;
    };
    const auto density = [&](double x, double y) {
        const int t = inside(x, y);
        return t < 0 ? 0.0 : static_cast<double>(light.pdfA(static_cast<uint32_t>(t)));
    };
    SquareGrid grid;
    grid.width = grid.height = 12;
    grid.quadrature = 60;  // the edges cut cells anywhere
    Random random(2);
    CHECK(chiSquaredOnSquare(
              grid, [&] { return std::optional(Vec2(light.samplePoint(random.uniform2D(), 0.7F).position)); }, density)
              .accepted(3));
    // From near by solid angle, from far away by area.
    for (const Vec3 p : {Vec3(0.2F, 0.3F, 0.7F), Vec3(3, -20, 100)}) {
        const auto towards = [&] {
            const LightSample s = light.sampleToward(p, random.uniform2D());
            return std::optional(Vec2(p + s.distance * s.wi));
        };
        const auto seen = [&](double x, double y) {
            const int t = inside(x, y);
            const Vec3 d = Vec3(x, y, 0) - p, wi = glm::normalize(d);
            const float perArea = std::fabs(wi.z) / glm::dot(d, d);
            return t < 0 ? 0.0 : light.pdfToward(p, static_cast<uint32_t>(t), wi, glm::length(d)) * perArea;
        };
        CHECK(chiSquaredOnSquare(grid, towards, seen).accepted(3));
    }
}

TEST_CASE("the mean of one over the density is the solid angle of the light, and nothing is sampled behind it") {
    const std::vector<Texture> none;
    const Material material = emitter(Rgb(1));
    const Mesh ball = sphere({0, 0, 0}, 1, 5);
    const AreaLight light(ball, material, none);
    Random random(3);
    const Vec3 p(0, 2, 0);
    Mean solidAngle;
    for (int i = 0; i < 100000; ++i) {
        const LightSample s = light.sampleToward(p, random.uniform2D());
        // The far half faces away.
        solidAngle.add(s.pdfW > 0 ? 1 / s.pdfW : 0);
        if (s.pdfW > 0) CHECK((p + s.distance * s.wi).y > 0.45F);
    }
    // Of a sphere seen from two radii; the mesh's outline lies a little within it.
    const double expected = 2 * std::numbers::pi * (1 - std::sqrt(0.75));
    CHECK(std::fabs(solidAngle.value() - expected) < 4 * solidAngle.standardError() + 2e-3 * expected);
}

TEST_CASE("a double-sided light starts paths on either side alike, a one-sided one on its front") {
    const std::vector<Texture> none;
    const Mesh mesh = plate({0, 1, 0}, 0.5F);
    const Material one = emitter(Rgb(1)), two = emitter(Rgb(1), true);
    const AreaLight oneSided(mesh, one, none), twoSided(mesh, two, none);
    CHECK(oneSided.samplePoint({0.3F, 0.3F}, 0.1F).normal == Vec3(0, 1, 0));
    CHECK(twoSided.samplePoint({0.3F, 0.3F}, 0.1F).normal == Vec3(0, -1, 0));
    CHECK(twoSided.samplePoint({0.3F, 0.3F}, 0.9F).normal == Vec3(0, 1, 0));
    CHECK(twoSided.samplePoint({0.3F, 0.3F}, 0.9F).pdfA == doctest::Approx(0.5));
    CHECK(oneSided.samplePoint({0.3F, 0.3F}, 0.9F).pdfA == doctest::Approx(1));
    LightSample s;
    const Light below{"lamp", oneSided};
    CHECK(!below.sampleToward({0, 0, 0}, {0.5F, 0.5F}, s));
    CHECK(below.sampleToward({0, 2, 0}, {0.5F, 0.5F}, s));
}

TEST_CASE("point and spot lights send candela over distance squared, and their power is its integral") {
    PointLight point{{1, 2, 3}, Rgb(4)};
    CHECK(near(point.power(), Rgb(16 * kPi)));
    const LightSample s = point.sampleToward({1, 2, 0});
    CHECK(near(s.radiance, Rgb(4.0F / 9)));
    CHECK(s.distance == 3);
    CHECK(s.wi == Vec3(0, 0, 1));
    for (const auto& [inner, outer] : {std::pair(0.0F, 90.0F), {20.0F, 50.0F}, {17.999F, 18.0F}, {0.05F, 0.1F}}) {
        CAPTURE(inner);
        CAPTURE(outer);
        const PointLight spot = spotLight(inner, outer);
        // Of the specification's formula, in double precision.
        const double ci = std::cos(inner * std::numbers::pi / 180), co = std::cos(outer * std::numbers::pi / 180);
        constexpr int kSteps = 200000;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double c = co + (1 - co) * (i + 0.5) / kSteps;
            sum += square(std::clamp((c - co) / (ci - co), 0.0, 1.0)) * (1 - co) / kSteps;
        }
        CHECK(spot.power().x == doctest::Approx(3 * 2 * std::numbers::pi * sum).epsilon(2e-3));
        const auto along = [&](float deg) {
            return spot.falloff({std::sin(deg * kPi / 180), -std::cos(deg * kPi / 180), 0});
        };
        CHECK(along(0) == 1);
        CHECK(along(0.98F * inner) == 1);
        CHECK(along(1.02F * outer) == 0);
        const float middle = 0.5F * (inner + outer);
        if (outer - inner > 0.01F)
            CHECK(along(middle) ==
                  doctest::Approx(square((std::cos(middle * std::numbers::pi / 180) - co) / (ci - co))).epsilon(0.02));
    }
}

TEST_CASE("a directional light brings its lux from any distance, and its power is what crosses the scene's disc") {
    SceneBuilder b;
    b.add(sphere({0, 0, 0}, 2, 3), lambert(Rgb(1)));
    b.sun({0, -1, 0}, Rgb(5));
    const auto scene = b.build();
    LightSample s;
    REQUIRE(scene->lights()[0].sampleToward({0, 100, 0}, {0, 0}, s));
    CHECK(s.radiance == Rgb(5));
    CHECK(s.wi == Vec3(0, 1, 0));
    CHECK(std::isinf(s.distance));
    CHECK(near(scene->lights()[0].power(), Rgb(5 * kPi * 4)));
}

TEST_CASE("lights are chosen by name, several may share one, and an unknown name tells those there are") {
    SceneBuilder b;
    b.add(plate({0, 1, 0}, 1), emitter(Rgb(1)), "lamp");
    b.add(plate({0, 2, 0}, 1), emitter(Rgb(1)), "lamp");
    b.point({0, 3, 0}, Rgb(1));
    b.point({0, 3, 0}, Rgb(0));  // emits nothing: no light
    const auto scene = b.build();
    REQUIRE(scene->lights().size() == 3);
    CHECK(scene->lightSelection({}) == std::vector<bool>{true, true, true});
    CHECK(scene->lightSelection({"lamp"}) == std::vector<bool>{true, true, false});
    CHECK(scene->lightSelection({"point"}) == std::vector<bool>{false, false, true});
    CHECK_THROWS_WITH_AS(scene->lightSelection({"sun"}),
                         ": light \"sun\": does not exist, expected one of: lamp, lamp, point", Error);
}
