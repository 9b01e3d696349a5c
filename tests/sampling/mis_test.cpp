#include "sampling/mis.h"

#include <doctest/doctest.h>

#include <initializer_list>
#include <limits>

using namespace lsde;

TEST_CASE("the power heuristic's weights of two techniques add up to one") {
    for (const float a : {1e-20F, 0.3F, 1.0F, 7.0F, 1e20F})
        for (const float b : {1e-20F, 0.3F, 1.0F, 7.0F, 1e20F})
            CHECK(powerHeuristic(a, b) + powerHeuristic(b, a) == doctest::Approx(1));
    CHECK(powerHeuristic(1, 2) == doctest::Approx(0.2));
}

TEST_CASE("a technique that cannot make the sample has weight 0, the only one that can has weight 1") {
    CHECK(powerHeuristic(0, 0) == 0);
    CHECK(powerHeuristic(0, 1) == 0);
    CHECK(powerHeuristic(1e-30F, 0) == 1);
    CHECK(powerHeuristic(1, std::numeric_limits<float>::infinity()) == 0);
}
