#include "photon/ledger.h"

#include <algorithm>

#include "base/error.h"

namespace lsde {

std::string_view name(LedgerColumn c) {
    constexpr std::array<std::string_view, kLedgerColumns> kNames = {"emitted",  "absorbedSurface", "absorbedVolume",
                                                                     "escaped",  "continued",       "depthCut",
                                                                     "roulette", "sampling",        "shadingNormal"};
    return kNames[static_cast<size_t>(c)];
}

Ledger::Ledger(size_t lights, size_t objects) : flux(3 * objects), emittedByLight(lights), pathsByLight(lights) {}

void Ledger::merge(const Ledger& other) {
    LSDE_ASSERT(flux.size() == other.flux.size() && emittedByLight.size() == other.emittedByLight.size());
    for (size_t i = 0; i < columns.size(); ++i) columns[i] += other.columns[i];
    for (size_t i = 0; i < flux.size(); ++i) flux[i] += other.flux[i];
    for (size_t i = 0; i < emittedByLight.size(); ++i) {
        emittedByLight[i] += other.emittedByLight[i];
        pathsByLight[i] += other.pathsByLight[i];
    }
    for (size_t i = 0; i < landed.size(); ++i) landed[i] += other.landed[i];
    shadingClamped += other.shadingClamped;
    unclassified += other.unclassified;
    maxAimWeight = std::max(maxAimWeight, other.maxAimWeight);
}

double Ledger::fluxOf(size_t photonClass) const {
    const size_t objects = flux.size() / 3;
    double sum = 0;
    for (size_t i = photonClass * objects; i < (photonClass + 1) * objects; ++i)
        for (int c = 0; c < 3; ++c) sum += flux[i].toDouble(c);
    return sum;
}

FixedRgb Ledger::balance() const {
    FixedRgb rest = (*this)[LedgerColumn::Emitted];
    for (size_t i = 1; i < columns.size(); ++i) rest -= columns[i];
    return rest;
}

}  // namespace lsde
