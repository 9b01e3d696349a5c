#include "passes/gather.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace lsde;

TEST_CASE("the largest bandwidths hold more photons where a class has more than its rule is for, fewer below") {
    const RadiusRule rule = GatherSettings().caustic;
    const auto times = [&](double factor) { return scaledTo(static_cast<uint64_t>(factor * rule.photons), rule); };
    const RadiusRule same = times(1), fewer = times(0.5), least = times(0), many = times(27);
    CHECK(same.irradiance.bandwidth.mostCount == rule.irradiance.bandwidth.mostCount);
    CHECK(same.reachAtMean == doctest::Approx(rule.reachAtMean));
    CHECK(fewer.irradiance.bandwidth.mostCount == std::lround(std::cbrt(0.25) * rule.irradiance.bandwidth.mostCount));
    CHECK(fewer.reachAtMean == doctest::Approx(std::cbrt(0.25) * rule.reachAtMean));
    CHECK(least.irradiance.bandwidth.mostCount == doctest::Approx(0.15 * rule.irradiance.bandwidth.mostCount));
    CHECK(many.irradiance.bandwidth.mostCount == doctest::Approx(9 * rule.irradiance.bandwidth.mostCount));
    CHECK(many.reachAtMean == doctest::Approx(9 * rule.reachAtMean));
    // What is not smooth is as before.
    CHECK(many.irradiance.bandwidth.leastCount == rule.irradiance.bandwidth.leastCount);
    CHECK(many.growthAtMean == rule.growthAtMean);
}
