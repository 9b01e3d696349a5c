#include "image/film.h"

#include <doctest/doctest.h>

#include <limits>

#include "store/fixture.h"

using namespace lsde;

TEST_CASE("a film develops the mean of each pixel and layer") {
    Film film(3, 2, {"", "caustic"});
    CHECK(film.layers() == 2);
    CHECK(film.layerName(1) == "caustic");
    film.add(2, 1, 1, Rgb(1, 2, 3));
    film.add(2, 1, 1, Rgb(3, 2, 1));
    film.add(0, 0, 0, Rgb(8));
    RgbImage expected(3, 2);
    expected.at(2, 1) = Rgb(1, 1, 1);
    CHECK(film.develop(1, 4).pixels == expected.pixels);
    expected = RgbImage(3, 2);
    expected.at(0, 0) = Rgb(2);
    CHECK(film.develop(0, 4).pixels == expected.pixels);
}

TEST_CASE("a film loses no small sample beside a bright one") {
    Film film(1, 1, {""});
    film.add(0, 0, 0, Rgb(1e6F));
    constexpr int kSamples = 1 << 20;
    for (int i = 1; i < kSamples; ++i) film.add(0, 0, 0, Rgb(1e-3F));
    const double expected = (1e6 + (kSamples - 1) * static_cast<double>(1e-3F)) / kSamples;
    CHECK(film.develop(0, kSamples).at(0, 0).x == doctest::Approx(expected).epsilon(1e-7));
}

TEST_CASE("films made in passes add up to the film made in one") {
    Film whole(2, 1, {"", "direct"});
    Film first = whole;
    Film second = whole;
    for (int i = 0; i < 10; ++i)
        for (int x = 0; x < 2; ++x) {
            const Rgb value(0.25F * static_cast<float>(i), static_cast<float>(x), 1);
            whole.add(x, 0, 1, value);
            (i < 4 ? first : second).add(x, 0, 1, value);
        }
    first.accumulate(second, 1);
    CHECK(first.develop(1, 10).pixels == whole.develop(1, 10).pixels);
    first.accumulate(whole, -0.5);
    CHECK(first.develop(1, 5).pixels == whole.develop(1, 10).pixels);
}

TEST_CASE("a sum that is not finite is refused by layer and pixel") {
    Film film(4, 3, {"", "caustic"});
    film.add(3, 1, 1, Rgb(1, std::numeric_limits<float>::quiet_NaN(), 2));
    film.develop(0, 1);
    CHECK(test::errorOf([&] { film.develop(1, 2); }) ==
          "layer \"caustic\": pixel (3, 1) is (0.5, nan, 1), expected finite values");
    CHECK(test::errorOf([&] { film.develop(0, 0); }) ==
          "a picture without samples, expected one pixel or more with some");
}
