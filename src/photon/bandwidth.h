// How far to smooth: for each place the radius at which a density estimate's noise has become as small as its bias.
#pragma once

#include <span>
#include <vector>

#include "photon/block_sums.h"
#include "photon/density.h"
#include "photon/surface_extent.h"

namespace lsde {

// What estimates at photons are made from. All that it refers to outlives its users.
struct PhotonSource {
    const AnyIndex& index;
    const SurfaceExtent& extent;
    std::span<const uint16_t> groups;           // of each photon (path/path_groups.h)
    size_t groupCount = 0;                      // photons of higher groups do not take part
    double perPath = 0;                         // 1 / emitted paths
    float maxRadius = 0;                        // m, of an estimate
    bool dispersed = false;                     // some photons have a wavelength: colours are to be kept apart
    const BlockTable* blocks = nullptr;         // null: all is summed photon by photon
    ScratchPlace place = ScratchPlace::Memory;  // of what is kept of many photons

    const PhotonTreeView& photons() const {
        return std::visit([](const auto& i) -> const PhotonTreeView& { return i.tree(); }, index);
    }
};

struct BandwidthRule {
    uint32_t leastCount = 20;   // photons in the smallest radius tried
    uint32_t mostCount = 1000;  // photons in the largest, roughly
    float tolerance = 1;        // standard errors by which estimates of two radii may differ
    // Standard errors of the count within that photons which lie far denser may come to in a ring, beyond a few: where
    // copies of a path meet again by chance they are no edge.
    float denseTolerance = 0;
};

// The query at a photon's place, on the side on which it landed, with the source's largest radius.
DensityQuery queryAt(const PhotonSource& source, uint32_t photon);

// Discs of fewer photons are summed photon by photon; wider ones by blocks where they may be.
inline constexpr uint32_t kLeastOfBlocks = 256;

struct BandwidthScratch {
    DensityScratch density;         // accepted: afterwards all that lie within the bandwidth, and some more, if few
    SurfaceAround surface;          // about the photon
    ScratchList<uint32_t> touched;  // blocks
    NeighbourList blocks;           // by their first photons
    ScratchList<DensityScratch::Candidate> acceptedBlocks;
    // Records that another thread is just making: that of a place, and one of its neighbours.
    std::vector<Rgb> irradiance, neighbour;
    std::vector<Rgb> mean;  // of two records
};

// Sorts what lies within the radius of the photon, about which scratch.surface is: blocks that count as one by their
// first photons, with the distance of their centres, into scratch.acceptedBlocks, all other photons into
// scratch.density.accepted. countsAsOne(sums, distance of the centre) is asked of blocks whose photons are alike.
// False, and nothing is done: there is no table.
template <typename CountsAsOne>
bool acceptByBlocks(const PhotonSource& source, uint32_t photon, const DensityQuery& query, float radius,
                    BandwidthScratch& scratch, const CountsAsOne& countsAsOne) {
    if (source.blocks == nullptr) return false;
    // Whichever index is asked for single photons, the blocks are those of the tree.
    const KdIndex index(source.photons());
    const Vec3 centre = query.point.position;
    index.blocksWithin(centre, radius, scratch.touched);
    scratch.blocks.clear();
    scratch.density.found.clear();
    for (const uint32_t block : scratch.touched) {
        const BlockSums& sums = (*source.blocks)[block];
        const float distanceSquared = lengthSquared(sums.centre - centre);
        const bool split =
            !scratch.surface.whole() && sums.alike() && scratch.surface.creaseNear(sums.centre, sums.radius);
        // The photon's own block holds it, which does not count like the others.
        if (sums.alike() && !split && block != photon / kBlockSize && countsAsOne(sums, std::sqrt(distanceSquared)))
            scratch.blocks.push({block * kBlockSize, distanceSquared});
        else
            index.appendWithin(block, centre, radius, scratch.density.found);
    }
    // Also those whose centres lie beyond the radius and which reach into it.
    acceptPhotons(index.tree(), query, 2 * radius, scratch.blocks, scratch.acceptedBlocks);
    acceptPhotons(index.tree(), query, radius, scratch.density.found, scratch.density.accepted);
    return true;
}

// A disc; or, where light is even in one direction only, an ellipse of that direction: where the norm |x|^2 -
// (along.x)^2 of the offset from its middle is below the radius, which is its half width.
struct Bandwidth {
    float radius = 0;    // m
    uint32_t count = 0;  // photons within it
    Vec3 along{0};       // of length sqrt(1 - 1 / stretch^2)

    float stretch() const { return stretchOf(along); }      // length over width
    float length() const { return radius * stretch(); }     // m, half of it
    float area() const { return kPi * radius * length(); }  // m2
    float distance(Vec3 offset) const {
        return std::sqrt(std::max(0.0F, elongatedSquared(along, offset, lengthSquared(offset))));
    }
};

// The largest of the radii r0, sqrt(2) r0, 2 r0, ... (r0: distance to photon number leastCount) whose estimate is
// consistent with those of all smaller ones: |E_i - E_j| <= tolerance * standard error of E_i (Lepski 1991), before
// which it ends where the power in the outer ring is plainly another, photons there lie far denser, or the power within
// lies to one side. Where light is smooth the radius grows as long as it pays, at edges it stays small. The photon
// itself is left out: it is there for certain. Power is the channels' sum; of dispersed light all must hold for each
// channel, since a rainbow may be as bright throughout. A disc that ended at an edge and holds few photons grows on
// along it (photon/elongation.h).
Bandwidth consistentBandwidth(const PhotonSource& source, uint32_t photon, const BandwidthRule& rule,
                              BandwidthScratch& scratch);

}  // namespace lsde
