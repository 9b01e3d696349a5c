// The scene as passes ask it: rays, surfaces, materials at a hit, casters, and the hash.
#include <doctest/doctest.h>

#include "base/error.h"
#include "path/event.h"
#include "scene/creases.h"
#include "support/random.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

// The nearest triangle by looking at all (Moeller & Trumbore 1997), in double precision.
struct BruteHit {
    double t = kInfinity;
    uint32_t mesh = 0, triangle = 0;
};
std::vector<BruteHit> bruteHits(const std::vector<Mesh>& meshes, const Ray& ray) {
    std::vector<BruteHit> hits;
    const glm::dvec3 o(ray.origin), d(ray.direction);
    for (uint32_t m = 0; m < meshes.size(); ++m)
        for (uint32_t i = 0; i < meshes[m].triangles.size(); ++i) {
            const Triangle& t = meshes[m].triangles[i];
            const glm::dvec3 a(meshes[m].positions[t[0]]), e1 = glm::dvec3(meshes[m].positions[t[1]]) - a,
                                                           e2 = glm::dvec3(meshes[m].positions[t[2]]) - a;
            const glm::dvec3 p = glm::cross(d, e2);
            const double det = glm::dot(e1, p);
            if (det == 0) continue;
            const double u = glm::dot(o - a, p) / det;
            const glm::dvec3 q = glm::cross(o - a, e1);
            const double v = glm::dot(d, q) / det, distance = glm::dot(e2, q) / det;
            if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0 && distance < ray.tMax) hits.push_back({distance, m, i});
        }
    std::sort(hits.begin(), hits.end(), [](const BruteHit& a, const BruteHit& b) { return a.t < b.t; });
    return hits;
}

Vec3 onSphere(Random& random) {
    const float z = 2 * random.uniform() - 1, r = safeSqrt(1 - z * z), phi = 2 * kPi * random.uniform();
    return {r * std::cos(phi), r * std::sin(phi), z};
}

SceneDescription someScene() {
    SceneBuilder b;
    b.add(sphere({0, 0, 0}, 1, 2), lambert(Rgb(0.5F)), "ball");
    b.add(box({-3, -3, -3}, {3, 3, 3}), lambert(Rgb(0.5F)), "room");
    b.add(plate({0, 1.5F, 0}, 0.7F), emitter(Rgb(2)), "lamp");
    b.point({0, 2, 0}, Rgb(1));
    return b.build()->description();
}

// A scene of one square from (0,0,0) to (1,1,0), hit from +z at (x, y).
Bsdf bsdfAt(const Material& material, const std::vector<Texture>& textures = {}, float x = 0.25F,
            float iorBehind = 1.5F) {
    SceneDescription d;
    Mesh m = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    m.texCoords[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    d.meshes = {m};
    d.materials = {material};
    d.textures = textures;
    const Scene scene(std::move(d));
    Hit hit;
    REQUIRE(scene.accel().intersect({{x, 0.4F, 1}, {0, 0, -1}, kInfinity}, hit));
    return scene.bsdf(scene.surface(hit), 1, iorBehind);
}

Texture twoTexels(std::initializer_list<uint8_t> rgba) {
    Texture t;
    t.width = 2;
    t.height = 1;
    t.rgba = rgba;
    t.nearest = true;
    return t;
}

}  // namespace

TEST_CASE("rays hit the nearest triangle, some triangle or all of them, as looking at each triangle finds") {
    const Scene scene(someScene());
    Random random(1);
    std::vector<Hit> all;
    for (int i = 0; i < 3000; ++i) {
        const Ray ray{4.0F * (Vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5F), onSphere(random),
                      i % 2 == 0 ? kInfinity : 3 * random.uniform()};
        const std::vector<BruteHit> expected = bruteHits(scene.description().meshes, ray);
        Hit hit;
        REQUIRE(scene.accel().intersect(ray, hit) == !expected.empty());
        CHECK(scene.accel().occluded(ray) == !expected.empty());
        scene.accel().allHits(ray, all);
        REQUIRE(all.size() == expected.size());
        if (expected.empty()) continue;
        CHECK(hit.t == doctest::Approx(expected[0].t).epsilon(1e-4));
        CHECK(hit.mesh == expected[0].mesh);
        CHECK(hit.triangle == expected[0].triangle);
        for (size_t k = 0; k < all.size(); ++k) CHECK(all[k].t == doctest::Approx(expected[k].t).epsilon(1e-4));
    }
}

TEST_CASE("all hits of a ray are found, however many, in order") {
    SceneBuilder b;
    for (int i = 200; i > 0; --i) b.add(plate({0, static_cast<float>(i), 0}, 1), lambert(Rgb(1)));
    const auto scene = b.build();
    std::vector<Hit> hits;
    scene->accel().allHits({{0.1F, 0, 0.2F}, {0, 1, 0}, kInfinity}, hits);
    REQUIRE(hits.size() == 200);
    for (size_t i = 0; i < 200; ++i) CHECK(hits[i].t == doctest::Approx(i + 1));
}

TEST_CASE("a hit's surface has the front's normal, the interpolated one, and the point on the triangle") {
    SceneBuilder b;
    Mesh m = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    const Vec3 bent = glm::normalize(Vec3(0.5F, 0, 1));
    m.normals = {{0, 0, 1}, bent, bent, {0, 0, 1}};
    b.add(m, lambert(Rgb(1)));
    const auto scene = b.build();
    for (const float z : {1.0F, -1.0F}) {
        Hit hit;
        REQUIRE(scene->accel().intersect({{0.75F, 0.5F, z}, {0, 0, -z}, kInfinity}, hit));
        const Surface s = scene->surface(hit);
        CHECK(glm::length(s.position - Vec3(0.75F, 0.5F, 0)) < 1e-6F);
        CHECK(s.ng == Vec3(0, 0, 1));
        CHECK(glm::length(s.ns - glm::normalize(0.25F * Vec3(0, 0, 1) + 0.75F * bent)) < 1e-5F);
        CHECK(s.epsilon > 0);
        CHECK(s.epsilon < 1e-4F);
    }
}

TEST_CASE("a vertex normal behind the face, or normals that cancel out, leave the face's own") {
    for (const Vec3 n : {Vec3(0, 0, -1), Vec3(1, 0, 0)}) {
        SceneBuilder b;
        Mesh m = polygonFan({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}});
        m.normals = {n, n == Vec3(1, 0, 0) ? -n : n, Vec3(0, 0, -0.001F)};
        b.add(m, lambert(Rgb(1)));
        const auto scene = b.build();
        Hit hit;
        REQUIRE(scene->accel().intersect({{0, -0.5F, 1}, {0, 0, -1}, kInfinity}, hit));
        CHECK(scene->surface(hit).ns == Vec3(0, 0, 1));
    }
}

TEST_CASE("a material becomes the Bsdf that its factors and textures make at the hit") {
    CHECK(std::get<DiffuseBsdf>(bsdfAt(lambert(Rgb(0.5F)))).albedo == Rgb(0.5F));
    CHECK(std::holds_alternative<BlackBsdf>(bsdfAt(lambert(Rgb(0)))));
    CHECK(std::get<MirrorBsdf>(bsdfAt(metal(0))).f0 == Rgb(1));
    CHECK(std::get<DielectricBsdf>(bsdfAt(glass(1.5F))).eta == 1.5F);
    CHECK(std::get<ThinDielectricBsdf>(bsdfAt(thinWall(Rgb(0.5F), 1.7F))).ior == 1.7F);

    Material plastic;
    plastic.metallic = 0;
    plastic.roughness = 0.5F;
    plastic.ior = 2;
    plastic.specular = 0.25F;
    plastic.specularColor = Rgb(1, 20, 0);
    const auto b = std::get<MetalRoughBsdf>(bsdfAt(plastic));
    CHECK(b.specular == 0.25F);
    CHECK(b.dielectricF0.x == doctest::Approx(1.0 / 9));
    CHECK(b.dielectricF0.y == 1);  // at most
    CHECK(b.dielectricF0.z == 0);
    plastic.ior = 0;
    CHECK(std::get<MetalRoughBsdf>(bsdfAt(plastic)).dielectricF0.x == 1);
}

TEST_CASE("glass that is not clear and smooth keeps its roughness, its diffuse base and its reflectance") {
    Material m = glass(1.5F);
    m.roughness = 0.4F;
    m.baseColor = Rgb(0.9F);
    const auto rough = std::get<TransmissiveBsdf>(bsdfAt(m));
    CHECK(rough.eta == 1.5F);
    CHECK(rough.roughness == 0.4F);
    CHECK(rough.baseColor == Rgb(0.9F));
    CHECK(rough.transmission == 1);
    CHECK_FALSE(rough.thin);
    m.volume.reset();
    m.ior = 1.7F;
    m.transmission = 0.5F;
    m.transmissionTexture.texture = 0;
    m.specular = 0.25F;
    m.specularColor = Rgb(2, 1, 0);
    const auto pane = std::get<TransmissiveBsdf>(bsdfAt(m, {twoTexels({102, 9, 9, 9, 0, 0, 0, 0})}));
    CHECK(pane.thin);
    CHECK(pane.eta == 1.7F);
    CHECK(pane.transmission == doctest::Approx(0.5 * 0.4));
    CHECK(pane.specular == 0.25F);
    CHECK(pane.specularColor == Rgb(2, 1, 0));
    // Where textures leave it clear and smooth it is a smooth interface; so is one between media of one index, rough or
    // not.
    Material textured = glass(1.5F);
    textured.roughness = 1;
    textured.metallicRoughnessTexture.texture = 0;
    const std::vector<Texture> textures = {twoTexels({0, 0, 0, 0, 0, 128, 0, 0})};
    CHECK(std::holds_alternative<DielectricBsdf>(bsdfAt(textured, textures, 0.25F)));
    CHECK(std::get<TransmissiveBsdf>(bsdfAt(textured, textures, 0.75F)).roughness == doctest::Approx(128.0 / 255));
    Material none = glass(1);
    none.roughness = 0.5F;
    CHECK(std::get<DielectricBsdf>(bsdfAt(none, {}, 0.25F, 1)).eta == 1);
}

TEST_CASE("layers become what their factors and textures say, and none is made where they are empty") {
    Material m = metal(0.4F);
    m.anisotropy = AnisotropyProperties{0.8F, 0.5F};
    const auto brushed = std::get<MetalRoughBsdf>(bsdfAt(m));
    CHECK(brushed.anisotropy == 0.8F);
    // u runs along x, v along y: the bitangent, up in a picture, along -y. The frame about +z has x as its first axis.
    CHECK(brushed.direction.x == doctest::Approx(std::cos(0.5)));
    CHECK(brushed.direction.y == doctest::Approx(-std::sin(0.5)));
    m.anisotropy->texture.texture = 0;
    // Green alone: along the bitangent, turned on by the rotation; a strength of 0.4.
    const auto textured = std::get<MetalRoughBsdf>(bsdfAt(m, {twoTexels({128, 255, 102, 0, 0, 0, 0, 0})}));
    CHECK(textured.anisotropy == doctest::Approx(0.8 * 0.4));
    CHECK(textured.direction.x == doctest::Approx(-std::sin(0.5)).epsilon(0.02));
    CHECK(textured.direction.y == doctest::Approx(-std::cos(0.5)).epsilon(0.02));

    Material film = metal(0);
    film.iridescence = IridescenceProperties{0.5F, 1.4F, 1e-7F, 5e-7F};
    CHECK(std::get<MetalRoughBsdf>(bsdfAt(film)).film.thickness == 5e-7F);
    film.iridescence->texture.texture = film.iridescence->thicknessTexture.texture = 0;
    const auto soap = std::get<MetalRoughBsdf>(bsdfAt(film, {twoTexels({102, 51, 0, 0, 0, 0, 0, 0})})).film;
    CHECK(soap.factor == doctest::Approx(0.5 * 0.4));
    CHECK(soap.thickness == doctest::Approx(1e-7 + 0.2 * 4e-7));

    Material cloth = lambert(Rgb(0.5F));
    cloth.sheen = SheenProperties{Rgb(0.5F), 0.6F};
    cloth.clearcoat = ClearcoatProperties{0.9F, 0.2F};
    cloth.sheen->colorTexture.texture = cloth.sheen->roughnessTexture.texture = 0;
    cloth.clearcoat->texture.texture = cloth.clearcoat->roughnessTexture.texture = 0;
    const auto layered = std::get<LayeredBsdf>(bsdfAt(cloth, {twoTexels({255, 102, 0, 51, 0, 0, 0, 0})}));
    CHECK(layered.sheen.color.x == 0.5F);
    CHECK(layered.sheen.color.z == 0);
    CHECK(layered.sheen.roughness == doctest::Approx(0.6 * 0.2));
    CHECK(layered.coat.factor == 0.9F);
    CHECK(layered.coat.roughness == doctest::Approx(0.2 * 0.4));
    CHECK(layered.coat.normal == Vec3(0, 0, 1));
    // Where the textures leave nothing of them.
    CHECK(std::holds_alternative<MetalRoughBsdf>(bsdfAt(cloth, {twoTexels({255, 102, 0, 51, 0, 0, 0, 0})}, 0.75F)));
}

TEST_CASE("a coat lies on the mesh's own normals, or on those of its own texture, whatever bends the base's") {
    Material m = lambert(Rgb(0.5F));
    m.clearcoat = ClearcoatProperties{1, 0};
    m.normalTexture.texture = 0;
    const std::vector<Texture> textures = {twoTexels({204, 128, 230, 0, 204, 128, 230, 0}),
                                           twoTexels({128, 128, 255, 0, 204, 128, 230, 0})};
    const Vec3 coat = std::get<LayeredBsdf>(bsdfAt(m, textures)).coat.normal;
    CHECK(coat.z == doctest::Approx(0.8).epsilon(0.01));  // the face's, in the frame of the bent normal
    m.clearcoat->normalTexture.texture = 1;
    const auto same = std::get<LayeredBsdf>(bsdfAt(m, textures, 0.75F)).coat.normal;
    CHECK(same.z == doctest::Approx(1));
}

TEST_CASE("textures and vertex colours multiply the factors: colours by their sRGB curve, data as they are") {
    Material m;
    m.baseColor = Rgb(0.5F);
    m.metallic = 0.5F;
    m.roughness = 0.8F;
    m.baseColorTexture.texture = 0;
    m.metallicRoughnessTexture.texture = 1;
    m.specularTexture.texture = 2;
    const std::vector<Texture> textures = {twoTexels({255, 128, 0, 255, 0, 0, 0, 255}),
                                           twoTexels({9, 51, 102, 9, 0, 255, 255, 0}),
                                           twoTexels({9, 9, 9, 153, 0, 0, 0, 255})};
    const auto left = std::get<MetalRoughBsdf>(bsdfAt(m, textures, 0.25F));
    CHECK(left.baseColor.x == 0.5F);
    CHECK(left.baseColor.y == doctest::Approx(0.5 * 0.2158605));
    CHECK(left.roughness == doctest::Approx(0.8 * 0.2));
    CHECK(left.metallic == doctest::Approx(0.5 * 0.4));
    CHECK(left.specular == doctest::Approx(0.6));
    const auto right = std::get<MetalRoughBsdf>(bsdfAt(m, textures, 0.75F));
    CHECK(right.baseColor == Rgb(0));
    CHECK(right.roughness == doctest::Approx(0.8));

    SceneDescription d;
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    mesh.colors = {{0, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}, {0, 1, 1, 1}};
    d.meshes = {mesh};
    d.materials = {lambert(Rgb(0.5F))};
    const Scene scene(std::move(d));
    Hit hit;
    REQUIRE(scene.accel().intersect({{0.25F, 0.4F, 1}, {0, 0, -1}, kInfinity}, hit));
    CHECK(std::get<DiffuseBsdf>(scene.bsdf(scene.surface(hit), 1, 1)).albedo.x == doctest::Approx(0.125));
    CHECK(std::get<DiffuseBsdf>(scene.bsdf(scene.surface(hit), 1, 1)).albedo.y == 0.5F);
}

TEST_CASE("an emitter shines from its front, or from both sides if it is double-sided") {
    for (const bool twoSided : {false, true}) {
        SceneBuilder b;
        b.add(plate({0, 0, 0}, 1), emitter(Rgb(3), twoSided));
        const auto scene = b.build();
        Hit hit;
        REQUIRE(scene->accel().intersect({{0.1F, 1, 0.2F}, {0, -1, 0}, kInfinity}, hit));
        const Surface s = scene->surface(hit);
        CHECK(scene->emission(s, {0, 1, 0}) == Rgb(3));
        CHECK(scene->emission(s, {0, -1, 0}) == (twoSided ? Rgb(3) : Rgb(0)));
    }
}

TEST_CASE("casters are what bends light or is glossy, unless switched off") {
    const auto casters = [](const Material& material, CausticSwitches switches = {}) {
        SceneBuilder b;
        b.add(sphere({5, 0, 0}, 1, 2), material).switches = switches;
        const auto scene = b.build();
        CHECK(scene->meshes()[0].receiver == switches.receives);
        return std::pair(scene->meshes()[0].caster, scene->casters().size());
    };
    CHECK(casters(lambert(Rgb(1))) == std::pair(false, size_t{0}));
    CHECK(casters(glass(1.5F)) == std::pair(true, size_t{1}));
    CHECK(casters(thinWall(Rgb(1))) == std::pair(true, size_t{1}));
    CHECK(casters(metal(0)) == std::pair(true, size_t{1}));
    CHECK(casters(metal(0.2F)) == std::pair(true, size_t{1}));
    CHECK(casters(metal(0.3F)) == std::pair(false, size_t{0}));
    for (const float roughness : {0.2F, 0.3F}) {
        Material rough = glass(1.5F);
        rough.roughness = roughness;
        CHECK(casters(rough).first == (roughness < kGlossyRoughness));
    }
    CHECK(casters(glass(1.5F), {.casts = false}) == std::pair(false, size_t{0}));
    CHECK(casters(glass(1.5F), {.receives = false}) == std::pair(true, size_t{1}));
    CHECK(casters(glass(1.5F), {.aim = false}) == std::pair(true, size_t{0}));
}

TEST_CASE("many casters are grouped in at most 16 spheres that hold them all") {
    SceneBuilder b;
    Random random(2);
    std::vector<Vec3> centres;
    for (int i = 0; i < 100; ++i) {
        centres.push_back(50.0F * Vec3(random.uniform(), random.uniform(), random.uniform()));
        b.add(sphere(centres.back(), 1, 1), glass(1.5F));
    }
    const auto scene = b.build();
    CHECK(scene->casters().size() == 16);
    for (const Vec3 c : centres)
        CHECK(std::any_of(scene->casters().begin(), scene->casters().end(), [&](const Caster& caster) {
            return glm::length(c - caster.bounds.centre) + 0.999F <= caster.bounds.radius;
        }));
}

TEST_CASE("without a camera the scene is framed, and an unknown camera's name tells those there are") {
    SceneDescription d = someScene();
    const Scene none(d);
    const CameraDescription framing = none.camera("");
    const Sphere all = none.boundingSphere();
    CHECK(glm::length(framing.position - all.centre) > all.radius);
    CHECK(glm::dot(glm::normalize(all.centre - framing.position), -framing.back) > 0.999F);
    CHECK(glm::length(glm::cross(framing.right, framing.up) - framing.back) < 1e-6F);
    CHECK_THROWS_WITH_AS(none.camera("eye"),
                         ": camera \"eye\": does not exist, expected one of: (the scene has no cameras)", Error);
    d.cameras.resize(2);
    d.cameras[0].name = "eye";
    d.cameras[1].name = "plan";
    const Scene two(d);
    CHECK(two.camera("").name == "eye");
    CHECK(two.camera("plan").name == "plan");
    CHECK_THROWS_WITH_AS(two.camera("top"), ": camera \"top\": does not exist, expected one of: eye, plan", Error);
}

TEST_CASE("the hash changes with all that light depends on") {
    const SceneDescription sound = someScene();
    const std::string hash = hashDescription(sound);
    CHECK(hash.size() == 32);
    CHECK(hash == hashDescription(sound));
    using Change = void (*)(SceneDescription&);
    const std::vector<Change> changes = {
        [](SceneDescription& d) { d.meshes[0].positions[3].x += 1e-6F; },
        [](SceneDescription& d) { d.meshes[0].normals[3].x += 1e-6F; },
        [](SceneDescription& d) { std::swap(d.meshes[0].triangles[0][0], d.meshes[0].triangles[0][1]); },
        [](SceneDescription& d) { d.meshes[1].texCoords[0].assign(8, Vec2(0)); },
        [](SceneDescription& d) { d.meshes[1].texCoords[1].assign(8, Vec2(0)); },
        [](SceneDescription& d) { d.meshes[1].colors.assign(8, Vec4(1)); },
        [](SceneDescription& d) { d.meshes[0].material = 1; },
        [](SceneDescription& d) { d.meshes[0].object = "other"; },
        [](SceneDescription& d) { d.meshes[0].node = 7; },
        [](SceneDescription& d) { d.meshes[0].priority = 1; },
        [](SceneDescription& d) { d.meshes[0].switches.casts = false; },
        [](SceneDescription& d) { d.meshes[0].switches.receives = false; },
        [](SceneDescription& d) { d.meshes[0].switches.aim = false; },
        [](SceneDescription& d) { d.meshes.pop_back(); },
        [](SceneDescription& d) { d.materials[0].doubleSided = true; },
        [](SceneDescription& d) { d.materials[0].baseColor.y = 0.1F; },
        [](SceneDescription& d) { d.materials[0].metallic = 1; },
        [](SceneDescription& d) { d.materials[0].roughness = 0.1F; },
        [](SceneDescription& d) { d.materials[0].ior = 1.1F; },
        [](SceneDescription& d) { d.materials[0].specular = 1; },
        [](SceneDescription& d) { d.materials[0].specularColor.z = 0; },
        [](SceneDescription& d) { d.materials[0].transmission = 1; },
        [](SceneDescription& d) { d.materials[0].volume = VolumeProperties{}; },
        [](SceneDescription& d) { d.materials[2].emission.x = 3; },
        [](SceneDescription& d) { d.materials[0].baseColorTexture.texture = 0; },
        [](SceneDescription& d) { d.materials[0].metallicRoughnessTexture.texture = 0; },
        [](SceneDescription& d) { d.materials[0].specularTexture.texture = 0; },
        [](SceneDescription& d) { d.materials[0].specularColorTexture.texture = 0; },
        [](SceneDescription& d) { d.materials[0].transmissionTexture.texture = 0; },
        [](SceneDescription& d) { d.materials[0].emissiveTexture.texture = 0; },
        [](SceneDescription& d) { d.materials[0].normalTexture.texture = 0; },
        [](SceneDescription& d) {
            d.materials[0].normalTexture.texture = 0;
            d.materials[0].normalScale = 2;
        },
        [](SceneDescription& d) { d.meshes[0].tangents.assign(8, Vec4(1)); },
        [](SceneDescription& d) { d.materials[0].anisotropy = AnisotropyProperties{0.5F}; },
        [](SceneDescription& d) {
            d.materials[0].anisotropy = AnisotropyProperties{0.5F, 1};
        },
        [](SceneDescription& d) {
            d.materials[0].iridescence = IridescenceProperties{0.5F, 1.4F, 0.1F, 0.2F};
        },
        [](SceneDescription& d) {
            d.materials[0].sheen = SheenProperties{Rgb(0.5F, 1.4F, 0.1F), 0.2F};
        },
        [](SceneDescription& d) { d.materials[0].clearcoat = ClearcoatProperties{0.5F}; },
        [](SceneDescription& d) {
            d.materials[0].clearcoat = ClearcoatProperties{0.5F, 1};
        },
        [](SceneDescription& d) { d.materials[0].alphaMode = AlphaMode::Blend; },
        [](SceneDescription& d) { d.materials[0].alphaMode = AlphaMode::Mask; },
        [](SceneDescription& d) {
            d.materials[0].alphaMode = AlphaMode::Blend;
            d.materials[0].alpha = 0.5F;
        },
        [](SceneDescription& d) {
            d.materials[0].alphaMode = AlphaMode::Mask;
            d.materials[0].alphaCutoff = 0.4F;
        },
        [](SceneDescription& d) { d.materials[0].emissiveTexture.texCoord = 1; },
        [](SceneDescription& d) { d.materials[0].emissiveTexture.matrix.y = 1; },
        [](SceneDescription& d) { d.materials[0].emissiveTexture.offset.y = 1; },
        [](SceneDescription& d) {
            d.textures.push_back(twoTexels({1, 2, 3, 4, 5, 6, 7, 8}));
        },
        [](SceneDescription& d) { d.lights[0].name = "other"; },
        [](SceneDescription& d) { d.lights[0].kind = PunctualKind::Directional; },
        [](SceneDescription& d) { d.lights[0].intensity.x = 2; },
        [](SceneDescription& d) { d.lights[0].position.x = 2; },
        [](SceneDescription& d) {
            d.lights[0].direction = {1, 0, 0};
        },
        [](SceneDescription& d) { d.lights[0].innerConeAngle = 0.1F; },
        [](SceneDescription& d) { d.lights[0].outerConeAngle = 0.1F; },
    };
    std::vector<std::string> seen = {hash};
    for (size_t i = 0; i < changes.size(); ++i) {
        CAPTURE(i);
        SceneDescription d = sound;
        changes[i](d);
        const std::string changed = hashDescription(d);
        CHECK(std::find(seen.begin(), seen.end(), changed) == seen.end());
        seen.push_back(changed);
    }
    const auto hashOfTexture = [&](Texture t) {
        SceneDescription d = sound;
        d.textures = {std::move(t)};
        return hashDescription(d);
    };
    const Texture t = twoTexels({1, 2, 3, 4, 5, 6, 7, 8});
    Texture wrap = t, filter = t, texel = t;
    wrap.wrapT = Wrap::Clamp;
    filter.nearest = false;
    texel.rgba[7] = 9;
    for (const Texture& other : {wrap, filter, texel}) CHECK(hashOfTexture(other) != hashOfTexture(t));
}

TEST_CASE("the hash does not change with cameras, the file's name or its warnings") {
    SceneDescription d = someScene();
    const std::string hash = hashDescription(d);
    d.file = "other.glb";
    d.sceneName = "other";
    d.warnings = {"anything"};
    d.cameras.resize(3);
    CHECK(hashDescription(d) == hash);
}

TEST_CASE("creases are a box's edges and a sheet's rim, not the edges within either nor of a ball") {
    const auto creases = [](const Mesh& m) {
        SceneBuilder b;
        b.add(m, lambert(Rgb(1)));
        const auto scene = b.build();
        return findCreases(*scene).size();
    };
    CHECK(creases(box({0, 0, 0}, {1, 2, 3})) == 12);
    CHECK(creases(plate({0, 0, 0}, 1)) == 4);
    CHECK(creases(sphere({0, 0, 0}, 1, 3)) == 0);
}
