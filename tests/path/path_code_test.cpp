#include "path/path_code.h"

#include <doctest/doctest.h>

#include "path/words.h"

using namespace lsde;

TEST_CASE("a path code gives back the events appended, in order") {
    for (const std::string& word : allWords(7)) {
        PathCode code;
        for (const char letter : word) code.append(eventOf(letter));
        REQUIRE(code.letters() == word);
        REQUIRE(code.size() == static_cast<int>(word.size()));
        REQUIRE(!code.overflowed());
        REQUIRE(code.valid());
        REQUIRE(PathCode(code.bits()) == code);
    }
}

TEST_CASE("different paths have different codes, even if one continues the other with D") {
    PathCode shorter, longer;
    shorter.append(Event::Specular);
    longer.append(Event::Specular);
    longer.append(Event::Diffuse);
    CHECK(shorter != longer);
    CHECK(PathCode() != shorter);
}

TEST_CASE("a full code keeps its first 29 events, and more of them flag it") {
    PathCode code;
    std::string word;
    for (int i = 0; i < PathCode::kMaxEvents; ++i) {
        word += "SDG"[i % 3];
        code.append(eventOf(word.back()));
    }
    CHECK(code.letters() == word);
    CHECK(!code.overflowed());
    CHECK(code.valid());
    for (const Event e : {Event::Specular, Event::Diffuse, Event::Glossy}) {
        code.append(e);
        CHECK(code.size() == PathCode::kMaxEvents);
        CHECK(code.overflowed());
        CHECK(code.valid());
        CHECK(code.letters() == word + "...");
    }
}

TEST_CASE("codes that appending cannot make are not valid") {
    const auto code = [](uint64_t flag, uint64_t size, uint64_t events) {
        return PathCode(flag << 63 | size << 58 | events);
    };
    CHECK(code(0, 2, 0b10'01).valid());
    CHECK(!code(0, 2, 0b10'11).valid());     // no fourth letter
    CHECK(!code(0, 2, 0b01'10'01).valid());  // an event past the end
    CHECK(!code(0, 0, uint64_t{1} << 57).valid());
    CHECK(!code(0, 30, 0).valid());  // longer than a code can be
    CHECK(!code(0, 31, 0).valid());
    CHECK(code(0, 29, 0).valid());
    CHECK(code(1, 29, 0).valid());
    CHECK(!code(1, 28, 0).valid());  // flagged but not full
    CHECK(!PathCode(~uint64_t{0}).valid());
}
