#include "transport/direct_light.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "base/error.h"
#include "sampling/mis.h"
#include "support/chi_squared.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/walking.h"

using namespace lsde;
using test::SceneBuilder;

namespace {

constexpr float kAlbedo = 0.5F;
const Rgb kRadiance(3, 1, 2);

Vertex vertexBelow(const Scene& scene, Vec3 from, Vec3 direction = {0, -1, 0}) {
    PathState path = test::startAt(scene, from, direction);
    WalkScratch scratch;
    Vertex v;
    REQUIRE(advance(scene, path, v, scratch));
    return v;
}

// Irradiance from a polygon of uniform radiance that lies wholly above the horizon of n at p (Lambert 1760).
double polygonIrradiance(const std::vector<Vec3>& polygon, Vec3 p, Vec3 n, double radiance) {
    using Vec3d = glm::dvec3;
    double sum = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d a = glm::normalize(Vec3d(polygon[i]) - Vec3d(p));
        const Vec3d b = glm::normalize(Vec3d(polygon[(i + 1) % polygon.size()]) - Vec3d(p));
        const Vec3d c = glm::cross(a, b);
        sum += std::atan2(glm::length(c), glm::dot(a, b)) * glm::dot(glm::normalize(c), Vec3d(n));
    }
    return radiance * std::fabs(sum) / 2;
}

// Mean of the light sampled at a vertex, both lobes.
struct SampledLight {
    test::Mean radiance;
    int straightPassages = 0;
};

SampledLight sampleAt(const Scene& scene, const Vertex& v, int samples, DirectLightQuery query = {true, true, 0}) {
    const LightSampler lights(scene, test::allLights(scene));
    test::Random random(11);
    WalkScratch scratch;
    SampledLight out;
    for (int i = 0; i < samples; ++i) {
        const float uLight = random.uniform();
        const DirectLight d =
            sampleDirectLight(scene, lights.at(litPlace(v)), v, query, uLight, random.uniform2D(), scratch);
        out.radiance.add(d.diffuse.x + d.glossy.x);
        out.straightPassages = std::max(out.straightPassages, d.straightPassages);
    }
    return out;
}

// A lamp of half size 1 at height `height` that shines down on a floor, everything times `scale`.
SceneBuilder lampOverFloor(float height, float scale = 1, bool twoSided = false) {
    SceneBuilder builder;
    builder.add(test::plate({0, 0, 0}, 50), test::lambert(Rgb(kAlbedo)));
    builder.add(test::plate({0, height, 0}, 1, false), test::emitter(kRadiance, twoSided));
    builder.transform(scale, Vec3(0));
    return builder;
}

void checkLampOverFloor(float height, Vec3 onFloor, float scale) {
    CAPTURE(height);
    CAPTURE(onFloor.x);
    CAPTURE(scale);
    const auto scene = lampOverFloor(height, scale).build();
    const Vertex v = vertexBelow(*scene, scale * (onFloor + Vec3(0, 0.5F * height, 0)));
    const double irradiance =
        polygonIrradiance(scene->description().meshes[1].positions, v.surface.position, {0, 1, 0}, kRadiance.x);
    const test::Mean sampled = sampleAt(*scene, v, 20'000).radiance;
    CHECK(sampled.agrees(irradiance * kAlbedo / kPi));
}

}  // namespace

TEST_CASE("light sampled from a rectangle has the irradiance of Lambert's polygon formula, near, far and grazing") {
    for (const float scale : {1e-2F, 1.0F, 1e3F}) {
        checkLampOverFloor(1, {0.3F, 0, 0.2F}, scale);
        checkLampOverFloor(1, {2, 0, 1}, scale);
        checkLampOverFloor(0.05F, {3, 0, 0.5F}, scale);
        checkLampOverFloor(0.02F, {30, 0, 0.5F}, scale);
        checkLampOverFloor(1e4F, {0, 0, 0}, scale);
    }
}

TEST_CASE("a low lamp far from the origin still lights the floor at grazing angles") {
    SceneBuilder builder = lampOverFloor(0.2F);
    const Vec3 move(300, -200, 250);
    builder.transform(1, move);
    const auto scene = builder.build();
    for (const float x : {1.5F, 5.0F, 20.0F}) {
        CAPTURE(x);
        const Vertex v = vertexBelow(*scene, move + Vec3(x, 0.1F, 0.3F));
        const double irradiance =
            polygonIrradiance(scene->description().meshes[1].positions, v.surface.position, {0, 1, 0}, kRadiance.x);
        CHECK(sampleAt(*scene, v, 20'000).radiance.agrees(irradiance * kAlbedo / kPi));
    }
}

TEST_CASE("a lamp a millimetre away fills the hemisphere") {
    const auto scene = lampOverFloor(1e-3F).build();
    PathState path{{{0.2F, 5e-4F, 0.3F}, {0, -1, 0}, kInfinity}, {}, Rgb(1)};
    WalkScratch scratch;
    Vertex v;
    REQUIRE(advance(*scene, path, v, scratch));
    // Sampled by area nearly all samples are far away: the BSDF must find the light, and MIS must say so.
    const LightSampler lights(*scene, test::allLights(*scene));
    test::Random random(12);
    test::Mean radiance;
    for (int i = 0; i < 20'000; ++i) {
        const float uLight = random.uniform();
        double sum =
            sampleDirectLight(*scene, lights.at(litPlace(v)), v, {}, uLight, random.uniform2D(), scratch).diffuse.x;
        BsdfSample sample;
        REQUIRE(sampleBsdf(v.bsdf, v.wo, 0, random.uniform2D(), sample));
        PathState next = path;
        next.throughput = Rgb(1);
        Vertex hit;
        if (scatter(v, sample, Quantity::Radiance, next) && advance(*scene, next, hit, scratch) &&
            scene->meshes()[hit.surface.mesh].light >= 0)
            sum += next.throughput.x * scene->emission(hit.surface, hit.woWorld).x *
                   powerHeuristic(sample.pdfW, directLightPdf(*scene, lights.at(litPlace(v)), v.surface.position,
                                                              hit.surface, -hit.woWorld, hit.distance));
        radiance.add(sum);
    }
    CHECK(radiance.agrees(kAlbedo * kRadiance.x, 5));
}

namespace {

// Irradiance on a plane that faces up, by the midpoint rule, far finer than the environment's texels.
double irradianceFromAbove(const InfiniteLight& light) {
    constexpr int kGrid = 1000;
    double sum = 0;
    for (int i = 0; i < kGrid; ++i)
        for (int k = 0; k < kGrid; ++k) {
            const double cosine = (i + 0.5) / kGrid, azimuth = 2 * std::numbers::pi * (k + 0.5) / kGrid;
            const double sine = std::sqrt(1 - cosine * cosine);
            sum += cosine * static_cast<double>(
                                light
                                    .radiance({static_cast<float>(sine * std::cos(azimuth)), static_cast<float>(cosine),
                                               static_cast<float>(sine * std::sin(azimuth))})
                                    .x);
        }
    return sum * 2 * std::numbers::pi / kGrid / kGrid;
}

}  // namespace

TEST_CASE("an environment lights a floor as quadrature says, by sampled light alone and by MIS with the BSDF") {
    for (const float roughness : {1.0F, 0.3F}) {
        SceneBuilder builder;
        Material floor = test::lambert(Rgb(kAlbedo));
        builder.add(test::plate({0, 0, 0}, 5), roughness < 1 ? test::metal(roughness) : floor);
        builder.environment(test::spottedSky(64), 0.4F);
        const auto scene = builder.build();
        const auto& light = std::get<InfiniteLight>(scene->lights()[0].shape);
        const Vertex v = vertexBelow(*scene, {0.3F, 1, 0.2F}, glm::normalize(Vec3(0.3F, -1, 0.1F)));
        const LightSampler lights(*scene, test::allLights(*scene));
        const test::Mean alone = sampleAt(*scene, v, 200'000).radiance;
        test::Random random(14);
        test::Mean byMis;
        WalkScratch scratch;
        for (int i = 0; i < 200'000; ++i) {
            const float uLight = random.uniform();
            const DirectLight d =
                sampleDirectLight(*scene, lights.at(litPlace(v)), v, {}, uLight, random.uniform2D(), scratch);
            double sum = d.diffuse.x + d.glossy.x;
            BsdfSample sample;
            const float uLobe = random.uniform();
            PathState next = test::startAt(*scene, {0, 1, 0}, {0, -1, 0});
            if (sampleBsdf(v.bsdf, v.wo, uLobe, random.uniform2D(), sample) &&
                scatter(v, sample, Quantity::Radiance, next))
                sum +=
                    next.throughput.x * light.radiance(next.ray.direction).x *
                    powerHeuristic(sample.pdfW, directLightPdf(*scene, lights.at(litPlace(v)), 0, next.ray.direction));
            byMis.add(sum);
        }
        CHECK(test::agree(alone, byMis));
        if (roughness == 1) CHECK(alone.agrees(irradianceFromAbove(light) * kAlbedo / kPi));
        CHECK(byMis.standardError() < alone.standardError());
    }
}

TEST_CASE("the sun's disc lights a floor as its solid angle and height say") {
    SceneBuilder builder;
    builder.add(test::plate({0, 0, 0}, 5), test::lambert(Rgb(kAlbedo)));
    builder.sunDisc({1, 1, 0}, 0.265F, kRadiance);
    const auto scene = builder.build();
    const test::Mean m = sampleAt(*scene, vertexBelow(*scene, {0.3F, 1, 0.2F}), 1000).radiance;
    const double solidAngle = 2 * std::numbers::pi * (1 - std::cos(0.265 * std::numbers::pi / 180));
    CHECK(m.value() == doctest::Approx(kRadiance.x * solidAngle * std::sqrt(0.5) * kAlbedo / kPi).epsilon(1e-4));
}

TEST_CASE("a lamp shines to its front, or to both sides if it is double-sided") {
    for (const bool twoSided : {false, true}) {
        SceneBuilder builder = lampOverFloor(1, 1, twoSided);
        builder.add(test::plate({0, 2, 0}, 5, false), test::lambert(Rgb(kAlbedo)));  // a ceiling, seen from below
        const auto scene = builder.build();
        const Vertex ceiling = vertexBelow(*scene, {0.3F, 1.5F, 0.2F}, {0, 1, 0});
        const double irradiance = polygonIrradiance(scene->description().meshes[1].positions, ceiling.surface.position,
                                                    {0, -1, 0}, kRadiance.x);
        CHECK(sampleAt(*scene, ceiling, 20'000).radiance.agrees(twoSided ? irradiance * kAlbedo / kPi : 0));
    }
}

TEST_CASE("point, spot and directional lights arrive as candela per square metre and as lux") {
    const Vec3 p(0.4F, 0, 0.3F);
    const auto lit = [&](auto addLight) {
        SceneBuilder builder;
        builder.add(test::plate({0, 0, 0}, 50), test::lambert(Rgb(kAlbedo)));
        addLight(builder);
        const auto scene = builder.build();
        const test::Mean m = sampleAt(*scene, vertexBelow(*scene, p + Vec3(0, 0.1F, 0)), 16).radiance;
        CHECK(m.standardError() <= 1e-6 * m.value());
        return m.value() / kAlbedo * kPi;  // irradiance
    };
    for (const float height : {1e-3F, 1.0F, 2.0F, 1e4F}) {
        const Vec3 from = p + height * Vec3(0.5F, 1, 0.2F);
        const double d2 = lengthSquared(from - p), cosine = height / std::sqrt(d2);
        CHECK(lit([&](SceneBuilder& b) { b.point(from, kRadiance); }) ==
              doctest::Approx(kRadiance.x * cosine / d2).epsilon(1e-4));
        // On the spot's axis, and half-way (in the cosine) down its ramp.
        CHECK(lit([&](SceneBuilder& b) { b.spot(from, p, kRadiance, 10, 40); }) ==
              doctest::Approx(kRadiance.x * cosine / d2).epsilon(1e-4));
    }
    const float inner = std::cos(10 * kPi / 180), outer = std::cos(40 * kPi / 180),
                off = std::acos(0.5F * (inner + outer));
    const Vec3 above = p + Vec3(0, 1, 0);
    CHECK(lit([&](SceneBuilder& b) {
              b.spot(above, above + Vec3(std::sin(off), -std::cos(off), 0), kRadiance, 10, 40);
          }) == doctest::Approx(kRadiance.x * 0.25).epsilon(1e-4));
    CHECK(lit([&](SceneBuilder& b) { b.spot(above, above + Vec3(1, -1, 0), kRadiance, 10, 40); }) == 0);
    CHECK(lit([&](SceneBuilder& b) { b.sun({0.75F, -1, 0}, kRadiance); }) == doctest::Approx(kRadiance.x * 0.8F));
    CHECK(lit([&](SceneBuilder& b) { b.sun({0.75F, 1, 0}, kRadiance); }) == 0);
}

TEST_CASE("a blocker that touches the lamp's edge hides what is behind it, and no more") {
    for (const float scale : {1e-2F, 1.0F, 1e3F}) {
        SceneBuilder builder = lampOverFloor(1);
        // Hangs down from the lamp's right edge.
        constexpr float kLow = 0.7F;
        builder.add(test::quad({1, 1, -9}, {1, 1, 9}, {1, kLow, 9}, {1, kLow, -9}), test::lambert(Rgb(0)));
        builder.transform(scale, Vec3(0));
        const auto scene = builder.build();
        // From (3, 0, 0) the edge at height .7 covers the lamp up to x = 3 - 2 / .7.
        const Vertex v = vertexBelow(*scene, scale * Vec3(3, 0.5F, 0));
        const float limit = 3 - 2 / kLow;
        std::vector<Vec3> visible = {{-1, 1, -1}, {limit, 1, -1}, {limit, 1, 1}, {-1, 1, 1}};
        for (Vec3& corner : visible) corner *= scale;
        const double irradiance = polygonIrradiance(visible, v.surface.position, {0, 1, 0}, kRadiance.x);
        CHECK(sampleAt(*scene, v, 50'000).radiance.agrees(irradiance * kAlbedo / kPi));
        // From the other side nothing is hidden, right up to the lamp's edge.
        const Vertex left = vertexBelow(*scene, scale * Vec3(-0.5F, 0.5F, 0.2F));
        const double whole =
            polygonIrradiance(scene->description().meshes[1].positions, left.surface.position, {0, 1, 0}, kRadiance.x);
        CHECK(sampleAt(*scene, left, 50'000).radiance.agrees(whole * kAlbedo / kPi));
    }
}

TEST_CASE("light through a pane is tinted and its passage counted") {
    SceneBuilder builder = lampOverFloor(1);
    builder.add(test::plate({0, 0.5F, 0}, 9), test::thinWall(Rgb(0.5F), 1));  // an index of 1 reflects nothing
    const auto scene = builder.build();
    const Vertex v = vertexBelow(*scene, {0.3F, 0.25F, 0.2F});
    const double irradiance =
        polygonIrradiance(scene->description().meshes[1].positions, v.surface.position, {0, 1, 0}, kRadiance.x);
    const SampledLight sampled = sampleAt(*scene, v, 20'000);
    CHECK(sampled.straightPassages == 1);
    CHECK(sampled.radiance.agrees(0.5 * irradiance * kAlbedo / kPi));
}

TEST_CASE("sampled lights and sampled directions, weighted, add up to sampled lights alone") {
    for (const float roughness : {0.3F, 0.6F})
        for (const bool metallic : {true, false}) {
            CAPTURE(roughness);
            CAPTURE(metallic);
            SceneBuilder builder;
            Material floor = test::metal(roughness, Rgb(0.9F, 0.7F, 0.4F));
            floor.metallic = metallic ? 1 : 0;
            builder.add(test::plate({0, 0, 0}, 50), floor);
            builder.add(test::plate({0, 1, 0}, 0.6F, false), test::emitter(kRadiance));
            builder.add(test::plate({1.5F, 0.7F, 0.2F}, 0.2F, false), test::emitter(Rgb(8)));
            builder.point({-1, 1, 0}, Rgb(0.5F));
            const auto scene = builder.build();
            const Vertex v = vertexBelow(*scene, {0.9F, 0.6F, 0.1F}, {-1, -1, 0.1F});
            const LightSampler lights(*scene, test::allLights(*scene));
            test::Random random(13);
            WalkScratch scratch;
            test::Mean alone, both;
            for (int i = 0; i < 200'000; ++i) {
                float uLight = random.uniform();
                const DirectLight a = sampleDirectLight(*scene, lights.at(litPlace(v)), v, {true, true, 0}, uLight,
                                                        random.uniform2D(), scratch);
                alone.add(a.diffuse.x + a.glossy.x);
                uLight = random.uniform();
                const DirectLight w =
                    sampleDirectLight(*scene, lights.at(litPlace(v)), v, {}, uLight, random.uniform2D(), scratch);
                double sum = w.diffuse.x + w.glossy.x;
                BsdfSample sample;
                PathState next{{}, v.before, Rgb(1)};
                const float uLobe = random.uniform();
                Vertex hit;
                if (sampleBsdf(v.bsdf, v.wo, uLobe, random.uniform2D(), sample) &&
                    scatter(v, sample, Quantity::Radiance, next) && advance(*scene, next, hit, scratch) &&
                    scene->meshes()[hit.surface.mesh].light >= 0)
                    sum +=
                        next.throughput.x * scene->emission(hit.surface, hit.woWorld).x *
                        powerHeuristic(sample.pdfW, directLightPdf(*scene, lights.at(litPlace(v)), v.surface.position,
                                                                   hit.surface, -hit.woWorld, hit.distance));
                both.add(sum);
            }
            CHECK(test::agree(alone, both));
        }
}

TEST_CASE("the density told for a point of a lamp is the one it is sampled with") {
    SceneBuilder builder;
    builder.add(test::plate({0, 0, 0}, 50), test::lambert(Rgb(kAlbedo)));
    // A fan of triangles of different sizes that fills the square.
    builder.add(test::polygonFan({{-1, 1, -1}, {-0.4F, 1, -1}, {1, 1, -1}, {1, 1, 0.5F}, {1, 1, 1}, {-1, 1, 1}}),
                test::emitter(kRadiance));
    builder.add(test::plate({5, 3, 0}, 1, false), test::emitter(Rgb(2)));
    builder.point({0, 3, 0}, Rgb(1));
    const auto scene = builder.build();
    const Vertex v = vertexBelow(*scene, {0.7F, 0.5F, 0.2F});
    const LightSampler lights(*scene, test::allLights(*scene));
    const Vec3 p = v.surface.position;
    const auto pdfOf = [&](Vec3 onLamp, Hit& hit) {
        const Ray ray{p + Vec3(0, 1e-4F, 0), glm::normalize(onLamp - p), kInfinity};
        return scene->accel().intersect(ray, hit) && hit.mesh == 1
                   ? directLightPdf(*scene, lights.at(litPlace(v)), v.surface.position, scene->surface(hit),
                                    ray.direction, glm::length(onLamp - p))
                   : 0.0F;
    };
    test::Random random(14);
    const auto result = test::chiSquaredOnSquare(
        {16, 16, 16, 100'000},
        [&]() -> std::optional<Vec2> {
            float uLight = random.uniform();
            const size_t light = lights.at(litPlace(v)).choose(uLight);
            LightSample s;
            if (light != 0 || !scene->lights()[light].sampleToward(p, random.uniform2D(), s)) return std::nullopt;
            const Vec3 q = p + s.distance * s.wi;
            Hit hit;
            const float pdf = pdfOf(q, hit);
            // On an edge the ray may meet the neighbour.
            if (pdf > 0 && std::min({hit.u, hit.v, 1 - hit.u - hit.v}) > 1e-4F)
                CHECK(pdf == doctest::Approx(s.pdfW * lights.at(litPlace(v)).probability(light)).epsilon(1e-3));
            return 0.5F * Vec2(q.x + 1, q.z + 1);
        },
        [&](double x, double y) -> double {
            const Vec3 q(static_cast<float>(2 * x - 1), 1, static_cast<float>(2 * y - 1));
            Hit hit;
            const double d2 = lengthSquared(q - p), cosine = 1 / std::sqrt(d2);
            return pdfOf(q, hit) * cosine / d2 * 4;  // per area, then per unit of the square
        });
    CHECK(result.accepted(1));
}
