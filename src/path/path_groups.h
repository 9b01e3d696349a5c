// Stored light paths by what the filters make of them: few groups, however many different paths there are.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/scratch_array.h"
#include "path/path_filter.h"

namespace lsde {

// The group of each of a list of stored paths. All paths of a group have the same state in every layer, so that sums
// over photons need be kept by group only.
class PathGroups {
  public:
    static constexpr uint16_t kNone = 0xffff;  // of paths that do not take part

    PathGroups() = default;
    // path(i): the code of path i of `count`; nullopt if it does not take part. Groups are numbered in the order of
    // their first paths, for any number of threads. Throws Error beyond 65535 groups.
    PathGroups(const PathFilter& filter, size_t count, const std::function<std::optional<PathCode>(size_t)>& path,
               ScratchPlace place, ThreadPool& pool);

    uint16_t of(size_t i) const { return groups_[i]; }
    std::span<const uint16_t> all() const { return {groups_.data(), groups_.size()}; }
    size_t size() const { return states_.size(); }
    // Empty: the group of overflowed codes, which have no state.
    const std::optional<LightPathState>& state(size_t group) const { return states_[group]; }

  private:
    ScratchArray<uint16_t> groups_;
    std::vector<std::optional<LightPathState>> states_;
};

}  // namespace lsde
