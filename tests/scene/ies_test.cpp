// Lights with measured distributions.
#include <doctest/doctest.h>

#include "base/error.h"
#include "scene/gltf_file.h"
#include "support/random.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

// A file of LM-63: type 1 is C, 2 is B, 3 is A.
std::string ies(int type, const std::string& vertical, const std::string& horizontal, const std::string& values,
                const std::string& scale = "1", const std::string& tilt = "TILT=NONE\n") {
    const auto count = [](const std::string& list) { return std::count(list.begin(), list.end(), ' ') + 1; };
    return "IESNA:LM-63-2002\n[TEST] none\n" + tilt + "1 1000 " + scale + " " + std::to_string(count(vertical)) + " " +
           std::to_string(count(horizontal)) + " " + std::to_string(type) + " 2 0 0 0\n1 1 100\n" + vertical + "\n" +
           horizontal + "\n" + values + "\n";
}

// In a plane through the axis, by degrees from -Z, towards an azimuth from +X to +Y.
Vec3 polar(float vertical, float azimuth) {
    const float v = vertical * kPi / 180, a = azimuth * kPi / 180;
    return {std::sin(v) * std::cos(a), std::sin(v) * std::sin(a), -std::cos(v)};
}

GltfFile iesFile(const std::string& text, Json use = Json::object(), Json node = Json::object()) {
    GltfFile file = triangleFile();
    const size_t view = file.view(text);
    file.json["extensions"]["EXT_lights_ies"]["lights"] = {
        {{"name", "downlight"}, {"bufferView", view}, {"mimeType", "application/x-ies-lm-63"}}};
    use["light"] = 0;
    node["extensions"]["EXT_lights_ies"] = use;
    file.node(node);
    return file;
}

const std::string kEven = ies(1, "0 180", "0", "100 100");

}  // namespace

TEST_CASE("an even profile shines everywhere alike, with 4 pi of its intensity") {
    const IesProfile even(kEven);
    CHECK(even.greatest() == 100);
    CHECK(even.solidAngle() == doctest::Approx(4 * kPi).epsilon(1e-6));
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const float z = 2 * random.uniform() - 1, a = 360 * random.uniform();
        CHECK(even.relative(polar(std::acos(z) * 180 / kPi, a)) == doctest::Approx(1));
    }
}

TEST_CASE("a profile of a cosine has its integral, pi, and nothing beyond what was measured") {
    std::string angles, values;
    for (int i = 0; i <= 90; ++i) {
        angles += (i > 0 ? " " : "") + std::to_string(i);
        values += std::to_string(std::cos(i * 3.14159265358979 / 180)) + (i % 7 == 0 ? "\n" : ", ");
    }
    const IesProfile lambert(ies(1, angles, "0", values, "250"));
    CHECK(lambert.greatest() == 250);
    CHECK(lambert.solidAngle() == doctest::Approx(kPi).epsilon(1e-3));
    CHECK(lambert.relative(polar(60, 17)) == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(lambert.relative(polar(100, 0)) == 0);
}

TEST_CASE("a narrow beam's power is that of its cone") {
    // 1 within a degree, none from 1.001 on.
    const IesProfile beam(ies(1, "0 1 1.001 90", "0", "1 1 0 0"));
    CHECK(beam.solidAngle() == doctest::Approx(2 * kPi * (1 - std::cos(1.0005 * 3.14159265 / 180))).epsilon(1e-3));
}

TEST_CASE("planes that symmetry leaves out are made up") {
    // Intensities 1, 2, ... by plane, the same at every height.
    const auto at = [](const IesProfile& p, float azimuth) { return p.relative(polar(50, azimuth)) * p.greatest(); };
    const IesProfile quarter(ies(1, "0 90", "0 90", "1 1 2 2"));
    for (const auto& [azimuth, value] : {std::pair(0.0F, 1.0F), {90, 2}, {180, 1}, {270, 2}, {135, 1.5F}, {315, 1.5F}})
        CHECK(at(quarter, azimuth) == doctest::Approx(value));
    const IesProfile half(ies(1, "0 90", "0 90 180", "1 1 2 2 3 3"));
    for (const auto& [azimuth, value] : {std::pair(0.0F, 1.0F), {90, 2}, {180, 3}, {270, 2}, {45, 1.5F}, {315, 1.5F}})
        CHECK(at(half, azimuth) == doctest::Approx(value));
    const IesProfile across(ies(1, "0 90", "90 180 270", "1 1 2 2 3 3"));
    for (const auto& [azimuth, value] : {std::pair(0.0F, 2.0F), {90, 1}, {180, 2}, {270, 3}, {45, 1.5F}, {315, 2.5F}})
        CHECK(at(across, azimuth) == doctest::Approx(value));
    const IesProfile all(ies(1, "0 90", "0 90 180 270 360", "1 1 2 2 3 3 4 4 1 1"));
    const IesProfile open(ies(1, "0 90", "0 90 180 270", "1 1 2 2 3 3 4 4"));
    for (const float azimuth : {0.0F, 45.0F, 90.0F, 200.0F, 315.0F, 350.0F})
        CHECK(at(all, azimuth) == doctest::Approx(at(open, azimuth)));
    CHECK(at(all, 315) == doctest::Approx(2.5));
    CHECK(quarter.solidAngle() == doctest::Approx(2 * kPi * 1.5 / 2).epsilon(1e-5));
}

TEST_CASE("types A and B count horizontal angles clockwise, each about its own axis") {
    const std::string cross = "0 0 0 0 5 8 0 0 0";  // vertical -45 0 45 of each plane: bright ahead and to the right
    const IesProfile b(ies(2, "-45 0 45", "-45 0 45", "0 0 0 0 5 0 0 8 0"));
    const float s = std::sqrt(0.5F);
    CHECK(b.relative({0, 0, -1}) == doctest::Approx(5.0 / 8));
    CHECK(b.relative({s, 0, -s}) == doctest::Approx(1));
    CHECK(b.relative({-s, 0, -s}) == doctest::Approx(0));
    CHECK(b.relative({0, 0, 1}) == 0);
    const IesProfile a(ies(3, "-45 0 45", "-45 0 45", cross));
    CHECK(a.relative({0, 0, -1}) == doctest::Approx(5.0 / 8));
    CHECK(a.relative({0, s, -s}) == doctest::Approx(1));
    // Even over a whole half space, both have its solid angle.
    for (const int type : {2, 3}) {
        const IesProfile halfSpace(ies(type, "-90 0 90", "-90 90", "1 1 1 1 1 1"));
        CHECK(halfSpace.solidAngle() == doctest::Approx(2 * kPi).epsilon(1e-5));
        const IesProfile mirrored(ies(type, "-90 0 90", "0 90", "1 1 1 3 3 3"));
        CHECK(mirrored.relative({s, 0, -s}) == doctest::Approx(mirrored.relative({-s, 0, -s})));
    }
}

TEST_CASE("a profile's tilt is skipped, whatever it holds") {
    const IesProfile tilted(ies(1, "0 180", "0", "100 100", "1", "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8\n"));
    CHECK(tilted.tilted());
    CHECK(tilted.solidAngle() == doctest::Approx(4 * kPi).epsilon(1e-6));
    CHECK(warnsOnce(load(iesFile(ies(1, "0 180", "0", "1 1", "1", "TILT=lamp.tlt\n"))), "TILT"));
}

TEST_CASE("a measured light is placed by its node, and shines as its profile, multiplier and colour say") {
    const double half = std::sqrt(0.5);
    // -Z turned to -Y, +X stays.
    const GltfFile file =
        iesFile(ies(1, "0 90", "0 90", "40 40 10 10"), {{"multiplier", 2.5}, {"color", {1, 0.5, 0}}},
                {{"translation", {1, 2, 3}}, {"rotation", {-half, 0, 0, half}}, {"scale", {3, 3, 3}}});
    const Scene scene(load(file));
    REQUIRE(scene.lights().size() == 1);
    CHECK(scene.lights()[0].name == "downlight");
    const auto& light = std::get<PointLight>(scene.lights()[0].shape);
    CHECK(light.position == Vec3(1, 2, 3));
    LightSample sample;
    const auto irradiance = [&](Vec3 p) {
        REQUIRE(scene.lights()[0].sampleToward(p, Vec2(0), sample));
        return sample.radiance;
    };
    const Rgb along = irradiance(light.position + 2.0F * glm::normalize(Vec3(1, -1, 0)));
    CHECK(along.x == doctest::Approx(100.0 / 4));
    CHECK(along.y == doctest::Approx(50.0 / 4));
    CHECK(along.z == 0);
    CHECK(irradiance(light.position + 2.0F * glm::normalize(Vec3(0, -1, -1))).x == doctest::Approx(25.0 / 4));
    CHECK_FALSE(scene.lights()[0].sampleToward(light.position + Vec3(0, 1, 0), Vec2(0), sample));
    CHECK(scene.lights()[0].power().x == doctest::Approx(2 * kPi * 62.5).epsilon(1e-4));
}

TEST_CASE("a scene's hash knows what a measured light depends on") {
    const auto hash = [](const GltfFile& file) { return Scene(load(file)).hash(); };
    const std::string before = hash(iesFile(kEven));
    CHECK(hash(iesFile(kEven)) == before);
    CHECK(hash(iesFile(ies(1, "0 180", "0", "100 50"))) != before);
    CHECK(hash(iesFile(ies(1, "0 170", "0", "100 100"))) != before);
    CHECK(hash(iesFile(kEven, {{"multiplier", 2}})) != before);
    CHECK(hash(iesFile(kEven, Json::object(), {{"rotation", {1, 0, 0, 0}}})) != before);
}

TEST_CASE("profiles that cannot be read are refused by a line that says why") {
    const auto refusal = [](const std::string& text) { return errorOf([&] { IesProfile profile(text); }); };
    CHECK(contains(refusal("IESNA:LM-63-2002\n"), "no line \"TILT=\""));
    CHECK(contains(refusal("TILT=NONE\n1 2"), "ends before candela multiplier"));
    CHECK(contains(refusal(ies(4, "0 90", "0", "1 1")), "photometric type 4, expected a whole number from 1 to 3"));
    CHECK(contains(refusal(ies(1, "0 90", "0", "1")), "ends before candela value"));
    CHECK(contains(refusal(ies(1, "0 90", "0", "1 x1")), "candela value \"x1\", expected a number"));
    CHECK(contains(refusal(ies(1, "0 90", "0", "1 -1")), "candela value -1, expected 0 or more"));
    CHECK(contains(refusal(ies(1, "0 90", "0", "1 nan")), "expected a number"));
    CHECK(contains(refusal(ies(1, "90 0", "0", "1 1")), "vertical angle 0 after 90, expected more"));
    CHECK(contains(refusal(ies(1, "0 200", "0", "1 1")), "expected within 0 to 180"));
    CHECK(contains(refusal(ies(1, "0", "0", "1")), "number of vertical angles 1, expected a whole number from 2"));
    CHECK(contains(refusal(ies(1, "0 90", "0 100", "1 1 1 1")), "horizontal angles from 0 to 100 degrees"));
    CHECK(refusalOf(iesFile("nothing")) == "IES light 0: IES profile: no line \"TILT=\", expected a file of LM-63");
    GltfFile missing = iesFile(kEven);
    missing["/nodes/1/extensions/EXT_lights_ies"].erase("light");
    CHECK(contains(refusalOf(missing), "light"));
    GltfFile negative = iesFile(kEven, {{"multiplier", -1}});
    CHECK(contains(refusalOf(negative), "multiplier -1"));
}
