#include "compare/flip.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "compare/pictures.h"

using namespace lsde;

namespace {

// Recorded from the wheel flip-evaluator 1.7 by record_oracles.py. It computes in single precision.
struct Recorded {
    double mean;
    double at10_7;  // of the pixel x = 10, y = 7
    double largest;
};
constexpr double kMeanTolerance = 5e-6;
constexpr double kPixelTolerance = 2e-4;

void checkMap(const Plane& map, const Recorded& expected) {
    CHECK(std::abs(mean(map) - expected.mean) < kMeanTolerance);
    CHECK(std::abs(map.row(7)[10] - expected.at10_7) < kPixelTolerance);
    CHECK(std::abs(*std::max_element(map.values.begin(), map.values.end()) - expected.largest) < kPixelTolerance);
}

void checkPair(const RgbImage& image, const RgbImage& reference, const Recorded& ldr, const Recorded& hdr,
               const ExposureRange& exposures) {
    ThreadPool pool;
    checkMap(ldrFlip(image, reference, pool), ldr);
    const ExposureRange range = flipExposures(reference);
    CHECK(std::abs(range.start - exposures.start) < 1e-5);
    CHECK(std::abs(range.stop - exposures.stop) < 1e-5);
    CHECK(range.count == exposures.count);
    checkMap(hdrFlip(image, reference, range, pool), hdr);
}

}  // namespace

TEST_CASE("FLIP of noise agrees with the authors' program") {
    checkPair(testPicture(40, 0.9, 0.5), testPicture(40, 0.9, 0), {0.1272747, 0.102396, 0.371401},
              {0.0796651, 0.124542, 0.240629}, {1.235300, 2.049291, 2});
}

TEST_CASE("FLIP of an edge that moved agrees with the authors' program") {
    checkPair(testPicture(37, 0.9, 0), testPicture(40, 0.9, 0), {0.0503306, 0, 0.688909}, {0.0273130, 0, 0.400350},
              {1.235300, 2.049291, 2});
}

TEST_CASE("FLIP of values beyond the screen's white agrees with the authors' program") {
    checkPair(testPicture(40, 15, 0.5), testPicture(40, 16, 0), {0.1180615, 0.102396, 0.371401},
              {0.1048344, 0.128679, 0.256485}, {-2.916703, 2.049291, 5});
}

TEST_CASE("FLIP of two renderings agrees with the authors' program") {
    checkPair(recordedPicture("glass-sphere.a"), recordedPicture("glass-sphere"), {0.0010345, 0, 0.009608},
              {0.0016768, 0, 0.025942}, {-0.730965, 4.514328, 6});
}

TEST_CASE("FLIP of two different scenes agrees with the authors' program") {
    checkPair(recordedPicture("cornell"), recordedPicture("pool"), {0.6822810, 0.831355, 0.979814},
              {0.7921847, 0.933836, 0.989405}, {1.840310, 2.735440, 2});
}

TEST_CASE("FLIP of a picture with itself is zero everywhere") {
    ThreadPool pool;
    const RgbImage picture = testPicture(40, 16, 0.5);
    for (const Plane& map : {ldrFlip(picture, picture, pool), hdrFlip(picture, picture, flipExposures(picture), pool)})
        CHECK(std::all_of(map.values.begin(), map.values.end(), [](double e) { return e == 0; }));
}

TEST_CASE("FLIP does not depend on the number of threads") {
    ThreadPool one(1);
    ThreadPool four(4);
    const RgbImage image = testPicture(37, 16, 0.5);
    const RgbImage reference = testPicture(40, 16, 0);
    const ExposureRange range = flipExposures(reference);
    CHECK(hdrFlip(image, reference, range, one).values == hdrFlip(image, reference, range, four).values);
}

TEST_CASE("a small error costs less FLIP seen from further away") {
    ThreadPool pool;
    const RgbImage image = testPicture(40, 0.9, 0.5);
    const RgbImage reference = testPicture(40, 0.9, 0);
    CHECK(mean(ldrFlip(image, reference, pool, 120)) < mean(ldrFlip(image, reference, pool, 30)));
}

TEST_CASE("the exposures of a reference that is mostly or all black are finite") {
    RgbImage reference(9, 9);
    const ExposureRange black = flipExposures(reference);
    CHECK(black.start == 0);
    CHECK(black.stop == 0);

    reference.at(3, 3) = Rgb(2);
    reference.at(4, 4) = Rgb(8);
    reference.at(5, 5) = Rgb(4);
    const ExposureRange range = flipExposures(reference);
    CHECK(range.stop - range.start == doctest::Approx(1));  // log2(8 / 4)
    CHECK(range.count == 2);

    ThreadPool pool;
    const Plane map = hdrFlip(RgbImage(9, 9, Rgb(1)), RgbImage(9, 9), black, pool);
    CHECK(std::all_of(map.values.begin(), map.values.end(), [](double e) { return e > 0.5 && e <= 1; }));
}
