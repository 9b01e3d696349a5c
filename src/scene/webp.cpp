#include "scene/webp.h"

#include <webp/decode.h>

#include <string_view>

#include "base/error.h"

namespace lsde {

bool isWebp(std::span<const unsigned char> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.starts_with("RIFF") && text.size() >= 12 && text.substr(8, 4) == "WEBP";
}

ImageSize webpSize(std::span<const unsigned char> bytes) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
        throw Error("a WebP picture whose header is damaged");
    if (features.has_animation != 0) throw Error("an animated WebP picture, expected one that stands still");
    return {static_cast<uint32_t>(features.width), static_cast<uint32_t>(features.height)};
}

bool decodeWebp(std::span<const unsigned char> bytes, Texture& texture) {
    const size_t stride = 4 * static_cast<size_t>(texture.width);
    texture.rgba.resize(stride * static_cast<size_t>(texture.height));
    return WebPDecodeRGBAInto(bytes.data(), bytes.size(), texture.rgba.data(), texture.rgba.size(),
                              static_cast<int>(stride)) != nullptr;
}

}  // namespace lsde
