// Size of an encoded picture, from its header alone: so that limits hold before anything is decoded.
#pragma once

#include <cstdint>
#include <span>

namespace lsde {

struct ImageSize {
    uint32_t width = 0, height = 0;
};

// Of PNG, JPEG or WebP, told by content. Throws Error, without the file's name, for other formats (named if known) and
// for a header that is cut short or damaged.
ImageSize readImageSize(std::span<const unsigned char> bytes);

}  // namespace lsde
