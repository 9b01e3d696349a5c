// Photon maps: sections by class, and the header that says what they are. In memory or mapped from an .lsmap file.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/fixed_point.h"
#include "base/run.h"
#include "base/scratch_array.h"
#include "photon/dispersion.h"
#include "photon/kd_index.h"
#include "photon/ledger.h"

namespace lsde {

// Of the file's format: sections, records and header.
inline constexpr uint32_t kMapVersion = 4;

enum class PhotonClass : uint8_t { Caustic = 0, Indirect = 1, Direct = 2 };
inline constexpr int kPhotonClasses = 3;
std::string_view name(PhotonClass c);  // "caustic", "indirect", "direct"

struct IndexRange {
    uint64_t begin = 0, end = 0;  // path indices [begin, end)
    friend bool operator==(const IndexRange&, const IndexRange&) = default;
};

// What a map says of itself; JSON in the file. Two maps merge if everything down to `ranges` is equal.
struct MapHeader {
    std::string sceneHash;  // 32 hexadecimal digits
    std::string units = "W, m, linear Rec. 709";
    uint64_t seed = 0;
    uint64_t totalPaths = 0;  // of the whole emission, over all shards
    uint32_t maxDepth = 0;
    std::string store;  // "caustic", "indirect" (and caustic) or "all"
    bool aimed = true;
    std::vector<std::string> lights;   // names, index = Photon::light
    std::vector<std::string> objects;  // names, index = ledger's object
    std::array<Dispersion, kPhotonClasses> dispersion;
    std::vector<IndexRange> ranges;  // sorted, disjoint, adjacent ones joined
    Ledger ledger;                   // sums over the ranges' paths
    uint64_t emittedPaths() const;   // number of indices in ranges
};

class PhotonMap {
  public:
    PhotonMap() = default;  // empty
    MapHeader header;
    // Empty view for a class that is not stored.
    PhotonTreeView photons(PhotonClass c) const;
    bool stores(PhotonClass c) const;
    void setTree(PhotonClass c, PhotonTree tree);  // owned
    // Of what is worked out for each photon: like the map itself, which may be larger than memory.
    ScratchPlace scratchPlace() const { return mapping_ ? ScratchPlace::File : ScratchPlace::Memory; }
    void expectLookups() const;  // no longer from one end to the other (MappedFile)

    // keeps a mapped file alive
    struct Mapping;

  private:
    friend PhotonMap readPhotonMap(const std::filesystem::path&, RunContext&, bool);
    std::shared_ptr<const Mapping> mapping_;  // shared by copies of the map, which borrow the same file
    std::array<std::shared_ptr<const PhotonTree>, kPhotonClasses> trees_;
    std::array<PhotonTreeView, kPhotonClasses> views_;
    std::array<bool, kPhotonClasses> stored_{};
};

// Atomic; same map, same bytes. At most 40 bytes a photon.
void writePhotonMap(const std::filesystem::path& path, const PhotonMap& map, RunContext& run);

// Maps the file. Checks the container's header and tables, all checksums (unless verifyAll is off), and that the
// content is a map that emission can have made: the header's JSON, counts against sizes, every record, and the trees
// box by box. Throws Error naming section and record. Nothing in a map that was accepted leads a query out of its
// memory.
PhotonMap readPhotonMap(const std::filesystem::path& path, RunContext& run, bool verifyAll = true);

// One map from shards, in any order: the bytes of the one emission. Throws Error naming what differs (scene, seed,
// paths, units, lights, settings) or which ranges overlap.
PhotonMap mergePhotonMaps(const std::vector<std::filesystem::path>& files, RunContext& run);
PhotonMap mergePhotonMaps(PhotonMap a, PhotonMap b, RunContext& run);

}  // namespace lsde
