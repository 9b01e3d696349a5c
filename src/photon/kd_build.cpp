#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "base/ray.h"
#include "photon/kd_index.h"

namespace lsde {

namespace {

// What is sorted: 16 bytes in place of 40. The photon behind it decides ties only.
struct Key {
    std::array<float, 3> position;  // m
    uint32_t photon;
};

constexpr size_t kParallelPhotons = 32768;  // fewer are not worth a task
constexpr size_t kFewKeys = 64;             // fewer are not worth a pivot that is looked for

class Sorter {
  public:
    Sorter(std::span<const PackedPhoton> photons, ThreadPool& pool) : photons_(photons), pool_(pool) {}

    // Brings the keys into kd order: every run of 16 * 8^j of them is one subtree, the last one may be shorter.
    void sort(std::span<Key> keys) const {
        if (keys.size() <= kBlockSize) return sortBlock(keys);
        const size_t left = splitPosition(keys.size());
        partition(keys, left);
        const auto sortLeft = [&] { sort(keys.first(left)); };
        const auto sortRight = [&] { sort(keys.subspan(left)); };
        if (keys.size() >= kParallelPhotons) return pool_.both(sortLeft, sortRight);
        sortLeft();
        sortRight();
    }

  private:
    // Half of the children of a node over `count` photons, in whole children.
    static size_t splitPosition(size_t count) {
        size_t child = kBlockSize;
        while (child * kNodeWidth < count) child *= kNodeWidth;
        const size_t children = (count + child - 1) / child;
        return child * ((children + 1) / 2);
    }

    static Bounds boundsOf(std::span<const Key> keys) {
        Bounds bounds;
        for (const Key& key : keys) bounds.grow(Vec3(key.position[0], key.position[1], key.position[2]));
        return bounds;
    }

    static size_t longestAxis(Vec3 extent) {
        if (extent.x >= extent.y && extent.x >= extent.z) return 0;
        return extent.y >= extent.z ? 1 : 2;
    }

    // The `left` smallest along the longest axis come first. Where the cut falls on a plane across that axis, rounding
    // alone would tell the plane's photons apart, and both halves would be spread over all of it: they are cut along
    // the plane.
    void partition(std::span<Key> keys, size_t left) const {
        const Bounds bounds = boundsOf(keys);
        const size_t axis = longestAxis(bounds.extent());
        cutAlong(axis, keys, left);
        const float middle = keys[left].position[axis];
        const float rounding = surfaceEpsilon(glm::max(glm::abs(bounds.lo), glm::abs(bounds.hi)), 0);
        const auto onPlane = [=](const Key& key) { return std::fabs(key.position[axis] - middle) <= rounding; };
        if (std::count_if(keys.begin(), keys.end(), onPlane) <= static_cast<ptrdiff_t>(kBlockSize)) return;
        const auto first =
            std::partition(keys.begin(), keys.begin() + static_cast<ptrdiff_t>(left), std::not_fn(onPlane));
        const auto last = std::partition(keys.begin() + static_cast<ptrdiff_t>(left), keys.end(), onPlane);
        const std::span<Key> plane(first, last);
        Vec3 extent = boundsOf(plane).extent();
        extent[static_cast<int>(axis)] = 0;
        cutAlong(longestAxis(extent), plane, left - static_cast<size_t>(first - keys.begin()));
    }

    // The `left` smallest along the axis come first, and then the next one.
    void cutAlong(size_t axis, std::span<Key> keys, size_t left) const {
        while (keys.size() > kFewKeys) {
            const float pivot = pivotNear(axis, keys, left);
            size_t below = moveFirst(keys, [=](const Key& key) { return key.position[axis] < pivot; });
            const bool least = below == 0;  // and many may be equal, as on a plane across the axis
            if (least) below = moveFirst(keys, [=](const Key& key) { return key.position[axis] == pivot; });
            if (left < below) {
                keys = keys.first(below);
                if (least) break;
            } else {
                keys = keys.subspan(below);
                left -= below;
            }
        }
        std::nth_element(keys.begin(), keys.begin() + static_cast<ptrdiff_t>(left), keys.end(),
                         [this, axis](const Key& a, const Key& b) {
                             if (a.position[axis] != b.position[axis]) return a.position[axis] < b.position[axis];
                             return photonLess(a, b);
                         });
    }

    // A coordinate of one of the keys, about a standard error beyond the one sought, on the side of the more keys: most
    // often few are left after two steps (Floyd & Rivest 1975).
    static float pivotNear(size_t axis, std::span<const Key> keys, size_t left) {
        constexpr size_t kMostSamples = 1023;
        std::array<float, kMostSamples> samples;
        const auto size = static_cast<double>(keys.size());
        const size_t count = std::min(kMostSamples, static_cast<size_t>(std::sqrt(size)));
        for (size_t i = 0; i < count; ++i) samples[i] = keys[i * keys.size() / count].position[axis];
        const double share = static_cast<double>(left) / size,
                     error = std::sqrt(share * (1 - share) * static_cast<double>(count));
        const double rank = share * static_cast<double>(count) + (share < 0.5 ? 1 : -1) * (error + 1);
        const auto at = static_cast<ptrdiff_t>(std::clamp(rank, 0.0, static_cast<double>(count - 1)));
        std::nth_element(samples.begin(), samples.begin() + at, samples.begin() + static_cast<ptrdiff_t>(count));
        return samples[static_cast<size_t>(at)];
    }

    // Those that are chosen come first; returns how many. Without a jump that depends on the keys: half of those would
    // be mispredicted.
    template <typename Choose>
    static size_t moveFirst(std::span<Key> keys, const Choose& choose) {
        size_t first = 0;
        for (Key& key : keys) {
            const Key moved = key;
            key = keys[first];
            keys[first] = moved;
            first += choose(moved) ? 1 : 0;
        }
        return first;
    }

    // The order within a block is that of the photons themselves.
    void sortBlock(std::span<Key> keys) const {
        std::sort(keys.begin(), keys.end(), [this](const Key& a, const Key& b) { return photonLess(a, b); });
    }

    // Positions decide first, as of photons, but are at hand.
    bool photonLess(const Key& a, const Key& b) const {
        if (a.position != b.position) return a.position < b.position;
        return photons_[a.photon] < photons_[b.photon];
    }

    std::span<const PackedPhoton> photons_;
    ThreadPool& pool_;
};

UnsetVector<Key> makeKeys(std::span<const PackedPhoton> photons, ThreadPool& pool) {
    UnsetVector<Key> keys(photons.size());
    pool.forRange(photons.size(), kTreeGrain * kBlockSize, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Vec3 p = photons[i].position;
            if (!validPosition(p))
                throw Error(fmt::format("position ({}, {}, {}) of a photon: expected finite coordinates within {:g} m",
                                        p.x, p.y, p.z, kMaxPhotonCoordinate));
            // Plus 0: -0 becomes 0, so that equal photons have equal bytes.
            keys[i] = {{p.x + 0.0F, p.y + 0.0F, p.z + 0.0F}, static_cast<uint32_t>(i)};
        }
    });
    return keys;
}

void fillBlocks(std::span<const Key> keys, std::span<const PackedPhoton> photons, PhotonTree& tree, ThreadPool& pool) {
    pool.forRange(tree.blocks.size(), kTreeGrain, [&](size_t begin, size_t end) {
        for (size_t b = begin; b < end; ++b) {
            PhotonBlock& block = tree.blocks[b];
            for (size_t i = 0; i < kBlockSize; ++i) {
                const size_t at = b * kBlockSize + i;
                const bool present = at < keys.size();
                block.x[i] = present ? keys[at].position[0] : kAbsentPhoton;
                block.y[i] = present ? keys[at].position[1] : kAbsentPhoton;
                block.z[i] = present ? keys[at].position[2] : kAbsentPhoton;
                if (present) tree.payload[at] = photons[keys[at].photon].payload;
            }
        }
    });
}

// Boxes from the leaves up.
void fillNodes(PhotonTree& tree, ThreadPool& pool) {
    const KdShape shape(tree.count);
    const auto fillLevel = [&](size_t level, const auto& children) {
        pool.forRange(shape.size[level], kTreeGrain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                const size_t from = i * kNodeWidth;
                tree.nodes[shape.first[level] + i] =
                    nodeOver(children.subspan(from, std::min<size_t>(kNodeWidth, children.size() - from)));
            }
        });
    };
    for (size_t level = 0; level < static_cast<size_t>(shape.levels); ++level) {
        if (level == 0)
            fillLevel(level, std::span<const PhotonBlock>(tree.blocks));
        else
            fillLevel(level,
                      std::span<const KdNode>(tree.nodes).subspan(shape.first[level - 1], shape.size[level - 1]));
    }
}

KdNode emptyNode() {
    KdNode node;
    for (float* lo : {node.loX, node.loY, node.loZ}) std::fill_n(lo, kNodeWidth, kInfinity);
    for (float* hi : {node.hiX, node.hiY, node.hiZ}) std::fill_n(hi, kNodeWidth, -kInfinity);
    return node;
}

void setBox(KdNode& node, size_t child, const Bounds& box) {
    node.loX[child] = box.lo.x;
    node.loY[child] = box.lo.y;
    node.loZ[child] = box.lo.z;
    node.hiX[child] = box.hi.x;
    node.hiY[child] = box.hi.y;
    node.hiZ[child] = box.hi.z;
}

Bounds boundsOf(const PhotonBlock& block) {
    Bounds bounds;
    for (size_t i = 0; i < kBlockSize && block.x[i] < kAbsentPhoton; ++i)
        bounds.grow({block.x[i], block.y[i], block.z[i]});
    return bounds;
}

template <typename Child>
KdNode nodeOverChildren(std::span<const Child> children) {
    KdNode node = emptyNode();
    for (size_t i = 0; i < children.size(); ++i) setBox(node, i, boundsOf(children[i]));
    return node;
}

}  // namespace

bool validPosition(Vec3 p) { return maxComponent(glm::abs(p)) <= kMaxPhotonCoordinate && isFinite(p); }

Bounds boundsOf(const KdNode& node) {
    Bounds bounds;
    for (size_t i = 0; i < kNodeWidth; ++i)
        bounds.grow(Bounds{{node.loX[i], node.loY[i], node.loZ[i]}, {node.hiX[i], node.hiY[i], node.hiZ[i]}});
    return bounds;
}

KdNode nodeOver(std::span<const PhotonBlock> blocks) { return nodeOverChildren(blocks); }
KdNode nodeOver(std::span<const KdNode> children) { return nodeOverChildren(children); }

PhotonTree buildPhotonTree(std::vector<PackedPhoton>&& photons, ThreadPool& pool) {
    const std::vector<PackedPhoton> input = std::move(photons);  // freed at the end
    if (input.size() > (uint64_t{1} << 32) - 17)
        throw Error(fmt::format("{} photons in one class: expected at most 2^32 - 17", input.size()));
    UnsetVector<Key> keys = makeKeys(input, pool);
    Sorter(input, pool).sort(keys);

    const KdShape shape(input.size());
    PhotonTree tree;
    tree.count = input.size();
    tree.blocks.resize(shape.blocks);
    tree.payload.resize(tree.count);
    tree.nodes.resize(shape.nodes);
    fillBlocks(keys, input, tree, pool);
    fillNodes(tree, pool);
    if (!tree.nodes.empty()) tree.bounds = boundsOf(tree.nodes.front());
    return tree;
}

}  // namespace lsde
