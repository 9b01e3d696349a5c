#include "passes/gather.h"

#include <doctest/doctest.h>

using namespace lsde;

TEST_CASE("the largest bandwidths hold more photons where a class has more than a million, and no fewer below") {
    const RadiusRule rule = GatherSettings().caustic;
    const RadiusRule few = grown(rule, 1000), many = grown(rule, 27'000'000);
    CHECK(few.irradiance.bandwidth.mostCount == rule.irradiance.bandwidth.mostCount);
    CHECK(few.reachAtMean == rule.reachAtMean);
    CHECK(many.irradiance.bandwidth.mostCount == doctest::Approx(9 * rule.irradiance.bandwidth.mostCount));
    CHECK(many.reachAtMean == doctest::Approx(9 * rule.reachAtMean));
    // What is not smooth is as before.
    CHECK(many.irradiance.bandwidth.leastCount == rule.irradiance.bandwidth.leastCount);
    CHECK(many.growthAtMean == rule.growthAtMean);
}
