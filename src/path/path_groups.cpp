#include "path/path_groups.h"

#include <algorithm>

#include "base/error.h"

namespace lsde {

namespace {

constexpr size_t kPathsPerChunk = 1 << 16;

using State = std::optional<LightPathState>;

bool same(const State& a, const State& b) {
    return a.has_value() == b.has_value() && (!a.has_value() || a->state == b->state);
}

// Number of a state in the table; entered if it is new.
uint16_t numberOf(const State& state, std::vector<State>& table) {
    const auto at = std::find_if(table.begin(), table.end(), [&](const State& s) { return same(s, state); });
    if (at != table.end()) return static_cast<uint16_t>(at - table.begin());
    if (table.size() == PathGroups::kNone) throw Error("photons: more than 65535 groups of paths");
    table.push_back(state);
    return static_cast<uint16_t>(table.size() - 1);
}

// Codes seen lately and their groups: most photons of a map have one of a few paths.
class Recent {
  public:
    const uint16_t* find(PathCode code) const {
        const Entry& e = entries_[slot(code)];
        return e.used && e.code == code ? &e.group : nullptr;
    }
    void put(PathCode code, uint16_t group) { entries_[slot(code)] = {code, group, true}; }

  private:
    struct Entry {
        PathCode code;
        uint16_t group = 0;
        bool used = false;
    };
    static size_t slot(PathCode code) { return (code.bits() * 0x9e3779b97f4a7c15ULL) >> 56; }
    std::array<Entry, 256> entries_{};
};

}  // namespace

PathGroups::PathGroups(const PathFilter& filter, size_t count,
                       const std::function<std::optional<PathCode>(size_t)>& path, ScratchPlace place, ThreadPool& pool)
    : groups_(count, place) {
    const size_t chunks = (count + kPathsPerChunk - 1) / kPathsPerChunk;
    std::vector<std::vector<State>> tables(chunks);
    pool.forRange(count, kPathsPerChunk, [&](size_t begin, size_t end) {
        std::vector<State>& table = tables[begin / kPathsPerChunk];
        Recent recent;
        for (size_t i = begin; i < end; ++i) {
            const std::optional<PathCode> code = path(i);
            groups_[i] = kNone;
            if (!code) continue;
            if (const uint16_t* group = recent.find(*code)) {
                groups_[i] = *group;
                continue;
            }
            groups_[i] = numberOf(code->overflowed() ? State() : State(filter.stateOf(*code)), table);
            recent.put(*code, groups_[i]);
        }
    });
    // From each chunk's numbers to common ones.
    std::vector<std::vector<uint16_t>> common(chunks);
    for (size_t c = 0; c < chunks; ++c)
        for (const State& state : tables[c]) common[c].push_back(numberOf(state, states_));
    pool.forRange(count, kPathsPerChunk, [&](size_t begin, size_t end) {
        const std::vector<uint16_t>& numbers = common[begin / kPathsPerChunk];
        for (size_t i = begin; i < end; ++i)
            if (groups_[i] != kNone) groups_[i] = numbers[groups_[i]];
    });
}

}  // namespace lsde
