// Sums of samples for every pixel and layer.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/math.h"
#include "image/image.h"

namespace lsde {

// Layer 0 is the full picture; the others by index. Each pixel is written by one thread at a time, samples in the order
// of their numbers, in double precision: so a picture made in several passes has the bytes of one made in one.
class Film {
  public:
    Film(int width, int height, std::vector<std::string> layerNames);  // layerNames[0] is ""

    int width() const { return width_; }
    int height() const { return height_; }
    int layers() const { return static_cast<int>(names_.size()); }
    const std::string& layerName(int layer) const { return names_[static_cast<size_t>(layer)]; }

    void add(int x, int y, int layer, Rgb value);
    // Divides by the number of samples each pixel has had, and fills those that had none. Throws Error naming layer and
    // pixel if the mean is not finite.
    RgbImage develop(int layer, double samples) const;
    RgbImage develop(int layer, std::span<const double> samples) const;  // of each pixel, row by row
    // Adds the other film's sums times a factor (progressive passes).
    void accumulate(const Film& other, double factor);

  private:
    size_t index(int x, int y, int layer) const;  // of the pixel's first sum

    int width_, height_;
    std::vector<std::string> names_;
    std::vector<double> sums_;  // [layer][y][x][c]
};

}  // namespace lsde
