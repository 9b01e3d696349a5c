// Single light paths: where they land, what is kept of them, and where their power went.
#pragma once

#include <array>
#include <vector>

#include "photon/map_file.h"
#include "sampling/sampler.h"
#include "sampling/sobol_order.h"
#include "transport/diffuse_aim.h"
#include "transport/emission.h"

namespace lsde {

// Which photons a map holds.
enum class Store : uint8_t {
    Caustic,   // L X+ D; paths end at the first D
    Indirect,  // also light that met a D before
    All,       // also direct light
};
std::string_view name(Store store);  // "caustic", "indirect", "all"
inline bool holds(Store store, PhotonClass c) {
    return c == PhotonClass::Caustic || store == Store::All || (c == PhotonClass::Indirect && store == Store::Indirect);
}

// More paths that are not aimed at casters where light goes on from what it lights first.
inline AimShares aimSharesFor(Store store) { return store == Store::Caustic ? kAimedAtCasters : kAimedGoingOn; }

struct LightTracerInput {
    const Scene& scene;
    const EmissionSampler& sources;
    const DiffuseAim& diffuseAim;
    Store store = Store::Indirect;
    uint32_t maxDepth = 64;  // events of a path
    uint64_t seed = 0;
    float fairPower = 0;  // W: largest component of a photon's power once the light met a D, by splitting and roulette
    Stage stage = Stage::Emission;
    bool keepTrials = false;
};

// Where a path started, and how many photons it left.
struct TracedStart {
    AimTrial aim;  // its worth not yet known
    std::array<uint32_t, kPhotonClasses> photons{};
};

// Of light that left a Lambertian surface: towards casters (aimed) and by the surface's own lobe.
struct AfterDiffuse {
    uint64_t rays = 0, aimedRays = 0;  // and of what followed
    uint64_t bounces = 0, aimedBounces = 0;
    uint64_t escaped = 0;  // of bounces
    // Expected paths of the lobes alone: all, from where a caster's cone is seen, and into the cones.
    double lobePaths = 0, seeingPaths = 0, inCones = 0;

    AfterDiffuse& operator+=(const AfterDiffuse& other);
};

inline constexpr uint32_t kNoTrial = ~0U;

// What some paths came to, merged by sums that do not depend on the order.
struct LightPaths {
    std::array<std::vector<PackedPhoton>, kPhotonClasses> photons;
    Ledger ledger;
    uint64_t rays = 0;
    AfterDiffuse afterDiffuse;
    // If trials are kept: of each path, of each that was aimed from a diffuse surface (of no worth yet), and which of
    // these each indirect photon followed, since it last met a D, over a bend (or kNoTrial).
    std::vector<TracedStart> starts;
    std::vector<DiffuseAim::Trial> diffuseAims;
    std::vector<uint32_t> aimedBy;
};

// Paths of the emission, in the order in which they are traced: those numbered [from, to) along a block that starts at
// path `start`.
struct PathRun {
    uint64_t start = 0;
    SobolOrder order;
    uint64_t from = 0, to = 0;
};
// So many paths from `begin` on, in their own order.
inline PathRun pathsInOrder(uint64_t begin, uint64_t count) { return {begin, {}, 0, count}; }

LightPaths traceLightPaths(const LightTracerInput& input, const PathRun& paths);

}  // namespace lsde
