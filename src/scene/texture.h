// Textures: decoded to linear floats when looked up.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"

namespace lsde {

enum class Wrap : uint8_t { Repeat, Mirror, Clamp };

// v = 0 is the top row. 8-bit texels; sRGB decoding of the colour channels where the use asks for it.
struct Texture {
    std::string name;
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;  // 4 bytes a texel, top row first
    Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;
    bool nearest = false;  // magFilter NEAREST; else bilinear on linear values

    Vec4 texel(int x, int y, bool srgb) const;
    Vec4 sample(Vec2 uv, bool srgb) const;
};

// A material's use of a texture.
struct TextureRef {
    int texture = -1;  // index into SceneDescription::textures; -1: none
    int texCoord = 0;  // set 0 or 1
    // KHR_texture_transform, already combined: uv' = (a b; c d) uv + offset
    Vec4 matrix{1, 0, 0, 1};
    Vec2 offset{0};

    explicit operator bool() const { return texture >= 0; }
    Vec2 transform(Vec2 uv) const {
        return {matrix.x * uv.x + matrix.y * uv.y + offset.x, matrix.z * uv.x + matrix.w * uv.y + offset.y};
    }
};

}  // namespace lsde
