#include "path/path_filter.h"

#include <doctest/doctest.h>

#include <bit>

#include "base/error.h"
#include "path/words.h"

using namespace lsde;

namespace {

PathFilter makeFilter(const std::vector<std::string>& expressions) {
    std::vector<PathLayer> layers;
    layers.reserve(expressions.size());
    for (const std::string& e : expressions) layers.push_back({std::to_string(layers.size()), PathExpr(e)});
    return PathFilter(std::move(layers));
}

EyePathState eyeOf(const PathFilter& filter, std::string_view suffix) {
    EyePathState eye = filter.eye();
    for (size_t i = suffix.size(); i-- > 0;) filter.prepend(eye, eventOf(suffix[i]));
    return eye;
}

PathCode codeOfWord(std::string_view word) {
    PathCode code;
    for (const char letter : word) code.append(eventOf(letter));
    return code;
}

}  // namespace

TEST_CASE("every layer of a filter takes the paths of its own expression, wherever light and eye path join") {
    const std::vector<std::string> expressions = {"LS+DE", "L.*E", "LE", "L(S|G)*DE", "LD[DS]D...E", "L.*D.....E"};
    const PathFilter filter = makeFilter(expressions);
    REQUIRE(filter.size() == 6);
    for (const std::string& word : allWords(6)) {
        uint32_t expected = 0;
        for (size_t i = 0; i < expressions.size(); ++i) {
            const PathExpr alone(expressions[i]);
            uint8_t state = 0;
            for (const char letter : word) state = alone.next(state, eventOf(letter));
            if (PathExpr::accepts(state, alone.accepting())) expected |= 1U << i;
        }
        for (size_t split = 0; split <= word.size(); ++split) {
            CAPTURE(word);
            CAPTURE(split);
            const LightPathState light = filter.stateOf(codeOfWord(word.substr(0, split)));
            REQUIRE(filter.accepted(light, eyeOf(filter, word.substr(split))) == expected);
        }
    }
}

TEST_CASE("layers whose expressions part all paths take each path exactly once") {
    for (const std::vector<std::string>& parts : {std::vector<std::string>{"L(S*|DS*)E", "LS+DS*E", "LS*DS*D[DS]*E"},
                                                  std::vector<std::string>{"LE", "L(D|DG).*E", "LG.*E", "LS.*E"},
                                                  std::vector<std::string>{"LS*E", "LS*DS*E", "LS*DS*D.*E"}}) {
        const PathFilter filter = makeFilter(parts);
        for (const std::string& word : allWords(8)) {
            CAPTURE(word);
            REQUIRE(std::popcount(filter.accepted(filter.stateOf(codeOfWord(word)), filter.eye())) == 1);
        }
    }
}

TEST_CASE("a layer stays alive as long as a path can still become one of its own") {
    const PathFilter filter = makeFilter({"LS+DE", "L.*E", "LDE"});
    const auto light = [&](std::string_view prefix) { return filter.alive(filter.stateOf(codeOfWord(prefix))); };
    const auto eye = [&](std::string_view suffix) { return filter.alive(eyeOf(filter, suffix)); };
    CHECK(light("") == 0b111);
    CHECK(light("S") == 0b011);
    CHECK(light("D") == 0b110);
    CHECK(light("SD") == 0b011);
    CHECK(light("SDD") == 0b010);
    CHECK(eye("") == 0b111);
    CHECK(eye("S") == 0b010);
    CHECK(eye("D") == 0b111);
    CHECK(eye("SD") == 0b011);
    CHECK(eye("DSD") == 0b010);
}

TEST_CASE("a filter without layers takes nothing and fails nowhere") {
    const PathFilter filter;
    LightPathState light = PathFilter::light();
    EyePathState eye = filter.eye();
    filter.append(light, Event::Specular);
    filter.prepend(eye, Event::Diffuse);
    CHECK(filter.size() == 0);
    CHECK(filter.accepted(light, eye) == 0);
    CHECK(filter.alive(light) == 0);
    CHECK(filter.alive(eye) == 0);
}

TEST_CASE("a filter has at most 16 layers, each of its own name") {
    const std::vector<std::string> most(kMaxPathLayers, "LS+DE");
    const PathFilter filter = makeFilter(most);
    CHECK(filter.accepted(filter.stateOf(codeOfWord("SSD")), filter.eye()) == 0xffff);
    CHECK_THROWS_WITH_AS(makeFilter(std::vector<std::string>(kMaxPathLayers + 1, "LE")),
                         "17 path layers, expected at most 16", Error);
    CHECK_THROWS_WITH_AS(PathFilter({{"a", PathExpr("LE")}, {"b", PathExpr("LE")}, {"a", PathExpr("LDE")}}),
                         "path layer \"a\": named twice, expected one layer of a name", Error);
}
