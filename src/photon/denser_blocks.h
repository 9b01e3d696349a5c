// Which of a tree's blocks hold photons far more densely than a disc does.
#pragma once

#include "photon/kd_index.h"

namespace lsde {

// Of about four times the disc's density: a block's own has an error of a quarter. Photons on the back of a sheet
// without thickness do not count. Asked about one block several times in a row it looks once.
class DenserBlocks {
  public:
    DenserBlocks() = default;
    // The disc holds `count` photons in a radius (m), landed on the side of sideNormal.
    DenserBlocks(const PhotonTreeView& photons, Vec3 sideNormal, uint32_t count, float radius);
    bool operator()(uint32_t block);

  private:
    // Photons of a block, less those on the back.
    uint32_t notBehind(uint32_t block) const;

    const PhotonTreeView* photons_ = nullptr;
    Vec3 sideNormal_{0};
    float many_ = 0;  // photons a m2
    uint32_t lastBlock_ = ~0U;
    bool last_ = false;
};

// So many photons of denser blocks are no chance: they belong to something else, beyond an edge.
inline constexpr uint32_t kFewDense = 3;

}  // namespace lsde
