// A lit square for tests of bandwidths and of what is cached of them.
#pragma once

#include <array>

#include "photon/bandwidth.h"
#include "photon/photons.h"

namespace lsde::test {

inline constexpr BandwidthRule kSquareRule{20, 1000, 2.5F};  // bandwidths on squares like the one below

// Photons of even power on the square [-1, 1]^2 of the plane z = 0, `density` of them a m2 where x < 0 and as many
// times `contrast` where x > 0; every other one in group 1.
struct Square {
    PhotonTree tree;
    AnyIndex index;
    SurfaceExtent extent;
    std::vector<uint16_t> groups;
    std::array<BlockTable, 2> blocks;  // for one group, and for both

    // behind: photons a m2 that landed on the back.
    Square(uint32_t seed, float density, float contrast, float behind = 0)
        : tree(make(seed, density, contrast, behind)), index(KdIndex(view(tree))) {
        for (size_t i = 0; i < tree.count; ++i) groups.push_back(tree.payload[i].light);
        sumBlocks();
    }
    // Again, after changes to the photons.
    void sumBlocks() {
        ThreadPool pool(1);
        for (size_t i = 0; i < blocks.size(); ++i)
            blocks[i] = BlockTable(view(tree), groups, i + 1, ScratchPlace::Memory, pool);
    }
    static PhotonTree make(uint32_t seed, float density, float contrast, float behind) {
        Random random(seed);
        std::vector<Photon> photons;
        for (const float side : {-1.0F, 1.0F})
            for (uint32_t n = random.poisson(2.0 * density * (side > 0 ? contrast : 1)); n-- > 0;) {
                Photon p = photonAt({side * random.uniform(), random.between(-1, 1), 0}, random.bits());
                p.light = static_cast<uint16_t>(photons.size() % 2);
                photons.push_back(p);
            }
        if (behind > 0)
            for (uint32_t n = random.poisson(4.0 * behind); n-- > 0;) {
                Photon p = photonAt({random.between(-1, 1), random.between(-1, 1), 0}, random.bits());
                p.direction = -p.direction;
                photons.push_back(p);
            }
        return treeOf(photons);
    }
    PhotonSource source(size_t groupCount = 2, bool byBlocks = true) const {
        return {index, extent, groups, groupCount, 1, 0.5F, false, byBlocks ? &blocks[groupCount - 1] : nullptr};
    }
};

// At a point of the square, lit from that side.
inline DensityQuery queryFrom(Vec3 position, Vec3 side = {0, 0, 1}) {
    DensityQuery query;
    query.point.position = position;
    query.point.ng = query.point.ns = {0, 0, 1};
    query.sideNormal = side;
    query.maxRadius = 0.5F;
    return query;
}

}  // namespace lsde::test
