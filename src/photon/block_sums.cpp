#include "photon/block_sums.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/ray.h"

namespace lsde {

namespace {

bool alike(const PhotonPayload& a, const PhotonPayload& b) {
    return a.normal == b.normal && a.medium == b.medium && (a.flags & kLandedOnFront) == (b.flags & kLandedOnFront) &&
           a.wavelength == b.wavelength;
}

bool allAlike(const PhotonTreeView& tree, uint32_t first) {
    for (uint32_t i = first + 1; i < first + kBlockSize; ++i)
        if (!alike(tree.payload[first], tree.payload[i])) return false;
    return tree.payload[first].wavelength == kAllWavelengths;
}

}  // namespace

BlockTable::BlockTable(const PhotonTreeView& tree, std::span<const uint16_t> groups, size_t groupCount,
                       ScratchPlace place, ThreadPool& pool)
    : blocks_(tree.blocks.size(), place), powers_(tree.blocks.size() * groupCount, place), groups_(groupCount) {
    constexpr size_t kRun = 4096;
    pool.forEach((blocks_.size() + kRun - 1) / kRun, [&](size_t run) {
        for (size_t b = run * kRun; b < std::min(blocks_.size(), (run + 1) * kRun); ++b)
            sum(tree, groups, static_cast<uint32_t>(b));
    });
}

void BlockTable::sum(const PhotonTreeView& tree, std::span<const uint16_t> groups, uint32_t block) {
    const uint32_t first = block * kBlockSize;
    blocks_[block] = {};
    if (uint64_t{first} + kBlockSize > tree.count || !allAlike(tree, first)) return;
    BlockSums sums;
    std::array<float, kBlockSize> each{};  // sum of channels
    for (uint32_t i = 0; i < kBlockSize; ++i) {
        const uint16_t group = groups[first + i];
        if (group >= groups_) continue;
        const Rgb power = unpackPower(tree.payload[first + i].power);
        each[i] = power.x + power.y + power.z;
        sums.total += each[i];
        powers_[block * groups_ + group] += power;
        sums.powerSquared += power * power;
        sums.totalSquared += square(each[i]);
        // About the first photon: coordinates may be large beside the block.
        sums.centre += each[i] * (tree.position(first + i) - tree.position(first));
        ++sums.count;
    }
    sums.centre = tree.position(first) + (sums.total > 0 ? sums.centre / sums.total : Vec3(0));
    const Vec3 normal = unpackNormal(tree.payload[first].normal);
    const float slack = surfaceEpsilon(sums.centre, 0);
    float radiusSquared = 0;
    for (uint32_t i = 0; i < kBlockSize; ++i) {
        const Vec3 offset = tree.position(first + i) - sums.centre;
        const float d2 = lengthSquared(offset);
        // The normal is rounded, so that it seems to leave the plane by a share of the way.
        if (std::fabs(glm::dot(offset, normal)) > slack + 0.01F * std::sqrt(d2)) return;
        sums.spread += each[i] * d2;
        radiusSquared = std::max(radiusSquared, d2);
    }
    if (sums.total > 0) sums.spread /= sums.total;
    sums.radius = std::sqrt(radiusSquared);
    blocks_[block] = sums;
}

}  // namespace lsde
