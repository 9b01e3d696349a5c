#include "photon/kd_index.h"

#include <cmath>

#include "photon/kd_lanes.h"

namespace lsde {

namespace {

constexpr uint64_t divideUp(uint64_t a, uint64_t b) { return (a + b - 1) / b; }

// Photons near the query are as dense as in the nearest block only roughly, and a radius that falls short costs a
// second search: on uniform photons this surplus makes that rare.
constexpr float kSurplus = 1.25F;

// Radii below it have squares that are zero in float, or nearly.
constexpr float kLeastRadius = 1e-18F;  // m

// Nodes are taken in runs of this many, so that a level's list of children has a size known beforehand.
constexpr size_t kRun = 16;
// Blocks looked ahead of the one at work: about the time that memory takes.
constexpr size_t kAhead = 6;

// All blocks that a sphere touches, level by level: first all nodes of a level that it touches, then all of the next.
// Unlike a walk to one leaf after the other, this asks memory for many nodes at once, and branches little. Takes
// several blocks at a time: take(span of their numbers).
template <typename Take>
class SphereSearch {
  public:
    SphereSearch(const PhotonTreeView& tree, const KdShape& shape, const lanes::Sphere8& sphere, const Take& take)
        : tree_(tree), shape_(shape), sphere_(sphere), take_(take) {}

    void run() {
        const uint32_t root = 0;
        descend(static_cast<size_t>(shape_.levels) - 1, {&root, 1});
    }

  private:
    void descend(size_t level, std::span<const uint32_t> nodes) {
        const KdNode* const levelNodes = tree_.nodes.data() + shape_.first[level];
        std::array<uint32_t, kNodeWidth * kRun> children;
        for (size_t begin = 0; begin < nodes.size(); begin += kRun) {
            uint32_t* end = children.data();
            for (const uint32_t node : nodes.subspan(begin, std::min(kRun, nodes.size() - begin))) {
                const uint32_t touched = lanes::below(lanes::distanceToBoxes(levelNodes[node], sphere_), sphere_);
                end = lanes::append(end, kNodeWidth * node, touched);
            }
            const std::span<const uint32_t> list(children.data(), end);
            if (level == 0) {
                take_(list);
            } else {
                const KdNode* const below = tree_.nodes.data() + shape_.first[level - 1];
                for (const uint32_t node : list.first(std::min(kRun, list.size()))) lanes::prefetch(below[node]);
                descend(level - 1, list);
            }
        }
    }

    const PhotonTreeView& tree_;
    const KdShape& shape_;
    const lanes::Sphere8& sphere_;
    const Take& take_;
};

template <typename Take>
void takeTouched(const PhotonTreeView& tree, const KdShape& shape, Vec3 centre, const lanes::Sphere8& sphere,
                 const Take& take) {
    // Against a coordinate that is not finite, empty boxes would not be infinitely far.
    if (shape.levels == 0 || !isFinite(centre)) return;
    SphereSearch(tree, shape, sphere, take).run();
}

Neighbour* appendPhotons(const PhotonTreeView& tree, uint32_t block, const lanes::Sphere8& sphere, Neighbour* end) {
    for (const uint32_t first : {0U, kBlockSize / 2}) {
        const __m256 distance = lanes::distanceToPhotons(tree.blocks[block], first, sphere);
        end = lanes::append(end, kBlockSize * block + first, distance, lanes::below(distance, sphere));
    }
    return end;
}

// Finds the block of the photon that is nearest to a point. That its box is near says little: boxes of photons on two
// walls cover much that is empty.
class BlockSearch {
  public:
    struct Found {
        uint32_t block = 0;
        float distanceSquared = kInfinity;  // m2, of the photon
    };

    BlockSearch(const PhotonTreeView& tree, Vec3 p) : tree_(tree), shape_(tree.count), point_(p.x, p.y, p.z, 0) {}

    // The block that the least box of each level leads to: not always the nearest, at a fraction of the cost.
    Found guess() {
        uint32_t node = 0;
        for (auto level = static_cast<size_t>(shape_.levels); level-- > 0;)
            node = kNodeWidth * node +
                   lanes::leastLane(lanes::distanceToBoxes(tree_.nodes[shape_.first[level] + node], point_));
        lookAt(node);
        return found_;
    }

    Found run() {
        descend(static_cast<size_t>(shape_.levels) - 1, 0);
        return found_;
    }

  private:
    void descend(size_t level, uint32_t node) {
        alignas(32) std::array<float, kNodeWidth> distances;
        __m256 d = lanes::distanceToBoxes(tree_.nodes[shape_.first[level] + node], point_);
        _mm256_store_ps(distances.data(), d);
        for (;;) {
            const uint32_t lane = lanes::leastLane(d);
            if (!(distances[lane] < found_.distanceSquared)) return;
            const uint32_t child = kNodeWidth * node + lane;
            if (level > 0)
                descend(level - 1, child);
            else
                lookAt(child);
            distances[lane] = kInfinity;
            d = _mm256_load_ps(distances.data());
        }
    }
    void lookAt(uint32_t block) {
        const __m256 d = _mm256_min_ps(lanes::distanceToPhotons(tree_.blocks[block], 0, point_),
                                       lanes::distanceToPhotons(tree_.blocks[block], kBlockSize / 2, point_));
        alignas(32) std::array<float, kNodeWidth> distances;
        _mm256_store_ps(distances.data(), d);
        const float least = distances[lanes::leastLane(d)];
        if (least < found_.distanceSquared) found_ = {block, least};
    }

    const PhotonTreeView& tree_;
    KdShape shape_;
    lanes::Sphere8 point_;
    Found found_;
};

// Of a box of photons, which lie on surfaces: its two longer sides span their area, or somewhat more than that.
float areaOf(Vec3 side) { return std::max({side.x * side.y, side.x * side.z, side.y * side.z}); }

}  // namespace

KdShape::KdShape(uint64_t photons) : blocks(divideUp(photons, kBlockSize)) {
    for (uint64_t below = blocks; below > 1 || (below == 1 && levels == 0); ++levels)
        size[static_cast<size_t>(levels)] = below = divideUp(below, kNodeWidth);
    for (auto level = static_cast<size_t>(levels); level-- > 0; nodes += size[level]) first[level] = nodes;
}

PhotonTreeView view(const PhotonTree& tree) { return {tree.count, tree.bounds, tree.blocks, tree.nodes, tree.payload}; }

void KdIndex::within(Vec3 centre, float radius, NeighbourList& out) const {
    out.clear();
    const lanes::Sphere8 sphere(centre.x, centre.y, centre.z, radius * radius);
    takeTouched(tree_, shape_, centre, sphere, [&](std::span<const uint32_t> blocks) {
        for (const uint32_t b : blocks.first(std::min(kAhead, blocks.size()))) lanes::prefetch(tree_.blocks[b]);
        Neighbour* const begin = out.room(kBlockSize * blocks.size());
        Neighbour* end = begin;
        for (size_t i = 0; i < blocks.size(); ++i) {
            if (i + kAhead < blocks.size()) lanes::prefetch(tree_.blocks[blocks[i + kAhead]]);
            end = appendPhotons(tree_, blocks[i], sphere, end);
        }
        out.resizeWithin(out.size() + static_cast<size_t>(end - begin));
    });
}

void KdIndex::someWithin(Vec3 centre, float radius, EveryNth every, NeighbourList& out) const {
    out.clear();
    const lanes::Sphere8 sphere(centre.x, centre.y, centre.z, radius * radius);
    takeTouched(tree_, shape_, centre, sphere, [&](std::span<const uint32_t> blocks) {
        for (const uint32_t b : blocks) {
            const uint64_t begin = uint64_t{kBlockSize} * b, end = std::min(begin + kBlockSize, tree_.count);
            for (uint64_t i = every.from(begin); i < end; i += every.stride) {
                const auto photon = static_cast<uint32_t>(i);
                const float distanceSquared = lengthSquared(tree_.position(photon) - centre);
                if (distanceSquared < radius * radius) out.push({photon, distanceSquared});
            }
        }
    });
}

void KdIndex::blocksWithin(Vec3 centre, float radius, ScratchList<uint32_t>& out) const {
    out.clear();
    const lanes::Sphere8 sphere(centre.x, centre.y, centre.z, radius * radius);
    takeTouched(tree_, shape_, centre, sphere, [&](std::span<const uint32_t> blocks) {
        std::copy(blocks.begin(), blocks.end(), out.room(blocks.size()));
        out.resizeWithin(out.size() + blocks.size());
    });
}

void KdIndex::appendWithin(uint32_t block, Vec3 centre, float radius, NeighbourList& out) const {
    const lanes::Sphere8 sphere(centre.x, centre.y, centre.z, radius * radius);
    Neighbour* const begin = out.room(kBlockSize);
    const Neighbour* const end = appendPhotons(tree_, block, sphere, begin);
    out.resizeWithin(out.size() + static_cast<size_t>(end - begin));
}

float KdIndex::reachOfAll(Vec3 centre) const {
    const Vec3 farthest = glm::max(glm::abs(tree_.bounds.lo - centre), glm::abs(tree_.bounds.hi - centre));
    return std::max(1.0001F * glm::length(farthest), kLeastRadius);  // above all roundings
}

Bounds boxOf(const PhotonTreeView& tree, uint32_t block) {
    const KdNode& node = tree.nodes[KdShape(tree.count).first[0] + block / kNodeWidth];
    const uint32_t lane = block % kNodeWidth;
    return {{node.loX[lane], node.loY[lane], node.loZ[lane]}, {node.hiX[lane], node.hiY[lane], node.hiZ[lane]}};
}

float boxArea(const PhotonTreeView& tree, uint32_t block) { return areaOf(boxOf(tree, block).extent()); }

uint32_t nearestBlock(const PhotonTreeView& tree, Vec3 p) { return BlockSearch(tree, p).run().block; }

float guessRadius(const PhotonTreeView& tree, Vec3 centre, uint32_t count) {
    if (tree.count == 0 || !isFinite(centre)) return 1;
    const BlockSearch::Found found = BlockSearch(tree, centre).guess();
    const Vec3 side = boxOf(tree, found.block).extent();
    const float disc = std::sqrt(kSurplus * static_cast<float>(count) * areaOf(side) / (kPi * kBlockSize));
    // Without area (one photon, or all in a row), any positive number will do, and grows.
    const float least = 1e-3F * (side.x + side.y + side.z) + 1e-6F * tree.bounds.radius() + kLeastRadius;
    return std::sqrt(found.distanceSquared) + std::max(disc, least);
}

float grownRadius(float radius, uint64_t wanted, uint64_t found) {
    // By area, and a bit more, since the density was overestimated; where little was found that says nothing, fourfold.
    const float ratio = (static_cast<float>(wanted) + 2) / (static_cast<float>(found) + 0.5F);
    return radius * std::clamp(1.15F * std::sqrt(ratio), 1.25F, 4.0F);
}

}  // namespace lsde
