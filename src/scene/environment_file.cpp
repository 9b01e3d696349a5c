#include "scene/environment_file.h"

#include <fmt/format.h>

#include "base/error.h"
#include "image/exr.h"
#include "image/hdr.h"

namespace lsde {

namespace {

constexpr int64_t kMostPixels = int64_t{1} << 27;  // 16384 x 8192
constexpr float kMostRadiance = 1e10F;

RgbImage readPicture(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == ".hdr" || extension == ".pic") return readHdr(file, kMostPixels);
    if (extension != ".exr")
        throw Error(fmt::format("{}: \"{}\", expected an OpenEXR (.exr) or a Radiance picture (.hdr)", file.string(),
                                extension));
    const ImageFile exr = readExr(file, kMostPixels);
    try {
        return exr.layer("");
    } catch (const Error& e) {
        throw Error(fmt::format("{}: {}", file.string(), e.what()));
    }
}

}  // namespace

EnvironmentDescription loadEnvironment(const EnvironmentSettings& settings) {
    EnvironmentDescription out{"environment", readPicture(settings.file), settings.turnDeg * (kPi / 180)};
    const std::string file = settings.file.string();
    RgbImage& image = out.image;
    if (image.width != 2 * image.height)
        throw Error(fmt::format("{}: {}x{} pixels, expected an equirectangular picture, twice as wide as high", file,
                                image.width, image.height));
    bool black = true;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) {
                float& value = image.at(x, y)[c];
                value *= settings.strength;
                if (!(value >= 0 && value <= kMostRadiance))
                    throw Error(fmt::format("{}: pixel ({}, {}): {:.6g}, expected radiance from 0 to {:.6g}", file, x,
                                            y, value, kMostRadiance));
                black &= value == 0;
            }
    if (black) throw Error(file + ": all pixels are 0, expected an environment that shines");
    return out;
}

}  // namespace lsde
