#include "image/fill.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"

namespace lsde {

namespace {

void add(float weight, const Vec4* from, Vec4* to, int count) {
    for (int i = 0; i < count; ++i) to[i] += weight * from[i];
}

// Each pixel becomes the sum of those around it, by a tent that is 0 at a distance of `reach` along x, and along y.
void spread(std::vector<Vec4>& pixels, int width, int height, int reach) {
    const auto row = [width](std::vector<Vec4>& of, int y) {
        return &of[static_cast<size_t>(y) * static_cast<size_t>(width)];
    };
    const auto weight = [reach](int d) { return static_cast<float>(reach - std::abs(d)) / static_cast<float>(reach); };
    std::vector<Vec4> along(pixels.size(), Vec4(0));
    for (int y = 0; y < height; ++y)
        for (int d = std::max(1 - reach, 1 - width); d < std::min(reach, width); ++d)
            add(weight(d), row(pixels, y) + std::max(0, d), row(along, y) + std::max(0, -d), width - std::abs(d));
    std::fill(pixels.begin(), pixels.end(), Vec4(0));
    for (int y = 0; y < height; ++y)
        for (int from = std::max(0, y - reach + 1); from < std::min(height, y + reach); ++from)
            add(weight(from - y), row(along, from), row(pixels, y), width);
}

}  // namespace

void fillUnseen(RgbImage& image, std::span<const double> samples) {
    const auto seen = std::count_if(samples.begin(), samples.end(), [](double n) { return n > 0; });
    LSDE_ASSERT(samples.size() == image.pixels.size());
    if (seen == 0) throw Error("a picture without samples, expected one pixel or more with some");
    int reach = 1;
    while (square(static_cast<double>(reach)) * static_cast<double>(seen) < static_cast<double>(samples.size()))
        reach *= 2;
    for (auto unseen = samples.size() - static_cast<size_t>(seen); unseen > 0; reach *= 2) {
        std::vector<Vec4> known(samples.size(), Vec4(0));
        for (size_t i = 0; i < samples.size(); ++i)
            if (samples[i] > 0) known[i] = Vec4(image.pixels[i], 1);
        spread(known, image.width, image.height, reach);
        unseen = 0;
        for (size_t i = 0; i < samples.size(); ++i)
            if (samples[i] == 0 && known[i].w > 0)
                image.pixels[i] = Rgb(known[i]) / known[i].w;
            else if (samples[i] == 0)
                ++unseen;
    }
}

}  // namespace lsde
