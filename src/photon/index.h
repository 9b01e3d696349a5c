// What every index of photons can do.
#pragma once

#include <concepts>
#include <variant>

#include "photon/flann_index.h"
#include "photon/kd_index.h"

namespace lsde {

// Exact, and equal bit by bit: the photons with distanceSquared < radius^2, and the k nearest of them by distance, then
// index.
template <typename T>
concept PhotonIndex = requires(const T& index, Vec3 centre, float radius, uint32_t k, NeighbourList& out) {
    { index.tree() } -> std::convertible_to<const PhotonTreeView&>;
    index.within(centre, radius, out);
    index.nearest(centre, k, radius, out);
    index.nearest(centre, k, radius, out, [](uint32_t) { return true; });
};

using AnyIndex = std::variant<KdIndex, FlannIndex>;

}  // namespace lsde
