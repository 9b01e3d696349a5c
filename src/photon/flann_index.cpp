// The one file that includes FLANN.
#include "photon/flann_index.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <fmt/format.h>

#include <limits>
#include <vector>

#include "base/error.h"

namespace lsde {

namespace {

// Adds squares in the order x, y, z, in float: the same bits as KdIndex.
using SquaredDistance = flann::L2_Simple<float>;

// FLANN compares with bounds of boxes that it sums up with roundings of its own, relative to the radius: it is asked
// for this much more, and what lies outside is left out here.
float widened(float distanceSquared) { return 1.0001F * distanceSquared + std::numeric_limits<float>::min(); }

class WithinResult : public flann::ResultSet<float> {
  public:
    WithinResult(float radiusSquared, NeighbourList& out)
        : radiusSquared_(radiusSquared), bound_(widened(radiusSquared)), out_(out) {}

    bool full() const override { return true; }
    float worstDist() const override { return bound_; }
    void addPoint(float distanceSquared, size_t index) override {
        if (distanceSquared < radiusSquared_) out_.push({static_cast<uint32_t>(index), distanceSquared});
    }

  private:
    float radiusSquared_, bound_;
    NeighbourList& out_;
};

// The k nearest so far, sorted: each new one is moved to its place, as in FLANN's own result sets.
class NearestResult : public flann::ResultSet<float> {
  public:
    NearestResult(size_t k, float radiusSquared, NeighbourList& out, const std::function<bool(uint32_t)>& accept)
        : k_(k), radiusSquared_(radiusSquared), out_(out), accept_(accept) {}

    bool full() const override { return out_.size() == k_; }
    float worstDist() const override { return widened(full() ? out_[k_ - 1].distanceSquared : radiusSquared_); }
    void addPoint(float distanceSquared, size_t index) override {
        const Neighbour n{static_cast<uint32_t>(index), distanceSquared};
        if (!(distanceSquared < radiusSquared_) || (full() && !(n < out_[k_ - 1])) || (accept_ && !accept_(n.index)))
            return;
        if (!full()) out_.push(n);
        size_t at = out_.size() - 1;
        for (; at > 0 && n < out_[at - 1]; --at) out_[at] = out_[at - 1];
        out_[at] = n;
    }

  private:
    size_t k_;
    float radiusSquared_;  // m2
    NeighbourList& out_;
    const std::function<bool(uint32_t)>& accept_;
};

}  // namespace

struct FlannIndex::Impl {
    explicit Impl(const PhotonTreeView& tree) : index(flann::KDTreeSingleIndexParams(16)) {
        if (tree.count > static_cast<uint64_t>(std::numeric_limits<int>::max()))
            throw Error(fmt::format("{} photons: the index flann takes at most 2^31 - 1", tree.count));
        std::vector<Vec3> points(tree.count);
        for (uint32_t i = 0; i < tree.count; ++i) points[i] = tree.position(i);
        // Copied in FLANN's own order: `points` is needed for the construction only.
        index.buildIndex(flann::Matrix<float>(&points[0].x, points.size(), 3));
    }
    flann::KDTreeSingleIndex<SquaredDistance> index;
};

FlannIndex::FlannIndex(const PhotonTreeView& tree)
    : tree_(tree), impl_(tree.count > 0 ? std::make_unique<const Impl>(tree) : nullptr) {}
FlannIndex::~FlannIndex() = default;
FlannIndex::FlannIndex(FlannIndex&&) noexcept = default;
FlannIndex& FlannIndex::operator=(FlannIndex&&) noexcept = default;

void FlannIndex::within(Vec3 centre, float radius, NeighbourList& out) const {
    out.clear();
    if (impl_ == nullptr || !isFinite(centre)) return;
    WithinResult result(radius * radius, out);
    impl_->index.findNeighbors(result, &centre.x, flann::SearchParams());
}

void FlannIndex::nearest(Vec3 centre, uint32_t k, float maxRadius, NeighbourList& out,
                         const std::function<bool(uint32_t)>& accept) const {
    out.clear();
    if (impl_ == nullptr || k == 0 || !isFinite(centre)) return;
    NearestResult result(k, maxRadius * maxRadius, out, accept);
    impl_->index.findNeighbors(result, &centre.x, flann::SearchParams());
}

}  // namespace lsde
