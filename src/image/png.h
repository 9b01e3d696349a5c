// Tone-mapped 8-bit pictures for looking at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"

namespace lsde {

// The bytes of a PNG file, RGB with 8 bits a channel: linear Rec. 709 times 2^exposureStops, clamped to [0,1], sRGB
// curve; NaN is black. Same bytes for the same input: no date.
std::string encodePng(const RgbImage& image, float exposureStops = 0);
// rgb8: three bytes a pixel, sRGB, row by row, top row first.
std::string encodePngBytes(int width, int height, const std::vector<uint8_t>& rgb8);
// Atomic. Throws Error naming path and reason.
void writePng(const std::filesystem::path& path, const RgbImage& image, float exposureStops = 0);

// The curve of sRGB (IEC 61966-2-1) for [0,1], and its inverse; the straight part goes on below 0.
float srgbFromLinear(float x);
float linearFromSrgb(float x);

}  // namespace lsde
