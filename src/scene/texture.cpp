#include "scene/texture.h"

#include <array>

#include "image/png.h"

namespace lsde {

namespace {

std::array<float, 256> makeSrgbTable() {
    std::array<float, 256> table;
    for (size_t i = 0; i < table.size(); ++i) table[i] = linearFromSrgb(static_cast<float>(i) / 255);
    return table;
}

// A coordinate brought to [0,1]; one that is not finite to 0.
float wrapped(float u, Wrap wrap) {
    if (!std::isfinite(u)) return 0;
    if (wrap == Wrap::Clamp) return std::clamp(u, 0.0F, 1.0F);
    if (wrap == Wrap::Repeat) return u - std::floor(u);
    const float period = u - 2 * std::floor(0.5F * u);
    return period > 1 ? 2 - period : period;
}

// The texel beside the picture's border that a filter reaches, at most one outside [0, size).
int neighbour(int i, int size, Wrap wrap) {
    if (wrap == Wrap::Repeat) return i < 0 ? size - 1 : i >= size ? 0 : i;
    return std::clamp(i, 0, size - 1);
}

}  // namespace

Vec4 Texture::texel(int x, int y, bool srgb) const {
    static const std::array<float, 256> kLinear = makeSrgbTable();
    const uint8_t* p = rgba.data() + 4 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
    const auto color = [&](int c) { return srgb ? kLinear[p[c]] : static_cast<float>(p[c]) / 255; };
    return {color(0), color(1), color(2), static_cast<float>(p[3]) / 255};
}

Vec4 Texture::sample(Vec2 uv, bool srgb) const {
    const float x = wrapped(uv.x, wrapS) * static_cast<float>(width);
    const float y = wrapped(uv.y, wrapT) * static_cast<float>(height);
    if (nearest)
        return texel(std::min(static_cast<int>(x), width - 1), std::min(static_cast<int>(y), height - 1), srgb);
    // Texel centres are at .5.
    const float left = std::floor(x - 0.5F), top = std::floor(y - 0.5F);
    const float fx = x - 0.5F - left, fy = y - 0.5F - top;
    const int x0 = neighbour(static_cast<int>(left), width, wrapS),
              x1 = neighbour(static_cast<int>(left) + 1, width, wrapS);
    const int y0 = neighbour(static_cast<int>(top), height, wrapT),
              y1 = neighbour(static_cast<int>(top) + 1, height, wrapT);
    const Vec4 above = glm::mix(texel(x0, y0, srgb), texel(x1, y0, srgb), fx);
    const Vec4 below = glm::mix(texel(x0, y1, srgb), texel(x1, y1, srgb), fx);
    return glm::mix(above, below, fy);
}

}  // namespace lsde
