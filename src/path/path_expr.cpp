#include "path/path_expr.h"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>

#include "base/error.h"
#include "path/path_parser.h"

namespace lsde {

namespace {

// Most subsets that are tried: far more than any expression of 64 states has that was not made to have them.
constexpr size_t kMaxSubsets = 1024;

// A complete automaton before its states are known to be few. State 0 is the start.
struct Dfa {
    std::vector<std::array<int, kEventCount>> next;
    std::vector<bool> accepting;
};

using StateSet = std::vector<int>;  // sorted

// What can be reached from the seeds without an event. Only the states that tell sets apart are kept: those that an
// event leaves, and the accepting one.
StateSet closure(const PathNfa& nfa, StateSet seeds) {
    StateSet kept;
    std::vector<bool> seen(nfa.states.size());
    while (!seeds.empty()) {
        const int s = seeds.back();
        seeds.pop_back();
        if (s < 0 || seen[static_cast<size_t>(s)]) continue;
        seen[static_cast<size_t>(s)] = true;
        const PathNfa::State& state = nfa.states[static_cast<size_t>(s)];
        if (state.events != 0 || s == nfa.accept) kept.push_back(s);
        seeds.insert(seeds.end(), state.epsilon.begin(), state.epsilon.end());
    }
    std::ranges::sort(kept);
    return kept;
}

StateSet step(const PathNfa& nfa, const StateSet& from, int event) {
    StateSet targets;
    for (const int s : from) {
        const PathNfa::State& state = nfa.states[static_cast<size_t>(s)];
        if (((state.events >> event) & 1) != 0) targets.push_back(state.target);
    }
    return closure(nfa, std::move(targets));
}

// Subset construction (Rabin & Scott 1959). The empty set is the state of paths that no continuation can save. Stops at
// kMaxSubsets: nothing is returned.
std::optional<Dfa> determinise(const PathNfa& nfa) {
    std::map<StateSet, int> ids;
    std::vector<const StateSet*> sets;
    const auto idOf = [&](StateSet set) {
        const auto [at, added] = ids.try_emplace(std::move(set), static_cast<int>(ids.size()));
        if (added) sets.push_back(&at->first);
        return at->second;
    };
    idOf(closure(nfa, {nfa.start}));
    Dfa dfa;
    for (size_t i = 0; i < sets.size(); ++i) {
        if (sets.size() > kMaxSubsets) return std::nullopt;
        dfa.accepting.push_back(std::ranges::binary_search(*sets[i], nfa.accept));
        auto& next = dfa.next.emplace_back();
        for (int e = 0; e < kEventCount; ++e) next[static_cast<size_t>(e)] = idOf(step(nfa, *sets[i], e));
    }
    return dfa;
}

// Class of each state under equivalence (Moore 1956): states part as soon as an event leads them to different classes.
// Classes are numbered as they appear, so the start's is 0. Stops once there are more than `limit`.
std::vector<int> equivalentStates(const Dfa& dfa, size_t limit) {
    std::vector<int> classes(dfa.accepting.begin(), dfa.accepting.end());
    for (size_t before = 0, count = 1; count != before && before <= limit;) {
        before = count;
        std::map<std::array<int, 1 + kEventCount>, int> ids;
        std::vector<int> refined;
        for (size_t i = 0; i < classes.size(); ++i) {
            std::array<int, 1 + kEventCount> signature{classes[i]};
            for (size_t e = 0; e < kEventCount; ++e) signature[1 + e] = classes[static_cast<size_t>(dfa.next[i][e])];
            refined.push_back(ids.try_emplace(signature, static_cast<int>(ids.size())).first->second);
        }
        classes = std::move(refined);
        count = ids.size();
    }
    return classes;
}

}  // namespace

PathExpr::PathExpr(std::string_view expression) : text_(expression) {
    const std::optional<Dfa> dfa = determinise(parsePathExpression(expression));
    std::vector<int> classes;
    if (dfa) classes = equivalentStates(*dfa, kMaxStates);
    if (!dfa || std::ranges::max(classes) >= kMaxStates)
        throw Error(describePathExpression(expression) + ": needs too many states, expected at most " +
                    std::to_string(kMaxStates));
    next_.resize(static_cast<size_t>(std::ranges::max(classes)) + 1);
    for (size_t i = 0; i < classes.size(); ++i) {
        const auto state = static_cast<size_t>(classes[i]);
        for (size_t e = 0; e < kEventCount; ++e)
            next_[state][e] = static_cast<uint8_t>(classes[static_cast<size_t>(dfa->next[i][e])]);
        if (dfa->accepting[i]) accepting_ |= uint64_t{1} << state;
    }
    tabulateBefore();
    for (uint64_t more = accepting_; (more & ~alive_) != 0;) {
        alive_ |= more;
        more = before(alive_, Event::Diffuse) | before(alive_, Event::Glossy) | before(alive_, Event::Specular);
    }
}

void PathExpr::tabulateBefore() {
    for (size_t e = 0; e < kEventCount; ++e) {
        std::array<uint64_t, kMaxStates> single{};
        for (size_t s = 0; s < next_.size(); ++s) single[next_[s][e]] |= uint64_t{1} << s;
        before_[e].resize((next_.size() + 7) / 8);
        for (size_t i = 0; i < before_[e].size(); ++i) {
            auto& masks = before_[e][i];
            masks[0] = 0;
            for (size_t value = 1; value < masks.size();
                 ++value)  // that of value without its lowest bit is there already
                masks[value] =
                    masks[value & (value - 1)] | single[8 * i + static_cast<size_t>(std::countr_zero(value))];
        }
    }
}

}  // namespace lsde
