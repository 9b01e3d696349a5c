// Heckbert's path expressions (Heckbert 1990), compiled to a deterministic automaton over the letters D, G, S.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "path/event.h"

namespace lsde {

// A complete automaton: state 0 is the start (after L), one transition a letter, accepting states as a mask (before E).
class PathExpr {
  public:
    static constexpr int kMaxStates = 64;

    // Grammar: 'L' regex 'E' with D, G, S, '.', [DS], (a|b), *, +, ?; anchored at both ends, blanks ignored. If the
    // expression names G, D means diffuse only; else D means any non-delta event. '.' is any one event.
    // The letters L and E may only stand at the ends; alternatives of whole paths are written L(a|b)E or (LaE|LbE) or
    // LaE|LbE. One repetition may follow an event or a group, not two: (D+)? for D+?.
    // Throws Error naming expression, position and what was expected; also if more than 64 states are needed.
    explicit PathExpr(std::string_view expression);

    const std::string& text() const { return text_; }
    int states() const { return static_cast<int>(next_.size()); }
    uint8_t next(uint8_t state, Event e) const { return next_[state][static_cast<size_t>(e)]; }

    // Light side: the state after L is 0; step it with next().
    // Eye side: the mask of states from which the suffix traced so far (towards the eye) is accepted. It starts as
    // accepting(); an event nearer to the light is put in front by before().
    uint64_t accepting() const { return accepting_; }
    uint64_t before(uint64_t suffixMask, Event e) const {
        uint64_t mask = 0;
        const auto& bytes = before_[static_cast<size_t>(e)];
        for (size_t i = 0; i < bytes.size(); ++i) mask |= bytes[i][(suffixMask >> (8 * i)) & 255];
        return mask;
    }

    static bool accepts(uint8_t state, uint64_t suffixMask) { return ((suffixMask >> state) & 1) != 0; }
    // Whether some continuation of the light path in this state is accepted, some eye path with this mask can still be
    // (every state can be reached from the start).
    bool alive(uint8_t state) const { return ((alive_ >> state) & 1) != 0; }
    static bool aliveMask(uint64_t suffixMask) { return suffixMask != 0; }

  private:
    void tabulateBefore();

    std::string text_;
    std::vector<std::array<uint8_t, kEventCount>> next_;
    uint64_t accepting_ = 0;
    uint64_t alive_ = 0;  // states from which an accepting state can be reached
    // before() by event, byte of the mask and its value: one look-up for up to eight states.
    std::array<std::vector<std::array<uint64_t, 256>>, kEventCount> before_;
};

}  // namespace lsde
