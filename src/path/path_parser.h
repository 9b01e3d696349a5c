// Heckbert's path notation (Heckbert 1990) read into a non-deterministic automaton (Thompson 1968).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lsde {

// Longest expression and deepest nesting that are read, so that no input can exhaust stack or time.
inline constexpr size_t kMaxPathExpression = 4096;  // characters
inline constexpr int kMaxPathNesting = 200;

struct PathNfa {
    struct State {
        uint8_t events = 0;  // bit e: event e leads to `target`
        int target = -1;
        std::array<int, 2> epsilon{-1, -1};  // states reached without an event
    };
    std::vector<State> states;
    int start = 0;
    int accept = 0;
};

// Grammar, blanks ignored:
//   paths  = path { "|" path }
//   path   = "L" events "E" | "(" paths ")"
//   events = { item }
//   item   = one [ "*" | "+" | "?" ]
//   one    = letter | "." | "[" letter { letter } "]" | "(" item events { "|" item events } ")"
//   letter = "D" | "G" | "S"
// Throws Error naming expression, column (from 1) and what was expected there.
PathNfa parsePathExpression(std::string_view expression);

// The beginning of every error line about an expression; long ones are cut, unprintable characters masked.
std::string describePathExpression(std::string_view expression);

}  // namespace lsde
