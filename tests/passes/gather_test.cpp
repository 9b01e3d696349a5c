#include "passes/gather.h"

#include <doctest/doctest.h>

using namespace lsde;

TEST_CASE("the largest bandwidths hold more photons where a class has more than its rule is for, and no fewer below") {
    const RadiusRule rule = GatherSettings().caustic;
    const RadiusRule few = grown(rule, 1000), many = grown(rule, static_cast<uint64_t>(27 * rule.photons));
    CHECK(few.irradiance.bandwidth.mostCount == rule.irradiance.bandwidth.mostCount);
    CHECK(few.reachAtMean == rule.reachAtMean);
    CHECK(many.irradiance.bandwidth.mostCount == doctest::Approx(9 * rule.irradiance.bandwidth.mostCount));
    CHECK(many.reachAtMean == doctest::Approx(9 * rule.reachAtMean));
    // What is not smooth is as before.
    CHECK(many.irradiance.bandwidth.leastCount == rule.irradiance.bandwidth.leastCount);
    CHECK(many.growthAtMean == rule.growthAtMean);
}
