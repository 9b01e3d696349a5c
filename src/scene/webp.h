// WebP pictures. webp.cpp is the one file that includes libwebp.
#pragma once

#include "scene/image_size.h"
#include "scene/texture.h"

namespace lsde {

// By content.
bool isWebp(std::span<const unsigned char> bytes);
// From its header. Throws Error, without the file's name, for one that is damaged or moves.
ImageSize webpSize(std::span<const unsigned char> bytes);
// To 8 bits RGBA, of the texture's width and height. False if its data are damaged.
bool decodeWebp(std::span<const unsigned char> bytes, Texture& texture);

}  // namespace lsde
