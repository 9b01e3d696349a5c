#include "image/png.h"

#include <doctest/doctest.h>
#include <png.h>

#include <cmath>
#include <limits>
#include <random>

#include "store/fixture.h"

using namespace lsde;

namespace {

struct Decoded {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb8;
};

Decoded decode(const std::string& file) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&header, file.data(), file.size()) != 0);
    CHECK(header.format == PNG_FORMAT_RGB);
    Decoded out{header.width, header.height, std::vector<uint8_t>(PNG_IMAGE_SIZE(header))};
    REQUIRE(png_image_finish_read(&header, nullptr, out.rgb8.data(), 0, nullptr) != 0);
    return out;
}

std::vector<uint8_t> noise(size_t count) {
    std::mt19937 random(1);
    std::vector<uint8_t> bytes(count);
    for (uint8_t& b : bytes) b = static_cast<uint8_t>(random());
    return bytes;
}

// The types of the chunks of a PNG file, in order.
std::vector<std::string> chunkTypes(const std::string& file) {
    std::vector<std::string> types;
    for (size_t at = 8; at + 12 <= file.size();) {
        uint32_t length = 0;
        for (size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<uint8_t>(file[at + i]);
        types.push_back(file.substr(at + 4, 4));
        at += 12 + length;
    }
    return types;
}

}  // namespace

TEST_CASE("a PNG decoded has the bytes that were encoded") {
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{7, 3}, std::pair{300, 200}}) {
        const auto rgb8 = noise(size_t{3} * static_cast<size_t>(width) * static_cast<size_t>(height));
        const std::string file = encodePngBytes(width, height, rgb8);
        const Decoded decoded = decode(file);
        CHECK(decoded.width == static_cast<uint32_t>(width));
        CHECK(decoded.height == static_cast<uint32_t>(height));
        CHECK(decoded.rgb8 == rgb8);
        CHECK(file == encodePngBytes(width, height, rgb8));
    }
}

TEST_CASE("a PNG holds no date and no text, and says that it is sRGB") {
    for (const std::string& type : chunkTypes(encodePngBytes(20, 10, noise(600))))
        CHECK_MESSAGE(
            (type == "IHDR" || type == "sRGB" || type == "gAMA" || type == "cHRM" || type == "IDAT" || type == "IEND"),
            type);
}

TEST_CASE("linear values become sRGB bytes, clamped, with exposure in stops") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    RgbImage image(3, 1);
    image.pixels = {Rgb(0, 0.5F, 1), Rgb(-1, 2, nan), Rgb(0.001F, 0.2158605F, std::numeric_limits<float>::infinity())};
    // 255 times the curve of IEC 61966-2-1: .5 gives 187.5, .001 gives 3.3, .2158605 gives 128.
    CHECK(decode(encodePng(image)).rgb8 == std::vector<uint8_t>{0, 188, 255, 0, 255, 0, 3, 128, 255});
    RgbImage darker = image;
    for (Rgb& pixel : darker.pixels) pixel *= 0.125F;
    CHECK(encodePng(darker, 3) == encodePng(image));
    CHECK(encodePng(darker) != encodePng(image));
}

TEST_CASE("a PNG is written whole or refused by name") {
    const test::TemporaryFolder folder;
    const RgbImage image(5, 4, Rgb(0.5F));
    writePng(folder / "picture.png", image);
    CHECK(test::contentOf(folder / "picture.png") == encodePng(image));
    CHECK(test::errorOf([&] { writePng(folder / "none" / "picture.png", image); }) ==
          (folder / "none").string() + "/picture.png: cannot be written: No such file or directory");
}

TEST_CASE("the sRGB curve and its inverse are those of IEC 61966-2-1") {
    for (int i = 0; i <= 255; ++i) {
        const float encoded = static_cast<float>(i) / 255;
        CHECK(srgbFromLinear(linearFromSrgb(encoded)) == doctest::Approx(encoded).epsilon(1e-6));
    }
    CHECK(srgbFromLinear(0) == 0);
    CHECK(srgbFromLinear(1) == 1);
    CHECK(linearFromSrgb(1) == 1);
    CHECK(srgbFromLinear(0.002F) == doctest::Approx(0.02584).epsilon(1e-6));
    CHECK(srgbFromLinear(0.18F) == doctest::Approx(1.055 * std::pow(0.18, 1 / 2.4) - 0.055).epsilon(1e-6));
    CHECK(linearFromSrgb(0.5F) == doctest::Approx(0.214041140).epsilon(1e-6));
    // The two parts of the curve meet.
    CHECK(srgbFromLinear(std::nextafter(0.0031308F, 1.0F)) ==
          doctest::Approx(srgbFromLinear(0.0031308F)).epsilon(1e-5));
}
