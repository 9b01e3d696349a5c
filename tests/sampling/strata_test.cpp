#include "sampling/strata.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace lsde;

namespace {

std::vector<LightNumbers> strata(LightNumbers u, uint32_t count) {
    std::vector<LightNumbers> all;
    for (uint32_t i = 0; i < count; ++i) all.push_back(lightStratum(u, i, count));
    return all;
}

// How many points lie in each cell of a grid over the unit square.
std::vector<int> cellsOf(const std::vector<LightNumbers>& points, int side) {
    std::vector<int> counts(static_cast<size_t>(side * side));
    for (const LightNumbers& p : points)
        ++counts[static_cast<size_t>(static_cast<int>(p.on.y * static_cast<float>(side)) * side) +
                 static_cast<size_t>(p.on.x * static_cast<float>(side))];
    return counts;
}

}  // namespace

TEST_CASE("a single light sample is the point itself") {
    const LightNumbers only = lightStratum({0.3F, {0.7F, 0.2F}}, 0, 1);
    CHECK(only.which == 0.3F);
    CHECK(only.on == Vec2(0.7F, 0.2F));
}

TEST_CASE("light samples of a vertex share out the unit square, at the same place of each cell") {
    for (const int side : {2, 4, 8}) {
        const auto points = strata({0.3F, {0.75F, 0.25F}}, static_cast<uint32_t>(side * side));
        CHECK(cellsOf(points, side) == std::vector<int>(points.size(), 1));
        for (const LightNumbers& p : points) {
            const Vec2 inCell = p.on * static_cast<float>(side) - glm::floor(p.on * static_cast<float>(side));
            CHECK(inCell == Vec2(0.75F, 0.25F));
        }
    }
}

TEST_CASE("light samples choose their lights evenly, and each quarter of the choice is spread over its light") {
    for (const uint32_t count : {4U, 16U, 64U}) {
        auto points = strata({0.99F, Vec2(0.5F)}, count);
        std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.which < b.which; });
        for (uint32_t i = 0; i < count; ++i) {
            CHECK(points[i].which >= static_cast<float>(i) / static_cast<float>(count));
            CHECK(points[i].which < static_cast<float>(i + 1) / static_cast<float>(count));
        }
    }
    const auto points = strata({0, Vec2(0.5F)}, 16);
    for (size_t quarter = 0; quarter < 4; ++quarter) {
        const auto first = points.begin() + static_cast<std::ptrdiff_t>(4 * quarter);
        CHECK(cellsOf({first, first + 4}, 2) == std::vector<int>(4, 1));
    }
}

TEST_CASE("no light sample leaves the unit cube") {
    for (const uint32_t count : {1U, 4U, 16U, 64U})
        for (const LightNumbers& p : strata({kOneMinusEpsilon, Vec2(kOneMinusEpsilon)}, count)) {
            CHECK(p.which < 1);
            CHECK(p.on.x < 1);
            CHECK(p.on.y < 1);
        }
}
