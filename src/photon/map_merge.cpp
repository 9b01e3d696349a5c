#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "photon/map_file.h"

namespace lsde {

namespace {

struct NamedMap {
    std::string name;  // for messages
    PhotonMap map;
};

template <typename T>
void requireEqual(const NamedMap& a, const NamedMap& b, std::string_view field, const T& valueA, const T& valueB) {
    if (valueA != valueB)
        throw Error(
            fmt::format("{} and {} do not belong together: {} {}, and {}", a.name, b.name, field, valueA, valueB));
}

void requireEqualNames(const NamedMap& a, const NamedMap& b, std::string_view field,
                       const std::vector<std::string>& namesA, const std::vector<std::string>& namesB) {
    requireEqual(a, b, fmt::format("number of {}s", field), namesA.size(), namesB.size());
    for (size_t i = 0; i < namesA.size(); ++i) requireEqual(a, b, fmt::format("{} {}", field, i), namesA[i], namesB[i]);
}

void requireSameEmission(const NamedMap& a, const NamedMap& b) {
    const MapHeader &x = a.map.header, &y = b.map.header;
    requireEqual(a, b, "scene", x.sceneHash, y.sceneHash);
    requireEqual(a, b, "units", x.units, y.units);
    requireEqual(a, b, "seed", x.seed, y.seed);
    requireEqual(a, b, "paths of the whole emission", x.totalPaths, y.totalPaths);
    requireEqual(a, b, "maximal depth", x.maxDepth, y.maxDepth);
    requireEqual(a, b, "store", x.store, y.store);
    requireEqual(a, b, "aimed", x.aimed, y.aimed);
    requireEqualNames(a, b, "light", x.lights, y.lights);
    requireEqualNames(a, b, "object", x.objects, y.objects);
    for (int c = 0; c < kPhotonClasses; ++c) {
        const auto photonClass = static_cast<PhotonClass>(c);
        requireEqual(a, b, fmt::format("class \"{}\" stored", name(photonClass)), a.map.stores(photonClass),
                     b.map.stores(photonClass));
    }
}

std::vector<IndexRange> joinRanges(std::span<const NamedMap> maps) {
    struct Owned {
        IndexRange range;
        const NamedMap* map;
    };
    std::vector<Owned> all;
    for (const NamedMap& m : maps)
        for (const IndexRange& r : m.map.header.ranges) all.push_back({r, &m});
    std::sort(all.begin(), all.end(), [](const Owned& a, const Owned& b) { return a.range.begin < b.range.begin; });
    std::vector<IndexRange> joined;
    for (size_t i = 0; i < all.size(); ++i) {
        const auto [begin, end] = all[i].range;
        if (i > 0 && begin < all[i - 1].range.end)
            throw Error(fmt::format("{} and {} overlap: both hold light path {}", all[i - 1].map->name,
                                    all[i].map->name, begin));
        if (!joined.empty() && joined.back().end == begin)
            joined.back().end = end;
        else
            joined.push_back({begin, end});
    }
    return joined;
}

// Takes one class's photons out of all maps; their own trees are freed one by one.
PhotonTree mergeTrees(PhotonClass c, std::span<NamedMap> maps, ThreadPool& pool) {
    std::vector<PackedPhoton> photons;
    uint64_t count = 0;
    for (const NamedMap& m : maps) count += m.map.photons(c).count;
    photons.reserve(count);
    for (NamedMap& m : maps) {
        const PhotonTreeView tree = m.map.photons(c);
        for (uint64_t i = 0; i < tree.count; ++i)
            photons.push_back({tree.position(static_cast<uint32_t>(i)), tree.payload[i]});
        m.map.setTree(c, {});
    }
    return buildPhotonTree(std::move(photons), pool);
}

PhotonMap merge(std::vector<NamedMap> maps, RunContext& run) {
    for (size_t i = 1; i < maps.size(); ++i) requireSameEmission(maps[0], maps[i]);
    PhotonMap merged;
    merged.header = maps[0].map.header;
    merged.header.ranges = joinRanges(maps);
    for (size_t i = 1; i < maps.size(); ++i) {
        const MapHeader& header = maps[i].map.header;
        merged.header.ledger.merge(header.ledger);
        for (size_t c = 0; c < kPhotonClasses; ++c)
            merged.header.dispersion[c] = larger(merged.header.dispersion[c], header.dispersion[c]);
    }
    for (int c = 0; c < kPhotonClasses; ++c) {
        const auto photonClass = static_cast<PhotonClass>(c);
        if (!maps[0].map.stores(photonClass)) continue;
        run.checkInterrupt();
        merged.setTree(photonClass, mergeTrees(photonClass, maps, run.pool));
    }
    return merged;
}

}  // namespace

PhotonMap mergePhotonMaps(const std::vector<std::filesystem::path>& files, RunContext& run) {
    if (files.empty()) throw Error("merge: no maps, expected one or more");
    std::vector<NamedMap> maps;
    maps.reserve(files.size());
    for (const auto& file : files) maps.push_back({file.string(), readPhotonMap(file, run)});
    return merge(std::move(maps), run);
}

PhotonMap mergePhotonMaps(PhotonMap a, PhotonMap b, RunContext& run) {
    std::vector<NamedMap> maps;
    maps.push_back({"the first map", std::move(a)});
    maps.push_back({"the second map", std::move(b)});
    return merge(std::move(maps), run);
}

}  // namespace lsde
