// The emission pass: light paths from every source, their hits kept as a photon map.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/run.h"
#include "passes/light_tracer.h"
#include "photon/map_file.h"
#include "scene/scene.h"
#include "transport/emission.h"

namespace lsde {

struct EmitSettings {
    uint64_t photons = 1000000;  // light paths of the whole emission, over all shards
    uint32_t maxDepth = 64;      // events of a path
    Store store = Store::Indirect;
    bool aim = true;
    std::vector<std::string> lights;  // by name; empty: all
    // Paths of this run: [begin, end) of the whole emission's.
    IndexRange range{0, 0};  // end 0: all
};

// Paths of shard i of n (i from 1).
IndexRange shardRange(uint64_t photons, uint64_t i, uint64_t n);

// An emission that can go on: paths in order, photons and ledger so far.
class Emission {
  public:
    Emission(const Scene& scene, const EmitSettings& settings, RunContext& run);
    Emission(const Emission&) = delete;  // the tracer's input refers to the sources
    Emission& operator=(const Emission&) = delete;

    // Traces the paths [next, next + count), in parallel; all are done when it returns, or none are kept (Interrupted).
    void trace(uint64_t next, uint64_t count, RunContext& run);
    // Builds the trees and fills the header. The photons are consumed. `total` is the whole emission's number of paths.
    PhotonMap finish(uint64_t total, RunContext& run);

    uint64_t traced() const { return ranges_.empty() ? 0 : ranges_.back().end - ranges_.front().begin; }
    uint64_t stored(PhotonClass c) const { return photons_[static_cast<size_t>(c)].size(); }
    const Ledger& ledger() const { return ledger_; }

  private:
    const Scene& scene_;
    EmitSettings settings_;
    uint64_t seed_;
    EmissionSampler sources_;
    DiffuseAim diffuseAim_;
    LightTracerInput tracer_;
    std::array<std::vector<PackedPhoton>, kPhotonClasses> photons_;
    Ledger ledger_;
    std::array<Dispersion, kPhotonClasses> dispersion_;
    std::vector<IndexRange> ranges_;
};

// The whole pass: a map of settings.range. If the user interrupts, the map of what was finished is returned and
// `interrupted` set: its ranges say how far it got.
PhotonMap emitPhotons(const Scene& scene, const EmitSettings& settings, RunContext& run, bool* interrupted = nullptr);

}  // namespace lsde
