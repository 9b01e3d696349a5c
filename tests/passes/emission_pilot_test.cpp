#include "passes/emission_pilot.h"

#include <doctest/doctest.h>

#include "scene/gltf.h"

using namespace lsde;

namespace {

struct Emitted {
    double photons = 0, flux = 0;  // caustic; of each path, and W
};

Emitted emitCaustics(const Scene& scene, bool learn) {
    constexpr uint64_t kPaths = 100'000;
    ThreadPool pool;
    EmissionSampler sources(scene, scene.lightSelection({}), kAimedAtCasters);
    const DiffuseAim none(scene, 0);
    const LightTracerInput input{scene, sources, none, Store::Caustic};
    if (learn) sources.learn(tryAims(input, pool).starts);
    const LightPaths paths = traceLightPaths(input, pathsInOrder(0, kPaths));
    constexpr auto kCaustic = static_cast<size_t>(PhotonClass::Caustic);
    return {static_cast<double>(paths.photons[kCaustic].size()) / kPaths, paths.ledger.fluxOf(kCaustic) / kPaths};
}

}  // namespace

TEST_CASE("what misses its caster is emitted less once that is known, and the flux stays") {
    // Of a flat water's bounding sphere most is not water.
    const Scene pool(loadGltf(LSDE_SCENES "/pool-small.glb"));
    const Emitted before = emitCaustics(pool, false), after = emitCaustics(pool, true);
    CHECK(after.photons > 1.2 * before.photons);
    CHECK(after.flux == doctest::Approx(before.flux).epsilon(0.01));
}

TEST_CASE("of what a diffuse surface aims at a caster more lands again once it is known how, and the flux stays") {
    // What goes through the ball leaves it upwards, where nothing is; what it reflects lands on the floor.
    const Scene scene(loadGltf(LSDE_SCENES "/glass-sphere-small.glb"));
    const EmissionSampler sources(scene, scene.lightSelection({}), kAimedGoingOn);
    DiffuseAim aim(scene, kPilotDiffuseBoost);
    LightTracerInput input{scene, sources, aim};
    input.fairPower = sources.fairPower();
    ThreadPool pool;
    const auto indirect = [&]() -> Emitted {
        const LightPaths paths = traceLightPaths(input, pathsInOrder(0, 400'000));
        constexpr auto kIndirect = static_cast<size_t>(PhotonClass::Indirect);
        return {static_cast<double>(paths.photons[kIndirect].size()), paths.ledger.fluxOf(kIndirect)};
    };
    const Emitted before = indirect();
    aim.learn(tryAims(input, pool).afterDiffuse);
    const Emitted after = indirect();
    CHECK(after.photons > 1.5 * before.photons);
    CHECK(after.flux == doctest::Approx(before.flux).epsilon(0.02));
}
