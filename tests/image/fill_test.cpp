#include "image/fill.h"

#include <doctest/doctest.h>

using namespace lsde;

namespace {

// Every `spacing`-th pixel of each row and column is seen, and shows what f(x, y) says.
template <typename Shown>
RgbImage filled(int width, int height, int spacing, const Shown& f) {
    RgbImage image(width, height, Rgb(-1));
    std::vector<double> samples;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool seen = x % spacing == 0 && y % spacing == 0;
            if (seen) image.at(x, y) = f(x, y);
            samples.push_back(seen ? 1 : 0);
        }
    fillUnseen(image, samples);
    return image;
}

}  // namespace

TEST_CASE("between the seen pixels of a lattice the picture is linear") {
    const auto ramp = [](int x, int y) { return Rgb(x, 2 * y, 3 * x - y); };
    for (const int spacing : {1, 2, 4, 8}) {
        CAPTURE(spacing);
        const RgbImage image = filled(33, 25, spacing, ramp);
        for (int y = 0; y < 25; ++y)
            for (int x = 0; x < 33; ++x)
                for (int c = 0; c < 3; ++c)
                    REQUIRE(image.at(x, y)[c] == doctest::Approx(ramp(x, y)[c]).scale(1).epsilon(1e-5));
    }
}

TEST_CASE("beyond them it goes on, however far that is") {
    const RgbImage image = filled(40, 3, 64, [](int, int) { return Rgb(1, 2, 3); });
    for (const Rgb& pixel : image.pixels)
        for (int c = 0; c < 3; ++c) REQUIRE(pixel[c] == doctest::Approx(1 + c));
}

TEST_CASE("what is seen stays as it is") {
    const auto any = [](int x, int y) { return Rgb(0.1F + static_cast<float>(x * 7 % 5), 0, y % 3); };
    const RgbImage image = filled(9, 5, 2, any);
    for (int y = 0; y < 5; y += 2)
        for (int x = 0; x < 9; x += 2) CHECK(image.at(x, y) == any(x, y));
}
