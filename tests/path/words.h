// Every path up to a length, for tests that leave none out, and long expressions from short parts.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "path/event.h"

namespace lsde {

// All sequences of the symbols with at most `longest` of them, the shorter first.
template <typename Sequence, typename Symbols>
std::vector<Sequence> allSequences(const Symbols& symbols, size_t longest) {
    std::vector<Sequence> all(1);
    for (size_t i = 0; i < all.size() && all[i].size() < longest; ++i)
        for (const auto symbol : symbols) {
            Sequence longer = all[i];
            longer.push_back(symbol);
            all.push_back(std::move(longer));
        }
    return all;
}

// Paths by their letters between L and E, e.g. "SSD".
inline std::vector<std::string> allWords(size_t longest) {
    return allSequences<std::string>(std::string_view("DGS"), longest);
}

inline Event eventOf(char letter) {
    return letter == 'D' ? Event::Diffuse : letter == 'G' ? Event::Glossy : Event::Specular;
}

// The parts one after the other ("literal" + std::string gives false warnings under g++ 12 at -O3).
inline std::string concat(std::initializer_list<std::string_view> parts) {
    std::string out;
    for (const std::string_view part : parts) out += part;
    return out;
}

inline std::string times(size_t n, std::string_view text) {
    std::string out;
    for (size_t i = 0; i < n; ++i) out += text;
    return out;
}

}  // namespace lsde
