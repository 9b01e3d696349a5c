#include "image/film.h"

#include <fmt/format.h>

#include "base/error.h"
#include "image/fill.h"

namespace lsde {

Film::Film(int width, int height, std::vector<std::string> layerNames)
    : width_(width),
      height_(height),
      names_(std::move(layerNames)),
      sums_(names_.size() * static_cast<size_t>(height) * static_cast<size_t>(width) * 3) {
    LSDE_ASSERT(width > 0 && height > 0 && !names_.empty() && names_[0].empty());
}

size_t Film::index(int x, int y, int layer) const {
    LSDE_ASSERT(x >= 0 && x < width_ && y >= 0 && y < height_ && layer >= 0 && layer < layers());
    const auto row = static_cast<size_t>(layer) * static_cast<size_t>(height_) + static_cast<size_t>(y);
    return (row * static_cast<size_t>(width_) + static_cast<size_t>(x)) * 3;
}

void Film::add(int x, int y, int layer, Rgb value) {
    const size_t at = index(x, y, layer);
    for (int c = 0; c < 3; ++c) sums_[at + static_cast<size_t>(c)] += value[c];
}

RgbImage Film::develop(int layer, double samples) const {
    const std::vector<double> same(static_cast<size_t>(width_) * static_cast<size_t>(height_), samples);
    return develop(layer, same);
}

RgbImage Film::develop(int layer, std::span<const double> samples) const {
    RgbImage image(width_, height_);
    LSDE_ASSERT(samples.size() == image.pixels.size());
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const double* sum = &sums_[index(x, y, layer)];
            Rgb& pixel = image.at(x, y);
            const double count = samples[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
            if (count == 0) continue;
            for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(sum[c] / count);
            if (!isFinite(pixel))
                throw Error(fmt::format("layer \"{}\": pixel ({}, {}) is ({}, {}, {}), expected finite values",
                                        layerName(layer), x, y, pixel.x, pixel.y, pixel.z));
        }
    fillUnseen(image, samples);
    return image;
}

void Film::accumulate(const Film& other, double factor) {
    LSDE_ASSERT(other.width_ == width_ && other.height_ == height_ && other.names_ == names_);
    for (size_t i = 0; i < sums_.size(); ++i) sums_[i] += factor * other.sums_[i];
}

}  // namespace lsde
