#include "passes/picture_error.h"

#include <doctest/doctest.h>

#include <cmath>

#include "pictures.h"
#include "support/random.h"
#include "support/statistics.h"

using namespace lsde;

namespace {

// Samples of a pixel: 1 and 3 by chance, so of mean 2 and variance 1.
SampleStatistics tossed(uint64_t count, test::Random& random, float photonDeviation = 0) {
    SampleStatistics s;
    for (uint64_t i = 0; i < count; ++i) s.add(i, Rgb(random.uniform() < 0.5F ? 1 : 3), photonDeviation);
    return s;
}

// Mean over the picture of the squared difference of two seeds' pictures, over what both estimate of it.
double differenceOverEstimate(const test::PictureSettings& settings, const std::string& scene) {
    const RenderResult a = test::render(scene, settings, 1), b = test::render(scene, settings, 2);
    const std::vector<float>&errorA = a.image.channels.at("error.R"), &errorB = b.image.channels.at("error.R");
    double difference = 0, estimate = 0;
    for (size_t i = 0; i < errorA.size(); ++i) {
        const Rgb both = 0.5F * (a.picture.pixels[i] + b.picture.pixels[i]);
        const double weight = 1 / (square(static_cast<double>(mean(both))) + 0.01);
        difference += weight * static_cast<double>(mean(square(a.picture.pixels[i] - b.picture.pixels[i])));
        estimate += weight * static_cast<double>(square(errorA[i]) + square(errorB[i]));
    }
    return difference / estimate;
}

}  // namespace

TEST_CASE("two parts of a pixel's samples tell the variance of its mean, whatever their numbers") {
    test::Random random(1);
    for (const uint64_t count : {2, 3, 5, 8, 13}) {
        CAPTURE(count);
        test::Mean variance;
        for (int i = 0; i < 20'000; ++i) {
            const std::vector<SampleStatistics> one{tossed(count, random)};
            const std::vector<double> counts{static_cast<double>(count)};
            variance.add(pictureError(one, counts, 1).camera[0]);
        }
        CHECK(variance.agrees(1.0 / static_cast<double>(count)));
    }
}

TEST_CASE("where pixels have one sample, others around them tell the variance") {
    constexpr int kSide = 64;
    test::Random random(1);
    std::vector<SampleStatistics> ones(kSide * kSide);
    for (SampleStatistics& s : ones) s = tossed(1, random);
    double sum = 0;
    for (const float v : pictureError(ones, std::vector<double>(ones.size(), 1.0), kSide).camera)
        sum += static_cast<double>(v);
    CHECK(sum / (kSide * kSide) == doctest::Approx(1).epsilon(0.25));
}

TEST_CASE("what photons leave of error is shared by all samples of a pixel") {
    test::Random random(1);
    const std::vector<SampleStatistics> few{tossed(4, random, 0.5F)}, many{tossed(64, random, 0.5F)};
    CHECK(pictureError(few, std::vector<double>{4.0}, 1).photons[0] == doctest::Approx(0.25));
    CHECK(pictureError(many, std::vector<double>{64.0}, 1).photons[0] == doctest::Approx(0.25));
}

TEST_CASE("relative errors are those of relMSE, and standard errors in the units of the picture") {
    RgbImage picture(2, 1);
    picture.pixels = {Rgb(0.3F), Rgb(0, 0, 2)};
    const PictureError error{{0.01F, 0.04F}, {0.001F, 0}};
    const double weight0 = 1 / (0.09 + 0.01), weight1 = (2 / 0.01 + 1 / 4.01) / 3;
    CHECK(error.relativeTo(picture).camera == doctest::Approx((0.01 * weight0 + 0.04 * weight1) / 2));
    CHECK(error.relativeTo(picture).photons == doctest::Approx(0.001 * weight0 / 2));
    const std::vector<float> errors = error.standardErrors();
    CHECK(errors[0] == doctest::Approx(std::sqrt(0.011)));
    CHECK(errors[1] == doctest::Approx(0.2));
}

TEST_CASE("pictures of two seeds differ by as much as they say") {
    CHECK(differenceOverEstimate(test::settingsFor("path", 64, 32), "cornell-small") ==
          doctest::Approx(1).epsilon(0.4));
    for (const std::string scene : {"glass-sphere-small", "pool-small", "cornell-small", "ring"}) {
        CAPTURE(scene);
        const double ratio = differenceOverEstimate(test::settingsFor("photon", 64, 16, 100'000), scene);
        // A factor of 1.4 in the root of the mean square.
        CHECK(ratio > 0.5);
        CHECK(ratio < 2);
    }
}

TEST_CASE("an error that is asked for is reached, by as many photons and samples as that takes") {
    test::PictureSettings settings = test::settingsFor("photon", 64, 1);
    settings.spp.reset();
    settings.photons.reset();
    uint64_t samples = 0, photons = 0;
    for (const double limit : {1e-2, 8e-5}) {
        settings.errorLimit = limit;
        const RenderResult r = test::render("pool-small", settings);
        CHECK(r.relativeError->total() <= limit);
        CHECK(r.samples > samples);
        CHECK(r.photons > photons);
        samples = r.samples;
        photons = r.photons;
        // By those counts it is the same picture.
        test::PictureSettings counts = settings;
        counts.errorLimit.reset();
        counts.spp = samples;
        counts.photons = photons;
        CHECK(test::render("pool-small", counts).picture.pixels == r.picture.pixels);
    }
}
