// Environments: which direction is which texel, how much light there is, how it is sampled, what is refused.
#include <doctest/doctest.h>

#include <fstream>

#include "base/error.h"
#include "image/exr.h"
#include "scene/environment_file.h"
#include "store/fixture.h"
#include "support/chi_squared.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/statistics.h"

using namespace lsde;
using namespace lsde::test;

namespace {

constexpr int kTests = 6;  // chi-squared tests in this file

// Black but for one texel.
RgbImage lit(int x, int y, int width = 64) {
    RgbImage image(width, width / 2);
    image.at(x, y) = Rgb(1);
    return image;
}

Rgb seen(const RgbImage& image, Vec3 direction, float turn = 0) {
    return EnvironmentMap(image, turn).radiance(glm::normalize(direction));
}

// Integral over all directions by the midpoint rule, far finer than the texels.
glm::dvec3 integralOf(const EnvironmentMap& map) {
    constexpr int kRows = 1200, kColumns = 1600;
    glm::dvec3 sum(0);
    for (int row = 0; row < kRows; ++row) {
        const double theta = std::numbers::pi * (row + 0.5) / kRows;
        glm::dvec3 rowSum(0);
        for (int column = 0; column < kColumns; ++column) {
            const double phi = 2 * std::numbers::pi * (column + 0.5) / kColumns;
            rowSum +=
                map.radiance({static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::cos(theta)),
                              static_cast<float>(std::sin(theta) * std::sin(phi))});
        }
        sum += rowSum * (std::sin(theta) * 2 * square(std::numbers::pi) / kRows / kColumns);
    }
    return sum;
}

std::string refusal(const std::filesystem::path& file) {
    try {
        loadEnvironment({file});
    } catch (const Error& e) {
        return e.what();
    }
    return "accepted";
}

std::filesystem::path written(const TemporaryFolder& folder, const RgbImage& image) {
    ImageFile file;
    file.setLayer("", image);
    const auto path = folder.path() / "environment.exr";
    std::filesystem::remove(path);
    writeExr(path, file, {});
    return path;
}

bool says(const std::string& message, const std::string& part) { return message.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the picture's centre lies along +Z, its right half towards -X, its top row along +Y") {
    // Between two texels: half of the one.
    CHECK(seen(lit(32, 16), {0, 0, 1}).x == doctest::Approx(0.25));
    CHECK(seen(lit(48, 16), {-1, 0, 0}).x == doctest::Approx(0.25));
    CHECK(seen(lit(16, 16), {1, 0, 0}).x == doctest::Approx(0.25));
    CHECK(seen(lit(0, 16), {0, 0, -1}).x == doctest::Approx(0.25));
    CHECK(seen(lit(63, 16), {0, 0, -1}).x == doctest::Approx(0.25));  // its left and right edges meet
    RgbImage top(64, 32);
    for (int x = 0; x < 64; ++x) top.at(x, 0) = Rgb(1);
    CHECK(seen(top, {0, 1, 0}).x == doctest::Approx(1));
    CHECK(seen(top, {0, -1, 0}).x == 0);
}

TEST_CASE("turning by a quarter moves what lay along +Z to +X") {
    CHECK(seen(lit(32, 16), {1, 0, 0}, kPi / 2).x == doctest::Approx(0.25));
    CHECK(seen(lit(32, 16), {0, 0, 1}, kPi / 2).x == 0);
}

TEST_CASE("an environment's integral is that of the radiance it shows, exactly") {
    for (const int width : {4, 16, 64}) {
        CAPTURE(width);
        const EnvironmentMap map(spottedSky(width), 0.3F);
        const glm::dvec3 expected = integralOf(map);
        for (int c = 0; c < 3; ++c) CHECK(map.integral()[c] == doctest::Approx(expected[c]).epsilon(2e-5));
    }
    CHECK(EnvironmentMap(RgbImage(2, 1, Rgb(3)), 0).integral().x == doctest::Approx(3 * 4 * kPi));
}

TEST_CASE("directions of an environment have the density that it gives, which sums to 1") {
    for (const int width : {8, 64}) {
        CAPTURE(width);
        const EnvironmentMap map(spottedSky(width), -0.7F);
        Random random(5);
        const auto result = chiSquaredOnSphere(
            {32, 32, 16, 200'000},
            [&]() -> std::optional<Vec3> {
                float pdfW = 0;
                const Vec3 direction = map.sample(random.uniform2D(), pdfW);
                CHECK(glm::length(direction) == doctest::Approx(1).epsilon(1e-5));
                return direction;
            },
            [&](Vec3 direction) { return map.pdfW(direction); });
        CHECK(result.accepted(kTests));
    }
}

TEST_CASE("the density of a sampled direction is the one asked for later, but for the rounding at a texel's edge") {
    const EnvironmentMap map(spottedSky(256), 1);
    Random random(6);
    int differ = 0;
    for (int i = 0; i < 20'000; ++i) {
        float pdfW = 0;
        const Vec3 direction = map.sample(random.uniform2D(), pdfW);
        differ += std::fabs(map.pdfW(direction) / pdfW - 1) > 1e-4F ? 1 : 0;
    }
    CHECK(differ < 10);
}

TEST_CASE("sampling an environment by its density gives its integral, and wherever it shines it may be drawn") {
    const EnvironmentMap map(spottedSky(), 0);
    Random random(7);
    Mean estimate;
    for (int i = 0; i < 100'000; ++i) {
        float pdfW = 0;
        const Vec3 direction = map.sample(random.uniform2D(), pdfW);
        estimate.add(luminance(map.radiance(direction)) / pdfW);
        const Vec3 any = sphereFromSquare(random.uniform(), random.uniform());
        if (!isBlack(map.radiance(any))) CHECK(map.pdfW(any) > 0);
    }
    CHECK(estimate.agrees(luminance(map.integral())));
    // By luminance: little is left to the noise.
    CHECK(estimate.standardError() < 2e-3 * estimate.value());
}

TEST_CASE("the sun's disc sends its radiance from its solid angle, and samples within it") {
    SceneBuilder builder;
    builder.add(plate({0, 0, 0}, 2), lambert(Rgb(0.5F)));
    builder.sunDisc({1, 1, 0}, 0.265F, Rgb(1000));
    const auto scene = builder.build();
    REQUIRE(scene->infiniteLights().size() == 1);
    const auto& sun = std::get<InfiniteLight>(scene->lights()[0].shape);
    const double solidAngle = 2 * std::numbers::pi * (1 - std::cos(0.265 * std::numbers::pi / 180));
    CHECK(sun.integral().x == doctest::Approx(1000 * solidAngle).epsilon(1e-5));
    CHECK(sun.power().x == doctest::Approx(1000 * solidAngle * kPi * 8).epsilon(1e-5));
    Random random(8);
    for (int i = 0; i < 1000; ++i) {
        float pdfW = 0;
        const Vec3 towards = sun.sample(random.uniform2D(), pdfW);
        CHECK(pdfW == doctest::Approx(1 / solidAngle).epsilon(1e-5));
        CHECK(glm::length(towards - glm::normalize(Vec3(1, 1, 0))) < 0.004626F);
    }
    CHECK(sun.pdfW(glm::normalize(Vec3(1, 1.02F, 0))) == 0);
    CHECK_FALSE(scene->lights()[0].isDelta());
}

TEST_CASE("an environment belongs to the scene's hash: its pixels and how it is turned") {
    const auto hashOf = [](const std::optional<RgbImage>& image, float turn = 0) {
        SceneBuilder builder;
        builder.add(plate({0, 0, 0}, 2), lambert(Rgb(0.5F)));
        if (image) builder.environment(*image, turn);
        return builder.build()->hash();
    };
    const std::string one = hashOf(spottedSky());
    CHECK(one == hashOf(spottedSky()));
    CHECK(one != hashOf({}));
    CHECK(one != hashOf(spottedSky(), 1));
    RgbImage other = spottedSky();
    other.at(3, 3).y += 1e-6F;
    CHECK(one != hashOf(other));
}

TEST_CASE("a picture of an environment is read with its strength, and turned") {
    const TemporaryFolder folder;
    const EnvironmentDescription e = loadEnvironment({written(folder, spottedSky()), 90, 2});
    CHECK(e.name == "environment");
    CHECK(e.turn == doctest::Approx(kPi / 2));
    CHECK(e.image.at(2, 2) == Rgb(80, 60, 40));
}

TEST_CASE("an environment that is no picture of radiance all around is refused with file, pixel and value") {
    const TemporaryFolder folder;
    const auto refusalOf = [&](Rgb value) {
        RgbImage image = spottedSky();
        image.at(3, 5) = value;
        return refusal(written(folder, image));
    };
    CHECK(says(refusalOf({1, NAN, 1}), "environment.exr: pixel (3, 5): nan, expected radiance from 0 to"));
    CHECK(says(refusalOf({1, 1, -0.5F}), "environment.exr: pixel (3, 5): -0.5, expected"));
    CHECK(says(refusalOf({kInfinity, 1, 1}), "environment.exr: pixel (3, 5): inf, expected"));
    CHECK(says(refusalOf({2e10F, 1, 1}), "environment.exr: pixel (3, 5): 2e+10, expected"));
    CHECK(says(refusal(written(folder, RgbImage(16, 8))), "environment.exr: all pixels are 0, expected"));
    CHECK(says(refusal(written(folder, RgbImage(16, 9, Rgb(1)))), "environment.exr: 16x9 pixels, expected an equi"));
    CHECK(says(refusal(folder.path() / "none.exr"), "none.exr: "));
    CHECK(says(refusal(folder.path() / "sky.jpg"), "sky.jpg: \".jpg\", expected an OpenEXR (.exr) or"));
    ImageFile grey;
    grey.width = 2;
    grey.height = 1;
    grey.channels["Y"] = {1, 1};
    writeExr(folder.path() / "grey.exr", grey, {});
    CHECK(says(refusal(folder.path() / "grey.exr"), "grey.exr: no channel \"R\", expected one of: Y"));
}
