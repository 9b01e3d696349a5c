#include "compare/ssim.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace lsde;

namespace {

Plane constant(double value, int width = 16, int height = 12) {
    Plane plane(width, height);
    for (double& v : plane.values) v = value;
    return plane;
}

}  // namespace

// Values on pictures, recorded from scikit-image, are in metrics_test.cpp.

TEST_CASE("the similarity of a plane with itself is one") {
    ThreadPool pool;
    Plane plane(20, 13);
    for (size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = static_cast<double>(i * 37 % 101) / 101;
    CHECK(structuralSimilarity(plane, plane, pool) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("the similarity of constant planes is that of their means") {
    ThreadPool pool;
    const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
    CHECK(structuralSimilarity(constant(0.25), constant(0.75), pool) == doctest::Approx(expected).epsilon(1e-12));
}

TEST_CASE("the similarity of a pattern with its negative is below zero") {
    ThreadPool pool;
    Plane plane(16, 16), negative(16, 16);
    for (size_t i = 0; i < plane.values.size(); ++i) {
        plane.values[i] = (i + i / 16) % 2 == 0 ? 0.1 : 0.9;
        negative.values[i] = 1 - plane.values[i];
    }
    CHECK(structuralSimilarity(plane, negative, pool) < -0.9);
}

TEST_CASE("no similarity is defined for planes smaller than the window") {
    ThreadPool pool;
    CHECK(std::isnan(structuralSimilarity(constant(1, 10, 50), constant(1, 10, 50), pool)));
    CHECK(std::isnan(structuralSimilarity(constant(1, 50, 10), constant(1, 50, 10), pool)));
    CHECK(structuralSimilarity(constant(1, 11, 11), constant(1, 11, 11), pool) == doctest::Approx(1));
}
