// Sums over the blocks of a photon tree, by which wide discs are gone through block by block.
#pragma once

#include <span>

#include "base/scratch_array.h"
#include "photon/kd_index.h"

namespace lsde {

// Of a block whose photons lie in one plane, on one side and in one medium, and have no wavelength of their own.
struct BlockSums {
    Vec3 centre{0};          // m: mean of the positions, by power
    float radius = -1;       // m: no photon is further from it; negative: they differ, and nothing is summed
    float spread = 0;        // m2: mean of the squared distance from it, by power
    float total = 0;         // W of one path: all channels
    float totalSquared = 0;  // W2: of each photon's sum of channels, squared
    Rgb powerSquared{0};     // W2
    uint32_t count = 0;      // photons

    bool alike() const { return radius >= 0; }
};

// Photons of a group from groupCount on are left out (path/path_groups.h).
class BlockTable {
  public:
    BlockTable() = default;  // without any
    // groups: of each photon of the tree.
    BlockTable(const PhotonTreeView& tree, std::span<const uint16_t> groups, size_t groupCount, ScratchPlace place,
               ThreadPool& pool);

    bool empty() const { return blocks_.empty(); }
    const BlockSums& operator[](uint32_t block) const { return blocks_[block]; }
    // W of one path, of each group.
    std::span<const Rgb> powers(uint32_t block) const { return {powers_.data() + block * groups_, groups_}; }

  private:
    void sum(const PhotonTreeView& tree, std::span<const uint16_t> groups, uint32_t block);

    ScratchArray<BlockSums> blocks_;
    ScratchArray<Rgb> powers_;
    size_t groups_ = 0;
};

}  // namespace lsde
