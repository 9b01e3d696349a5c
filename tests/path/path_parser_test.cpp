#include "path/path_parser.h"

#include <doctest/doctest.h>

#include <random>

#include "base/error.h"
#include "path/path_expr.h"
#include "path/words.h"

using namespace lsde;

namespace {

std::string messageOf(const std::string& expression) {
    try {
        PathExpr{expression};
    } catch (const Error& e) {
        return e.what();
    }
    return "compiled";
}

struct BadExpression {
    std::string expression;
    int column;
    std::string found;
    std::string expected;
};

const BadExpression kBad[] = {
    {"", 1, "the end", "L or '('"},
    {"  ", 3, "the end", "L or '('"},
    {"DE", 1, "'D'", "L or '('"},
    {"E", 1, "'E'", "L or '('"},
    {"LS+D", 5, "the end", "D, G, S, '.', '[', '(' or E"},
    {"LXE", 2, "'X'", "D, G, S, '.', '[', '(' or E"},
    {"lse", 1, "'l'", "L or '('"},
    {"L D * x E", 7, "'x'", "D, G, S, '.', '[', '(' or E"},
    {"L*E", 2, "'*'", "D, G, S, '.', '[', '(' or E"},
    {"LD|SE", 3, "'|'", "D, G, S, '.', '[', '(' or E"},
    {"LDLE", 3, "'L'", "D, G, S, '.', '[', '(' or E"},
    {"LDEDE", 4, "'D'", "'|' or the end"},
    {"LDE*", 4, "'*'", "'|' or the end"},
    {"(LDE|LSE)*", 10, "'*'", "'|' or the end"},
    {"LDE)", 4, "')'", "'|' or the end"},
    {"LDE|", 5, "the end", "L or '('"},
    {"(LDE", 5, "the end", "'|' or ')'"},
    {"()", 2, "')'", "L or '('"},
    {"L()E", 3, "')'", "D, G, S, '.', '[' or '('"},
    {"L(D|)E", 5, "')'", "D, G, S, '.', '[' or '('"},
    {"L(|D)E", 3, "'|'", "D, G, S, '.', '[' or '('"},
    {"L(D|SE", 6, "'E'", "D, G, S, '.', '[', '(', '|' or ')'"},
    {"L(DE)", 4, "'E'", "D, G, S, '.', '[', '(', '|' or ')'"},
    {"L(*)E", 3, "'*'", "D, G, S, '.', '[' or '('"},
    {"L[]E", 3, "']'", "D, G or S"},
    {"L[^D]E", 3, "'^'", "D, G or S"},
    {"L[D.]E", 4, "'.'", "D, G, S or ']'"},
    {"L[DSE", 5, "'E'", "D, G, S or ']'"},
    {"LD]E", 3, "']'", "D, G, S, '.', '[', '(' or E"},
    {"LS**E", 4, "'*'", "only one of * + ? in a row"},
    {"LS+ ?E", 5, "'?'", "only one of * + ? in a row"},
    {"L(D)*+E", 6, "'+'", "only one of * + ? in a row"},
    {std::string("LDE\0", 4), 4, "'?'", "'|' or the end"},
    {std::string("L\0DE", 4), 2, "'?'", "D, G, S, '.', '[', '(' or E"},
    {"L\nE", 2, "'?'", "D, G, S, '.', '[', '(' or E"},
    {"L\xc3\x89", 2, "'?'", "D, G, S, '.', '[', '(' or E"},
};

}  // namespace

TEST_CASE("an expression that cannot be read is refused with its text, the column and what was expected there") {
    for (const BadExpression& bad : kBad) {
        CAPTURE(bad.expression);
        const std::string message = messageOf(bad.expression);
        const std::string end =
            concat({"\": column ", std::to_string(bad.column), ": ", bad.found, ", expected ", bad.expected});
        CHECK(message.starts_with("path expression \""));
        CHECK(message.ends_with(end));
        CHECK(message.size() == std::string_view("path expression \"").size() + bad.expression.size() + end.size());
        CHECK(message.find_first_of("\n\0\xc3", 0, 3) == std::string::npos);
    }
}

TEST_CASE("an expression may be 4096 characters long, not more") {
    const std::string longest = concat({"L", times(kMaxPathExpression - 2, " "), "E"});
    CHECK(PathExpr(longest).states() == 2);
    const std::string message = messageOf(longest + " ");
    CHECK(message.ends_with("4097 characters, expected at most 4096"));
    CHECK(message.size() < 200);
}

TEST_CASE("groups may be nested 200 deep, not more") {
    const auto nested = [](size_t depth) { return concat({"L", times(depth, "("), "D", times(depth, ")"), "E"}); };
    CHECK(PathExpr(nested(200)).states() == 3);
    CHECK(messageOf(nested(201)).ends_with("column 203: 'D', expected at most 200 nested groups"));
    CHECK(messageOf(times(4000, "(")).ends_with("column 202: '(', expected at most 200 nested groups"));
    CHECK(PathExpr(concat({"L", times(200, "("), "D", times(200, ")*"), "E"})).states() == 2);
    // The limit is on depth, not on the number of groups.
    CHECK(PathExpr(concat({"L", times(1000, "(D)*"), "E"})).states() == 2);
}

TEST_CASE("no string of the notation's characters crashes") {
    std::mt19937_64 random(7);
    const std::string_view alphabet = "LLEEDGS.[]()|*+? x";
    int compiled = 0;
    for (int i = 0; i < 50000; ++i) {
        std::string text = i % 2 == 0 ? "L" : "";
        for (size_t n = random() % 14; n > 0; --n) text += alphabet[random() % alphabet.size()];
        if (i % 2 == 0) text += "E";
        if (messageOf(text) == "compiled") ++compiled;
    }
    CHECK(compiled > 1000);
    CHECK(compiled < 25000);
}
