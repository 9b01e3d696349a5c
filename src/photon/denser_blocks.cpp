#include "photon/denser_blocks.h"

namespace lsde {

namespace {

constexpr float kDenser = 4;
// Cosine between the sides on which photons landed, below which they lie on the two sides of one sheet.
constexpr float kOtherSide = -0.9F;

}  // namespace

DenserBlocks::DenserBlocks(const PhotonTreeView& photons, Vec3 sideNormal, uint32_t count, float radius)
    : photons_(&photons),
      sideNormal_(sideNormal),
      many_(kDenser * static_cast<float>(count) / (kPi * radius * radius)) {}

bool DenserBlocks::operator()(uint32_t block) {
    if (block == lastBlock_) return last_;
    lastBlock_ = block;
    // So many photons in the block's area would be as dense.
    const float many = many_ * boxArea(*photons_, block);
    return last_ = kBlockSize > many && static_cast<float>(notBehind(block)) > many;
}

uint32_t DenserBlocks::notBehind(uint32_t block) const {
    const uint64_t first = uint64_t{block} * kBlockSize, end = std::min(first + kBlockSize, photons_->count);
    uint32_t count = 0;
    for (uint64_t i = first; i < end; ++i)
        if (glm::dot(landedSide(photons_->payload[i]), sideNormal_) > kOtherSide) ++count;
    return count;
}

}  // namespace lsde
