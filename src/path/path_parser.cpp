#include "path/path_parser.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "path/event.h"

namespace lsde {

namespace {

constexpr uint8_t bit(Event e) { return static_cast<uint8_t>(1U << static_cast<unsigned>(e)); }

constexpr uint8_t kAnyEvent = (1U << kEventCount) - 1;

// Part of the automaton with one way in and one way out; nothing leaves its end yet.
struct Fragment {
    int start = 0;
    int end = 0;
};

// Thompson's construction: at most two states a character, two ways out of each without an event.
class NfaBuilder {
  public:
    Fragment nothing() {
        const int point = add();
        return {point, point};
    }
    Fragment oneOf(uint8_t events) {
        const Fragment f{add(), add()};
        states_[static_cast<size_t>(f.start)].events = events;
        states_[static_cast<size_t>(f.start)].target = f.end;
        return f;
    }
    Fragment join(Fragment a, Fragment b) {
        link(a.end, b.start);
        return {a.start, b.end};
    }
    Fragment unite(Fragment a, Fragment b) {
        const Fragment f{add(), add()};
        link(f.start, a.start);
        link(f.start, b.start);
        link(a.end, f.end);
        link(b.end, f.end);
        return f;
    }
    Fragment repeat(Fragment body, bool orNone, bool orMore) {
        const Fragment f{add(), add()};
        link(f.start, body.start);
        link(body.end, f.end);
        if (orNone) link(f.start, f.end);
        if (orMore) link(body.end, body.start);
        return f;
    }
    PathNfa finish(Fragment all) { return {std::move(states_), all.start, all.end}; }

  private:
    int add() {
        states_.emplace_back();
        return static_cast<int>(states_.size()) - 1;
    }
    void link(int from, int to) {
        auto& epsilon = states_[static_cast<size_t>(from)].epsilon;
        epsilon[epsilon[0] < 0 ? 0 : 1] = to;
    }

    std::vector<PathNfa::State> states_;
};

std::string printable(std::string_view text) {
    std::string out(text);
    std::ranges::replace_if(
        out, [](char c) { return c < ' ' || c > '~'; }, '?');
    return out;
}

// Recursive descent: one function for each rule of the grammar.
class PathParser {
  public:
    explicit PathParser(std::string_view text) : text_(text), namesGlossy_(text.find('G') != std::string_view::npos) {}

    PathNfa parse() {
        const Fragment all = alternatives([this] { return path(); });
        peek();
        if (at_ < text_.size()) fail("'|' or the end");
        return nfa_.finish(all);
    }

  private:
    template <typename Rule>
    Fragment alternatives(Rule rule) {
        Fragment f = rule();
        while (take('|')) f = nfa_.unite(f, rule());
        return f;
    }

    Fragment path() {
        if (take('(')) return group([this] { return path(); }, "'|' or ')'");
        if (!take('L')) fail("L or '('");
        const Fragment f = events();
        if (!take('E')) fail("D, G, S, '.', '[', '(' or E");
        return f;
    }

    Fragment events() {
        Fragment f = nfa_.nothing();
        while (startsItem()) f = nfa_.join(f, item());
        return f;
    }

    Fragment itemAndEvents() {
        const Fragment first = item();
        return nfa_.join(first, events());
    }

    Fragment item() {
        const Fragment f = one();
        const char c = peek();
        if (!isRepetition(c)) return f;
        ++at_;
        if (isRepetition(peek())) fail("only one of * + ? in a row");
        return nfa_.repeat(f, c != '+', c != '?');
    }

    Fragment one() {
        if (take('(')) return group([this] { return itemAndEvents(); }, "D, G, S, '.', '[', '(', '|' or ')'");
        if (take('[')) return nfa_.oneOf(set());
        if (take('.')) return nfa_.oneOf(kAnyEvent);
        const uint8_t events = letter();
        if (events == 0) fail("D, G, S, '.', '[' or '('");
        return nfa_.oneOf(events);
    }

    // After the opening parenthesis.
    template <typename Rule>
    Fragment group(Rule rule, const char* expectedAtEnd) {
        if (++depth_ > kMaxPathNesting) fail("at most " + std::to_string(kMaxPathNesting) + " nested groups");
        const Fragment f = alternatives(rule);
        if (!take(')')) fail(expectedAtEnd);
        --depth_;
        return f;
    }

    // After the opening bracket.
    uint8_t set() {
        uint8_t events = letter();
        if (events == 0) fail("D, G or S");
        while (!take(']')) {
            const uint8_t more = letter();
            if (more == 0) fail("D, G, S or ']'");
            events |= more;
        }
        return events;
    }

    // Takes a letter and gives the events that it matches; 0 and nothing taken if there is none.
    uint8_t letter() {
        if (take('D')) return namesGlossy_ ? bit(Event::Diffuse) : bit(Event::Diffuse) | bit(Event::Glossy);
        if (take('G')) return bit(Event::Glossy);
        if (take('S')) return bit(Event::Specular);
        return 0;
    }

    bool startsItem() { return std::string_view("DGS.[(").find(peek()) != std::string_view::npos; }
    static bool isRepetition(char c) { return c == '*' || c == '+' || c == '?'; }

    // The next character that is no blank; 0 after the last.
    char peek() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool take(char c) {
        if (peek() != c) return false;
        ++at_;
        return true;
    }

    [[noreturn]] void fail(const std::string& expected) {
        peek();
        const std::string found =
            at_ < text_.size() ? "'" + printable(text_.substr(at_, 1)) + "'" : std::string("the end");
        throw Error(describePathExpression(text_) + ": column " + std::to_string(at_ + 1) + ": " + found +
                    ", expected " + expected);
    }

    std::string_view text_;
    bool namesGlossy_;
    size_t at_ = 0;
    int depth_ = 0;
    NfaBuilder nfa_;
};

}  // namespace

std::string describePathExpression(std::string_view expression) {
    constexpr size_t kShown = 100;
    const std::string shown = printable(expression.substr(0, kShown));
    return "path expression \"" + shown + (expression.size() > kShown ? "...\"" : "\"");
}

PathNfa parsePathExpression(std::string_view expression) {
    if (expression.size() > kMaxPathExpression)
        throw Error(describePathExpression(expression) + ": " + std::to_string(expression.size()) +
                    " characters, expected at most " + std::to_string(kMaxPathExpression));
    return PathParser(expression).parse();
}

}  // namespace lsde
