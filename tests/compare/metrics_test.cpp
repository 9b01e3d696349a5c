#include "compare/metrics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/json.h"
#include "compare/pictures.h"
#include "store/fixture.h"

using namespace lsde;

namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

Figures figuresOf(const RgbImage& image, const RgbImage& reference) {
    ThreadPool pool;
    return comparePictures(image, reference, pool).figures;
}

}  // namespace

TEST_CASE("the similarity of displayed luminance agrees with scikit-image") {
    // Recorded by record_oracles.py; the rest is this program's sRGB curve in single precision.
    const auto check = [](const RgbImage& image, const RgbImage& reference, double expected) {
        CHECK(std::abs(figuresOf(image, reference).ssim - expected) < 1e-6);
    };
    check(testPicture(40, 0.9, 0.5), testPicture(40, 0.9, 0), 0.56197451);
    check(testPicture(37, 0.9, 0), testPicture(40, 0.9, 0), 0.86564217);
    check(testPicture(40, 15, 0.5), testPicture(40, 16, 0), 0.58879272);
    check(recordedPicture("glass-sphere.a"), recordedPicture("glass-sphere"), 0.99998329);
    check(recordedPicture("cornell"), recordedPicture("pool"), 0.23681724);
}

TEST_CASE("the figures of two constant pictures are those of one pixel") {
    const Figures f = figuresOf(RgbImage(16, 16, Rgb(0.3F)), RgbImage(16, 16, Rgb(0.2F)));
    CHECK(f.mse == doctest::Approx(0.01));
    CHECK(f.relMse == doctest::Approx(0.01 / 0.05));
    CHECK(f.trimmedRelMse == doctest::Approx(f.relMse));
    CHECK(f.smape == doctest::Approx(0.1 / 0.51));
    // sRGB: 0.3 -> 0.583831, 0.2 -> 0.484529
    CHECK(f.psnr == doctest::Approx(-20 * std::log10(0.583831 - 0.484529)).epsilon(1e-5));
    CHECK(f.ssim ==
          doctest::Approx((2 * 0.583831 * 0.484529 + 1e-4) / (0.583831 * 0.583831 + 0.484529 * 0.484529 + 1e-4)));
    CHECK(f.meanRatio() == doctest::Approx(1.5));
    CHECK(f.image.mean[2] == doctest::Approx(0.3));
    CHECK(f.reference.mean[0] == doctest::Approx(0.2));
}

TEST_CASE("a picture equal to its reference has no error by any metric") {
    const RgbImage picture = testPicture(40, 16, 0.5);
    const Figures f = figuresOf(picture, picture);
    for (const Metric& metric : metrics()) {
        CAPTURE(metric.name);
        if (!metric.largerIsBetter) CHECK(f.*metric.value == 0);
    }
    CHECK(std::isinf(f.psnr));
    CHECK(f.ssim == doctest::Approx(1));
    CHECK(f.meanRatio() == 1);
}

TEST_CASE("what the screen cannot show counts in the radiometric metrics only") {
    const Figures f = figuresOf(RgbImage(16, 16, Rgb(20)), RgbImage(16, 16, Rgb(10)));
    CHECK(f.relMse > 0.9);
    CHECK(std::isinf(f.psnr));
    CHECK(f.flip == 0);
    CHECK(f.hdrFlip > 0.1);
}

TEST_CASE("values that are not finite are counted by pixels and taken as zero") {
    RgbImage image(16, 16, Rgb(0.5F));
    const RgbImage reference = image;
    image.at(2, 3) = Rgb(kNotANumber, 0.5F, kInfinity);
    image.at(4, 3) = Rgb(0.5F, -kInfinity, 0.5F);
    const Figures f = figuresOf(image, reference);
    CHECK(f.image.notFinite == 2);
    CHECK(f.reference.notFinite == 0);
    CHECK(f.mse == doctest::Approx(3 * 0.25 / (256 * 3)));
    CHECK(f.image.mean[0] == doctest::Approx(0.5 * 255 / 256));
    for (const Metric& metric : metrics()) CHECK(std::isfinite(f.*metric.value));
    CHECK(figuresOf(reference, image).reference.notFinite == 2);
}

TEST_CASE("pictures of different sizes are refused") {
    const std::string error = test::errorOf([] { figuresOf(RgbImage(4, 5), RgbImage(8, 10)); });
    CHECK(error.find("4x5") != std::string::npos);
    CHECK(error.find("8x10") != std::string::npos);
    CHECK_FALSE(test::errorOf([] { figuresOf(RgbImage(), RgbImage()); }).empty());
}

TEST_CASE("metrics are found by their id in any case") {
    for (const Metric& metric : metrics()) CHECK(findMetric(metric.id) == &metric);
    CHECK(findMetric("RelMSE") == findMetric("relmse"));
    CHECK(findMetric("relms") == nullptr);
    CHECK(findMetric("relmse2") == nullptr);
    CHECK(findMetric("") == nullptr);
}

TEST_CASE("figures that no number in JSON can hold become null") {
    const nlohmann::json j = toJson(figuresOf(RgbImage(4, 4), RgbImage(4, 4)));
    CHECK(j.at("metrics").at("psnr").is_null());  // infinite
    CHECK(j.at("metrics").at("ssim").is_null());  // smaller than the window
    CHECK(j.at("mean").at("ratio").is_null());    // 0/0
    CHECK(j.at("metrics").at("mse") == 0);
}
