// Where the light went: exact sums, in units of power of whole runs (divide by emitted paths for watts).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/fixed_point.h"

namespace lsde {

// emitted = the sum of all other columns, exactly.
enum class LedgerColumn : uint8_t {
    Emitted,  // power of the lights times paths
    AbsorbedSurface,
    AbsorbedVolume,
    Escaped,
    Continued,  // scattered at a Diffuse vertex where the walk ends: the camera pass goes on from there
    DepthCut,
    Roulette,       // lost - gained; zero on average
    Sampling,       // emitted - sampled at the lights, albedo - weight at surfaces, and all wavelengths - the one drawn
                    // where light disperses; zero on average
    ShadingNormal,  // lost - gained by Veach's correction for shading normals
};
inline constexpr int kLedgerColumns = 9;
std::string_view name(LedgerColumn c);

struct Ledger {
    std::array<FixedRgb, kLedgerColumns> columns;
    // Landed power by class (index of PhotonClass) and object, class-major: flux[c * objects + o]
    std::vector<FixedRgb> flux;
    std::vector<FixedRgb> emittedByLight;
    std::vector<uint64_t> pathsByLight;
    std::array<uint64_t, 3> landed{};  // photons by class, stored or not
    uint64_t shadingClamped = 0;       // |wi.Ns| / |wi.Ng| bounded at the gather: counted there; kept 0 in maps
    uint64_t unclassified = 0;         // stored photons with more than 29 events
    double maxAimWeight = 0;           // largest p_whole / p_mixture drawn

    Ledger() = default;
    Ledger(size_t lights, size_t objects);
    FixedRgb& operator[](LedgerColumn c) { return columns[static_cast<size_t>(c)]; }
    const FixedRgb& operator[](LedgerColumn c) const { return columns[static_cast<size_t>(c)]; }
    void merge(const Ledger& other);          // sums; sizes must agree
    double fluxOf(size_t photonClass) const;  // of all objects and channels
    // Emitted minus all other columns: zero, or the ledger is broken.
    FixedRgb balance() const;
};

}  // namespace lsde
