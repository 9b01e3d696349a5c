// Small pictures by formula, so that other programs can make the same ones (record_oracles.py), and recorded ones.
#pragma once

#include <cstdint>
#include <string>

#include "base/math.h"
#include "image/exr.h"
#include "image/image.h"

namespace lsde {

inline uint32_t hash32(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ (x >> 16);
}

// 64x48: a gradient of its own in each channel, a disc of value `disc` around (discX, 20), and noise: each value times
// a factor in [1 - noise/2, 1 + noise/2).
inline RgbImage testPicture(int discX, double disc, double noise) {
    RgbImage image(64, 48);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const double u = (x + 0.5) / image.width;
                const double v = (y + 0.5) / image.height;
                const double gradient = 0.1 + 0.8 * (c == 0 ? u : c == 1 ? v : u * v);
                const double value = square(x - discX) + square(y - 20) < 60 ? disc : gradient;
                const auto index = static_cast<uint32_t>((y * image.width + x) * 3 + c);
                const double random = (hash32(index) >> 8) * 0x1p-24;
                image.at(x, y)[c] = static_cast<float>(value * (1 + noise * (random - 0.5)));
            }
    return image;
}

// One of tests/data/reference.
inline RgbImage recordedPicture(const std::string& name) {
    return readExr(std::string(LSDE_TEST_DATA) + "/reference/" + name + ".exr").layer("");
}

}  // namespace lsde
