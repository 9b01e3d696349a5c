#include "path/path_expr.h"

#include <doctest/doctest.h>
#include <regex.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <random>

#include "base/error.h"
#include "path/words.h"

using namespace lsde;

namespace {

// What an expression means, by the C library's regular expressions. (std::regex gives false warnings under g++ 12's
// AddressSanitizer.)
class Oracle {
  public:
    explicit Oracle(const std::string& expression) {
        REQUIRE(regcomp(&regex_, pattern(expression).c_str(), REG_EXTENDED | REG_NOSUB) == 0);
    }
    ~Oracle() { regfree(&regex_); }
    Oracle(const Oracle&) = delete;
    Oracle& operator=(const Oracle&) = delete;

    bool matches(const std::string& word) const { return regexec(&regex_, word.c_str(), 0, nullptr, 0) == 0; }

  private:
    // L and E vanish, as whole words are matched anyway.
    static std::string pattern(const std::string& expression) {
        const bool namesGlossy = expression.find('G') != std::string::npos;
        std::string out;
        bool inSet = false;
        for (const char c : expression) {
            if (c == '[' || c == ']') inSet = c == '[';
            if (c == 'D' && !namesGlossy)
                out += inSet ? "DG" : "[DG]";
            else if (c != 'L' && c != 'E' && c != ' ' && c != '\t')
                out += c;
        }
        return concat({"^(", out, ")$"});
    }
    regex_t regex_{};
};

bool accepts(const PathExpr& e, std::string_view word) {
    uint8_t state = 0;
    for (const char letter : word) state = e.next(state, eventOf(letter));
    return PathExpr::accepts(state, e.accepting());
}

const char* const kExpressions[] = {
    "LE",
    "LDE",
    "LS+DE",
    "LS*DS*E",
    "L.*E",
    "L.+E",
    "L.?E",
    "L[DS]*E",
    "L[DGS]*E",
    "L[GS]*E",
    "L(D|S)*E",
    "L(D|G)*E",
    "LD+GE",
    "LG?DE",
    "L(S|D)?E",
    "L(S*|DS*)E",
    "LS*DS*D[DS]*E",
    "LS+D.*E",
    "L.*S+.*E",
    "L.*SD.*E",
    "L(SD)*E",
    "L(SD)+E",
    "L(SD|DS)*E",
    "L(S(D|G)?)*E",
    "L((S|D)(S|D))*E",
    "L(((D)))E",
    "LE|LDE",
    "LS+E|LDE|LGE",
    "(LDE|LSE)",
    "((LDE)|(LSE|LDDE))",
    "( L S + D E | L D E )",
    "L \t S +D\tE ",
    "LS*(DS+)*D?E",
    "L(DS|DDS|SSS)*E",
    "L[SS]*DE",
    "L(S?S?S?S?D)*E",
    "L...E",
    "L.(.|..)+SE",
    "LD.*D.E",
    "L(D*S*)*E",
    "L(D+S+)+GE",
    "L(.*D)?(S.*)?E",
    "LD[DS]D...E",
};

// A random expression: items, groups and repetitions as the notation allows.
class RandomExpression {
  public:
    explicit RandomExpression(uint64_t seed) : random_(seed) {}
    std::string operator()() {
        out_.clear();
        whole();
        while (below(4) == 0) {
            out_ += '|';
            whole();
        }
        return below(8) == 0 ? concat({"(", out_, ")"}) : out_;
    }

  private:
    size_t below(size_t n) { return random_() % n; }
    template <typename Choices>
    void oneOf(const Choices& choices) {
        out_ += choices[below(std::size(choices))];
    }
    void whole() {
        out_ += 'L';
        if (below(10) != 0) items(0);
        out_ += 'E';
    }
    void items(int depth) {
        for (size_t n = 1 + below(2); n > 0; --n) {
            if (depth > 1 || below(3) != 0)
                oneOf(std::array{"D", "D", "S", "S", "G", ".", "[DS]", "[GS]", "[DG]"});
            else
                group(depth + 1);
            oneOf(std::array{"", "", "", "*", "+", "?"});
        }
    }
    void group(int depth) {
        out_ += '(';
        items(depth);
        while (below(2) == 0) {
            out_ += '|';
            items(depth);
        }
        out_ += ')';
    }

    std::mt19937_64 random_;
    std::string out_;
};

}  // namespace

TEST_CASE("an expression accepts what a regular expression matches, for every path of up to eight events") {
    const std::vector<std::string> words = allWords(8);
    REQUIRE(words.size() == 9841);
    for (const char* expression : kExpressions) {
        CAPTURE(expression);
        const PathExpr compiled(expression);
        const Oracle oracle(expression);
        for (const std::string& word : words) {
            CAPTURE(word);
            REQUIRE(accepts(compiled, word) == oracle.matches(word));
        }
    }
}

TEST_CASE("random expressions accept what a regular expression matches") {
    const std::vector<std::string> words = allWords(5);
    RandomExpression make(11);
    size_t accepted = 0, total = 0;
    for (int i = 0; i < 300; ++i) {
        const std::string expression = make();
        CAPTURE(expression);
        const PathExpr compiled(expression);
        const Oracle oracle(expression);
        for (const std::string& word : words) {
            CAPTURE(word);
            const bool expected = oracle.matches(word);
            REQUIRE(accepts(compiled, word) == expected);
            accepted += expected ? 1 : 0;
            ++total;
        }
    }
    CHECK(accepted > total / 50);
    CHECK(accepted < total / 2);
}

TEST_CASE("light state and eye mask joined anywhere along a path say what the whole path says") {
    const std::vector<std::string> words = allWords(7);
    for (const char* expression : kExpressions) {
        CAPTURE(expression);
        const PathExpr e(expression);
        for (const std::string& word : words) {
            CAPTURE(word);
            std::vector<uint8_t> states{0};
            for (const char letter : word) states.push_back(e.next(states.back(), eventOf(letter)));
            const bool whole = PathExpr::accepts(states.back(), e.accepting());
            uint64_t mask = e.accepting();
            for (size_t split = word.size();; --split) {
                REQUIRE(PathExpr::accepts(states[split], mask) == whole);
                if (split == 0) break;
                mask = e.before(mask, eventOf(word[split - 1]));
            }
        }
    }
}

TEST_CASE("the mask before an event holds the states that the event leads into the mask") {
    std::mt19937_64 random(3);
    for (const char* expression : {"LE", "LS+DE", "LD[DS]D...E", "L.*D.....E"}) {
        const PathExpr e(expression);
        for (int i = 0; i < 1000; ++i) {
            const uint64_t mask = random() & (~uint64_t{0} >> (64 - e.states()));
            for (const Event event : {Event::Diffuse, Event::Glossy, Event::Specular}) {
                uint64_t expected = 0;
                for (int s = 0; s < e.states(); ++s)
                    if (((mask >> e.next(static_cast<uint8_t>(s), event)) & 1) != 0) expected |= uint64_t{1} << s;
                REQUIRE(e.before(mask, event) == expected);
            }
        }
    }
}

TEST_CASE("a state is alive if some continuation is accepted, a mask if some light path reaches it") {
    const std::vector<std::string> words = allWords(6);
    for (const char* expression : {"LE", "LDE", "LS+DE", "LS*DS*E", "L(SD)*E", "L.*E", "L...E", "LG?DE"}) {
        CAPTURE(expression);
        const PathExpr e(expression);
        std::vector<std::string> taken;
        std::ranges::copy_if(words, std::back_inserter(taken), [&](const auto& w) { return accepts(e, w); });
        for (const std::string& part : allWords(3)) {
            CAPTURE(part);
            uint8_t state = 0;
            for (const char letter : part) state = e.next(state, eventOf(letter));
            CHECK(e.alive(state) == std::ranges::any_of(taken, [&](const auto& w) { return w.starts_with(part); }));
            uint64_t mask = e.accepting();
            for (size_t i = part.size(); i-- > 0;) mask = e.before(mask, eventOf(part[i]));
            CHECK(PathExpr::aliveMask(mask) ==
                  std::ranges::any_of(taken, [&](const auto& w) { return w.ends_with(part); }));
        }
    }
}

TEST_CASE("an automaton has no more states than its language needs") {
    CHECK(PathExpr("L.*E").states() == 1);
    CHECK(PathExpr("L(D|S)*E").states() == 1);
    CHECK(PathExpr("L((D*S*)*|.+|D)E").states() == 1);
    CHECK(PathExpr("LE").states() == 2);
    CHECK(PathExpr("LS+DE").states() == 4);
    CHECK(PathExpr("LS+DE|LSS*DE|L(S|SS)+DE").states() == 4);
    CHECK(PathExpr("L.*SE").states() == 2);
    CHECK(PathExpr("L.*DE").text() == "L.*DE");
}

TEST_CASE("an automaton may have 64 states, and is refused beyond") {
    // Which of the last six events were D has to be remembered: 2^6 states.
    CHECK(PathExpr("L.*D.....E").states() == 64);
    CHECK_THROWS_WITH_AS(PathExpr("L.*D......E"),
                         "path expression \"L.*D......E\": needs too many states, expected at most 64", Error);
    CHECK(PathExpr(concat({"L", times(62, "D"), "E"})).states() == 64);
    CHECK_THROWS_AS(PathExpr(concat({"L", times(63, "D"), "E"})), Error);
}

TEST_CASE("expressions made to need exponentially many states, or many steps, are decided at once") {
    CHECK_THROWS_AS(PathExpr(concat({"L.*D", times(4000, "."), "E"})), Error);
    CHECK_THROWS_AS(PathExpr(concat({"L", times(2000, "D?"), "E"})), Error);
    CHECK_THROWS_AS(PathExpr(concat({"L", times(680, "(.*D)?"), "........E"})), Error);
    CHECK(PathExpr(concat({"L(", times(2000, "D?"), ")*SE"})).states() == 3);
}
