#include "photon/brute_index.h"

namespace lsde {

void BruteIndex::within(Vec3 centre, float radius, NeighbourList& out) const {
    out.clear();
    for (uint64_t i = 0; i < tree_.count; ++i) {
        const auto index = static_cast<uint32_t>(i);
        const Vec3 d = tree_.position(index) - centre;
        const float distanceSquared = (d.x * d.x + d.y * d.y) + d.z * d.z;
        if (distanceSquared < radius * radius) out.push({index, distanceSquared});
    }
}

}  // namespace lsde
