// Pictures: float channels by name, and RGB.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace lsde {

// Row by row, top row first.
struct RgbImage {
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels;

    RgbImage() = default;
    RgbImage(int w, int h, Rgb fill = Rgb(0))
        : width(w), height(h), pixels(static_cast<size_t>(w) * static_cast<size_t>(h), fill) {}
    Rgb& at(int x, int y) {
        return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
    const Rgb& at(int x, int y) const {
        return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
};

// As in an EXR file: all channels of one size, by full name ("R", "caustic.R", "normal.X"), and attributes as text.
struct ImageFile {
    int width = 0;
    int height = 0;
    std::map<std::string, std::vector<float>> channels;
    std::map<std::string, std::string> attributes;

    // The layer's R, G, B ("" is the picture itself). Throws Error naming the missing channel and those there are.
    RgbImage layer(std::string_view name) const;
    void setLayer(std::string_view name, const RgbImage& image);  // adds NAME.R, NAME.G, NAME.B
    std::vector<std::string> layerNames() const;                  // those with R, G and B; "" first if present
};

}  // namespace lsde
