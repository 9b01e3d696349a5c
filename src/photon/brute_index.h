// Every photon at every query: the oracle of the other indices.
#pragma once

#include "photon/kd_index.h"

namespace lsde {

class BruteIndex {
  public:
    explicit BruteIndex(const PhotonTreeView& tree) : tree_(tree) {}
    const PhotonTreeView& tree() const { return tree_; }

    // As KdIndex.
    void within(Vec3 centre, float radius, NeighbourList& out) const;
    template <typename Accept>
    void nearest(Vec3 centre, uint32_t k, float maxRadius, NeighbourList& out, Accept&& accept) const {
        within(centre, maxRadius, out);
        keepAccepted(out, accept);
        std::sort(out.begin(), out.end());
        out.resizeWithin(std::min<size_t>(k, out.size()));
    }
    void nearest(Vec3 centre, uint32_t k, float maxRadius, NeighbourList& out) const {
        nearest(centre, k, maxRadius, out, [](uint32_t) { return true; });
    }

  private:
    PhotonTreeView tree_;
};

}  // namespace lsde
