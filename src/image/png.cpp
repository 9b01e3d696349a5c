#include "image/png.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "store/file.h"

namespace lsde {

namespace {

// Not a number becomes black.
uint8_t displayByte(float linear) {
    const float clamped = linear > 0 ? std::min(linear, 1.0F) : 0.0F;
    return static_cast<uint8_t>(std::lround(255 * srgbFromLinear(clamped)));
}

}  // namespace

std::string encodePng(const RgbImage& image, float exposureStops) {
    const float exposure = std::exp2(exposureStops);
    std::vector<uint8_t> rgb8;
    rgb8.reserve(3 * image.pixels.size());
    for (const Rgb pixel : image.pixels)
        for (int c = 0; c < 3; ++c) rgb8.push_back(displayByte(exposure * pixel[c]));
    return encodePngBytes(image.width, image.height, rgb8);
}

std::string encodePngBytes(int width, int height, const std::vector<uint8_t>& rgb8) {
    LSDE_ASSERT(rgb8.size() == size_t{3} * static_cast<size_t>(width) * static_cast<size_t>(height));
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(width);
    header.height = static_cast<png_uint_32>(height);
    header.format = PNG_FORMAT_RGB;
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string file(bytes, '\0');
    if (png_image_write_to_memory(&header, file.data(), &bytes, 0, rgb8.data(), 0, nullptr) == 0)
        throw Error(fmt::format("PNG of {}x{} pixels: {}", width, height, header.message));
    file.resize(bytes);
    return file;
}

void writePng(const std::filesystem::path& path, const RgbImage& image, float exposureStops) {
    writeFileAtomically(path, encodePng(image, exposureStops));
}

float srgbFromLinear(float x) {
    if (x <= 0.0031308F) return 12.92F * x;
    return static_cast<float>(1.055 * std::pow(static_cast<double>(x), 1 / 2.4) - 0.055);
}

float linearFromSrgb(float x) {
    if (x <= 0.04045F) return x / 12.92F;
    return static_cast<float>(std::pow((x + 0.055) / 1.055, 2.4));
}

}  // namespace lsde
