#include "compare/plane.h"

#include <doctest/doctest.h>

#include <numeric>

using namespace lsde;

namespace {

Plane ramp(int width, int height) {
    Plane plane(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) plane.row(y)[static_cast<size_t>(x)] = 10 * y + x;
    return plane;
}

}  // namespace

TEST_CASE("a filter weighs the neighbours in their order and repeats the border") {
    ThreadPool pool;
    const std::vector<double> kernel{1, 10, 100};
    const Plane rows = filterRows(ramp(3, 2), kernel, pool);
    CHECK(rows.values == std::vector<double>{0 + 0 + 100, 0 + 10 + 200, 1 + 20 + 200,  //
                                             10 + 100 + 1100, 10 + 110 + 1200, 11 + 120 + 1200});
    const Plane columns = filterColumns(ramp(1, 3), kernel, pool);
    CHECK(columns.values == std::vector<double>{0 + 0 + 1000, 0 + 100 + 2000, 10 + 200 + 2000});
}

TEST_CASE("a filter wider than the picture sees its border only") {
    ThreadPool pool;
    const std::vector<double> kernel(21, 1.0);
    CHECK(filterRows(ramp(2, 1), kernel, pool).values == std::vector<double>{10, 11});
    CHECK(filterColumns(ramp(2, 1), kernel, pool).values == std::vector<double>{0, 21});
}

TEST_CASE("a Gaussian kernel is symmetric and sums to one") {
    const auto kernel = gaussianKernel(1.5, 5);
    REQUIRE(kernel.size() == 11);
    CHECK(std::accumulate(kernel.begin(), kernel.end(), 0.0) == doctest::Approx(1).epsilon(1e-15));
    for (size_t i = 0; i < 5; ++i) CHECK(kernel[i] == kernel[10 - i]);
    CHECK(kernel[6] / kernel[5] == doctest::Approx(0.800737).epsilon(1e-6));  // exp(-1 / 4.5)
}
