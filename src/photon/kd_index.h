// The packed kd-tree: photons in kd order in blocks of 16 (x[16] y[16] z[16]) under an implicit 8-wide tree of boxes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/bounds.h"
#include "base/parallel.h"
#include "base/unset_vector.h"
#include "photon/neighbours.h"
#include "photon/photon.h"

namespace lsde {

inline constexpr uint32_t kBlockSize = 16;     // photons
inline constexpr size_t kTreeGrain = 1024;     // blocks or nodes that are worth a task
inline constexpr uint32_t kNodeWidth = 8;      // children
inline constexpr float kAbsentPhoton = 1e30F;  // each coordinate of the last block's empty places

struct alignas(64) PhotonBlock {
    float x[kBlockSize], y[kBlockSize], z[kBlockSize];
};
struct alignas(64) KdNode {  // boxes of 8 children, empty ones inverted
    float loX[kNodeWidth], loY[kNodeWidth], loZ[kNodeWidth], hiX[kNodeWidth], hiY[kNodeWidth], hiZ[kNodeWidth];
    friend bool operator==(const KdNode&, const KdNode&) = default;
};

// Where the nodes lie. Node i of a level holds nodes (on level 0: blocks) 8 i to 8 i + 7 of the level below; the levels
// follow each other from the root's down.
struct KdShape {
    static constexpr size_t kMaxLevels = 10;  // 2^32 photons

    explicit KdShape(uint64_t photons);

    uint64_t blocks;
    uint64_t nodes = 0;
    int levels = 0;
    std::array<uint64_t, kMaxLevels> first{};  // number of a level's first node
    std::array<uint64_t, kMaxLevels> size{};   // nodes of a level
};

// Photons in kd order with their tree, owned.
struct PhotonTree {
    uint64_t count = 0;
    Bounds bounds;
    UnsetVector<PhotonBlock> blocks;
    UnsetVector<KdNode> nodes;
    UnsetVector<PhotonPayload> payload;  // count entries, in the order of the blocks
};

// The same, borrowed from a PhotonTree or from a mapped file.
struct PhotonTreeView {
    uint64_t count = 0;
    Bounds bounds;
    std::span<const PhotonBlock> blocks;
    std::span<const KdNode> nodes;
    std::span<const PhotonPayload> payload;

    Vec3 position(uint32_t i) const {
        const PhotonBlock& b = blocks[i / kBlockSize];
        return {b.x[i % kBlockSize], b.y[i % kBlockSize], b.z[i % kBlockSize]};
    }
};
PhotonTreeView view(const PhotonTree& tree);

// Sorts `photons` into a tree: a function of the multiset alone (ties are broken by comparing whole photons), for any
// order of input and any number of threads. Throws Error beyond 2^32 - 17 photons, and if a position is not finite or
// beyond kMaxPhotonCoordinate. The input is consumed.
PhotonTree buildPhotonTree(std::vector<PackedPhoton>&& photons, ThreadPool& pool);

// Squares of distances between such coordinates stay finite in float, and kAbsentPhoton is far from all of them.
inline constexpr float kMaxPhotonCoordinate = 1e18F;  // m
// Finite and in range.
bool validPosition(Vec3 p);

// The node of level 0 over the given blocks (at most 8; the last one may hold absent photons), and the node over nodes.
KdNode nodeOver(std::span<const PhotonBlock> blocks);
KdNode nodeOver(std::span<const KdNode> children);
Bounds boundsOf(const KdNode& node);

// The block of the photon nearest to p. The tree is not empty, p is finite.
uint32_t nearestBlock(const PhotonTreeView& tree, Vec3 p);
Bounds boxOf(const PhotonTreeView& tree, uint32_t block);
// Of the block's box, by its two longer sides: photons lie on surfaces. m2.
float boxArea(const PhotonTreeView& tree, uint32_t block);
// A positive radius that holds perhaps somewhat more than `count` photons, by the density of a block near by.
float guessRadius(const PhotonTreeView& tree, Vec3 centre, uint32_t count);
// The next radius to try where `found` of `wanted` photons were in this one.
float grownRadius(float radius, uint64_t wanted, uint64_t found);

// One photon in `stride` of a tree, in its order: those whose numbers are `first` modulo `stride`, a power of two.
// Neighbours in the tree are neighbours in space, so that these lie evenly among the others.
struct EveryNth {
    uint32_t stride = 1;
    uint32_t first = 0;

    // The least of these numbers from `begin` on.
    uint64_t from(uint64_t begin) const { return begin + ((first - begin) & (stride - 1)); }
};

class KdIndex {
  public:
    explicit KdIndex(const PhotonTreeView& tree) : tree_(tree), shape_(tree.count) {}
    const PhotonTreeView& tree() const { return tree_; }

    // All photons with distanceSquared < radius^2, by ascending index; what was in `out` before is cleared.
    void within(Vec3 centre, float radius, NeighbourList& out) const;
    // Those of them that are among every n-th.
    void someWithin(Vec3 centre, float radius, EveryNth every, NeighbourList& out) const;
    // The numbers of the blocks whose boxes come that near, ascending; and, appended, the photons of one of them.
    void blocksWithin(Vec3 centre, float radius, ScratchList<uint32_t>& out) const;
    void appendWithin(uint32_t block, Vec3 centre, float radius, NeighbourList& out) const;

    // The k nearest that `accept(index)` takes, closer than maxRadius, sorted by distance, then index; fewer if there
    // are fewer.
    template <typename Accept>
    void nearest(Vec3 centre, uint32_t k, float maxRadius, NeighbourList& out, Accept&& accept) const {
        out.clear();
        if (k == 0 || tree_.count == 0) return;
        const float reach = std::min(maxRadius, reachOfAll(centre));
        float radius = std::min(reach, guessRadius(tree_, centre, k));
        for (;; radius = std::min(reach, grownRadius(radius, k, out.size()))) {
            within(centre, radius, out);
            keepAccepted(out, accept);
            if (out.size() >= k || !(radius < reach)) break;
        }
        keepNearest(out, k, radius * radius);
    }
    void nearest(Vec3 centre, uint32_t k, float maxRadius, NeighbourList& out) const {
        nearest(centre, k, maxRadius, out, [](uint32_t) { return true; });
    }

  private:
    // A radius within which all photons lie.
    float reachOfAll(Vec3 centre) const;

    PhotonTreeView tree_;
    KdShape shape_;
};

}  // namespace lsde
