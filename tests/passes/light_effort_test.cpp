// Where pixels take many samples of the lights, and that these are weighed right.
#include "passes/light_effort.h"

#include <doctest/doctest.h>

#include "passes/pictures.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

constexpr int kSize = 64;

// A floor under a lamp 3 m above it, whose left half is dark behind a board half way up: its penumbra reaches .4 m to
// both sides.
SceneBuilder halfShadow() {
    SceneBuilder scene;
    scene.add(plate({0, 0, 0}, 4), lambert(Rgb(0.5F)));
    scene.add(quad({-3, 1.5F, 3}, {0, 1.5F, 3}, {0, 1.5F, -3}, {-3, 1.5F, -3}), lambert(Rgb(0.5F)));
    scene.add(plate({0, 3, 0}, 0.4F, false), emitter(Rgb(10)));
    return scene;
}
// The camera sees 1 m of the floor to each side.
std::unique_ptr<Scene> seenFromAbove() {
    SceneBuilder scene = halfShadow();
    scene.camera({0, 1, 0.001F}, {0, 0, 0}, 90);
    return scene.build();
}

std::vector<uint8_t> planOf(const Scene& scene) {
    const Camera camera(scene.camera(""), kSize, kSize);
    RunContext run(2, 1);
    return planLightSamples(scene, camera, LightSampler(scene, allLights(scene)), run);
}

// Of the columns [x0, x1).
struct Range {
    uint8_t least = 255, most = 0;
};
Range rangeOf(const std::vector<uint8_t>& plan, size_t x0, size_t x1) {
    Range range;
    for (size_t i = 0; i < plan.size(); ++i) {
        if (i % kSize < x0 || i % kSize >= x1) continue;
        range.least = std::min(range.least, plan[i]);
        range.most = std::max(range.most, plan[i]);
    }
    return range;
}

}  // namespace

TEST_CASE("many samples of a lamp where it is partly seen, few in its full light and in the dark") {
    const auto plan = planOf(*seenFromAbove());
    REQUIRE(plan.size() == kSize * kSize);
    CHECK(rangeOf(plan, 24, 40).least == kManyLightSamples);
    CHECK(rangeOf(plan, 0, 10).most == kFewLightSamples);
    CHECK(rangeOf(plan, 56, 64).most == kFewLightSamples);
}

TEST_CASE("a penumbra seen through glass is one as well") {
    SceneBuilder scene = halfShadow();
    scene.add(box({-1, 0.5F, 2.5F}, {1, 1.2F, 2.55F}), glass(1.5F));
    scene.camera({0, 1, 3}, {0, 0, 0}, 20);
    CHECK(rangeOf(planOf(*scene.build()), 24, 40).least == kManyLightSamples);
}

TEST_CASE("a lamp close to the floor is as bright by many samples as by one" * doctest::test_suite("statistics")) {
    SceneBuilder scene;
    scene.add(plate({0, 0, 0}, 4), lambert(Rgb(0.5F)));
    scene.add(plate({0, 0.2F, 0}, 0.3F, false), emitter(Rgb(1)));
    scene.add(quad({0.2F, 0, 0.3F}, {0.2F, 0, -0.3F}, {0.2F, 0.15F, -0.3F}, {0.2F, 0.15F, 0.3F}), lambert(Rgb(0.2F)));
    scene.camera({0, 0.5F, 1.5F}, {0, 0.05F, 0}, 40);
    const auto built = scene.build();
    REQUIRE(rangeOf(planOf(*built), 0, kSize).most == kManyLightSamples);
    checkAgreement(estimate(*built, settingsFor("photon", 32, 16), 8, 8, "direct"),
                   estimate(*built, settingsFor("path", 32, 256), 8, 8, "direct"), 0);
}
