#include "path/path_groups.h"

#include <doctest/doctest.h>

using namespace lsde;

namespace {

PathFilter filterOf(const std::vector<std::string>& expressions) {
    std::vector<PathLayer> layers;
    layers.reserve(expressions.size());
    for (const std::string& e : expressions) layers.push_back({"layer" + std::to_string(layers.size()), PathExpr(e)});
    return PathFilter(std::move(layers));
}

// A number's digits to base 3 as events; none for multiples of 7, more than a code holds for multiples of 11.
std::optional<PathCode> codeOf(size_t i) {
    if (i % 7 == 0) return {};
    PathCode code;
    if (i % 11 == 0)
        for (int n = 0; n <= PathCode::kMaxEvents; ++n) code.append(Event::Specular);
    else
        for (size_t n = i % 2187; n > 0; n /= 3) code.append(static_cast<Event>(n % 3));
    return code;
}

}  // namespace

TEST_CASE("each path is in the group of its state, and groups are few") {
    const PathFilter filter = filterOf({"LS+DE", "L[DS]*DS*E", "LG.*E"});
    constexpr size_t kCount = 200'000;  // several chunks
    ThreadPool pool(2);
    const PathGroups groups(filter, kCount, codeOf, ScratchPlace::Memory, pool);
    CHECK(groups.size() > 3);
    CHECK(groups.size() < 60);
    for (size_t i = 0; i < kCount; ++i) {
        const std::optional<PathCode> code = codeOf(i);
        REQUIRE((groups.of(i) == PathGroups::kNone) == !code.has_value());
        if (!code) continue;
        const auto& state = groups.state(groups.of(i));
        REQUIRE(state.has_value() == !code->overflowed());
        if (state) REQUIRE(state->state == filter.stateOf(*code).state);
    }
    for (size_t a = 0; a < groups.size(); ++a)
        for (size_t b = 0; b < a; ++b)
            CHECK((!groups.state(a) || !groups.state(b) || groups.state(a)->state != groups.state(b)->state));
}

TEST_CASE("the numbers of groups do not depend on the threads") {
    const PathFilter filter = filterOf({"L.*DE", "LS*E"});
    ThreadPool one(1), two(2);
    const PathGroups a(filter, 600'000, codeOf, ScratchPlace::Memory, one),
        b(filter, 600'000, codeOf, ScratchPlace::File, two);
    CHECK(std::equal(a.all().begin(), a.all().end(), b.all().begin(), b.all().end()));
}

TEST_CASE("groups are numbered by their first paths, and all overflowed paths share one") {
    const PathFilter filter = filterOf({"LS+DE", "L[DS]*DS*E", "LG.*E"});
    // Every 30,000 paths another kind of them sets in, the last ones overflowed: chunks begin with different groups.
    constexpr size_t kCount = 300'000, kKinds = 10;
    const auto kindOf = [](size_t i) { return (i / 30'000 + i % 3 * (i / 60'000)) % kKinds; };
    const auto code = [&](size_t i) -> std::optional<PathCode> {
        const size_t kind = kindOf(i);
        if (kind == 0) return {};
        PathCode c;
        if (kind >= 8)  // two different codes without state
            for (int n = 0; n <= PathCode::kMaxEvents; ++n) c.append(kind == 8 ? Event::Specular : Event::Diffuse);
        else
            for (size_t n = kind; n > 0; n /= 2) c.append(n % 2 == 0 ? Event::Diffuse : Event::Specular);
        return c;
    };
    ThreadPool pool(2);
    const PathGroups groups(filter, kCount, code, ScratchPlace::Memory, pool);
    uint16_t next = 0;
    for (size_t i = 0; i < kCount; ++i) {
        if (groups.of(i) == PathGroups::kNone) continue;
        REQUIRE(groups.of(i) <= next);
        if (groups.of(i) == next) ++next;
    }
    CHECK(next == groups.size());
    size_t stateless = 0;
    for (size_t g = 0; g < groups.size(); ++g) stateless += groups.state(g) ? 0 : 1;
    CHECK(stateless == 1);
}
