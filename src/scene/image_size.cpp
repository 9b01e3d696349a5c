#include "scene/image_size.h"

#include <string>
#include <string_view>

#include "base/error.h"
#include "scene/webp.h"

namespace lsde {

namespace {

using Bytes = std::span<const unsigned char>;

bool startsWith(Bytes bytes, std::string_view magic, size_t offset = 0) {
    if (bytes.size() < offset + magic.size()) return false;
    for (size_t i = 0; i < magic.size(); ++i)
        if (bytes[offset + i] != static_cast<unsigned char>(magic[i])) return false;
    return true;
}

uint32_t bigEndian(Bytes bytes, size_t offset, size_t count) {
    if (offset + count > bytes.size()) throw Error("its header is cut short");
    uint32_t value = 0;
    for (size_t i = 0; i < count; ++i) value = (value << 8) | bytes[offset + i];
    return value;
}

// Width and height are the first words of the first chunk (PNG specification, section 11.2.2).
ImageSize pngSize(Bytes bytes) {
    if (!startsWith(bytes, "IHDR", 12)) throw Error("a PNG without IHDR chunk");
    return {bigEndian(bytes, 16, 4), bigEndian(bytes, 20, 4)};
}

// Frame header (ITU-T T.81, B.2.2): any SOFn but DHT (C4), JPG (C8) and DAC (CC), which share its range.
bool isFrameHeader(uint32_t marker) {
    return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

ImageSize jpegSize(Bytes bytes) {
    for (size_t at = 2;;) {
        if (bigEndian(bytes, at, 1) != 0xFF) throw Error("a damaged JPEG: no marker where one is due");
        while (bigEndian(bytes, at, 1) == 0xFF) ++at;  // any number of fill bytes
        const uint32_t marker = bigEndian(bytes, at++, 1);
        if (isFrameHeader(marker)) return {bigEndian(bytes, at + 5, 2), bigEndian(bytes, at + 3, 2)};
        if (marker == 0xDA || marker == 0xD9) throw Error("a damaged JPEG: no frame header before its data");
        at += bigEndian(bytes, at, 2);
    }
}

std::string nameOfFormat(Bytes bytes) {
    if (startsWith(bytes, "\xABKTX 20\xBB")) return "KTX2";
    if (startsWith(bytes, "GIF8")) return "GIF";
    if (startsWith(bytes, "BM")) return "BMP";
    if (startsWith(bytes, "DDS ")) return "DDS";
    return "an unknown format";
}

}  // namespace

ImageSize readImageSize(Bytes bytes) {
    if (startsWith(bytes, "\x89PNG\r\n\x1A\n")) return pngSize(bytes);
    if (startsWith(bytes, "\xFF\xD8\xFF")) return jpegSize(bytes);
    if (isWebp(bytes)) return webpSize(bytes);
    throw Error(nameOfFormat(bytes) + ", expected PNG, JPEG or WebP");
}

}  // namespace lsde
