// FLANN's exact kd-tree of points (Muja & Lowe 2014) over the same photons: the baseline of KdIndex, and an oracle.
#pragma once

#include <functional>
#include <memory>

#include "photon/kd_index.h"

namespace lsde {

// Rebuilt on every load, on one thread; needs a copy of the positions. The view's memory must outlive it.
class FlannIndex {
  public:
    // Throws Error beyond 2^31 - 1 photons, which FLANN cannot number.
    explicit FlannIndex(const PhotonTreeView& tree);
    ~FlannIndex();
    FlannIndex(FlannIndex&&) noexcept;
    FlannIndex& operator=(FlannIndex&&) noexcept;
    const PhotonTreeView& tree() const { return tree_; }

    // As KdIndex, in FLANN's order.
    void within(Vec3 centre, float radius, NeighbourList& out) const;
    void nearest(Vec3 centre, uint32_t k, float maxRadius, NeighbourList& out,
                 const std::function<bool(uint32_t)>& accept = {}) const;

  private:
    struct Impl;
    PhotonTreeView tree_;
    std::unique_ptr<const Impl> impl_;  // none for no photons, of which FLANN makes no tree
};

}  // namespace lsde
