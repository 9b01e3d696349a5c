// Which of several solids a point is in.
#include <doctest/doctest.h>

#include "base/error.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

MediaStack stackOf(std::initializer_list<MediumId> entered) {
    MediaStack s;
    for (const MediumId m : entered) s.enter(m);
    return s;
}

std::vector<Medium> mediaOf(std::initializer_list<int> priorities) {
    std::vector<Medium> media(1);
    for (const int p : priorities) media.push_back({1.5F, Rgb(0), p});
    return media;
}

}  // namespace

TEST_CASE("the solid of the highest priority is present, among equals the one entered first, else none") {
    CHECK(stackOf({}).dominant(mediaOf({0})) == kOutside);
    CHECK(stackOf({1, 2}).dominant(mediaOf({0, 0})) == 1);
    CHECK(stackOf({2, 1}).dominant(mediaOf({0, 0})) == 2);
    CHECK(stackOf({1, 2}).dominant(mediaOf({0, 1})) == 2);
    CHECK(stackOf({2, 1}).dominant(mediaOf({0, 1})) == 2);
    CHECK(stackOf({1, 2, 3}).dominant(mediaOf({-5, -1, -1})) == 2);
    CHECK(stackOf({1}).dominant(mediaOf({-5})) == 1);  // any solid rather than air
}

TEST_CASE("solids may be left in any order, and what is left is as if the others had never been entered") {
    MediaStack s = stackOf({1, 2, 3});
    s.leave(2);
    CHECK(s == stackOf({1, 3}));
    CHECK(!s.contains(2));
    s.leave(2);  // nothing
    s.leave(1);
    CHECK(s == stackOf({3}));
    s.leave(3);
    CHECK(s == MediaStack());
    CHECK(s.size() == 0);
}

TEST_CASE("a full stack refuses one more and keeps what it has") {
    MediaStack s;
    for (MediumId m = 1; m <= MediaStack::kMaxDepth; ++m) CHECK(s.enter(m));
    const MediaStack full = s;
    CHECK(!s.enter(99));
    CHECK(s == full);
}

TEST_CASE("a crossing has the solid on the side that the surface faces away from, whatever the stack said") {
    Crossing in{stackOf({1}), stackOf({1})};
    cross(in, 2, true);
    CHECK(in.before == stackOf({1}));
    CHECK(in.after == stackOf({1, 2}));
    Crossing out{stackOf({1, 2}), stackOf({1, 2})};
    cross(out, 2, false);
    CHECK(out.before == stackOf({1, 2}));
    CHECK(out.after == stackOf({1}));
    // Open meshes: entered twice, or left without having been entered.
    Crossing again{stackOf({2}), stackOf({2})};
    cross(again, 2, true);
    CHECK(again.before == stackOf({}));
    CHECK(again.after == stackOf({2}));
    Crossing never{stackOf({}), stackOf({})};
    cross(never, 2, false);
    CHECK(never.before == stackOf({2}));
    CHECK(never.after == stackOf({}));
}

TEST_CASE("a point is in the solids that surround it, the outer entered first, whatever the order of nodes") {
    for (const bool reversed : {false, true}) {
        SceneBuilder b;
        std::vector<float> radii = {3, 2, 1};
        if (reversed) std::reverse(radii.begin(), radii.end());
        for (const float r : radii) b.add(sphere({0, 0, 0}, r, 3), glass(1 + 0.1F * r), std::to_string(r));
        const auto scene = b.build();
        const MediumId outer = reversed ? 3 : 1, middle = 2, inner = reversed ? 1 : 3;
        CHECK(scene->mediaAt({0, 0, 0}) == stackOf({outer, middle, inner}));
        CHECK(scene->mediaAt({1.5F, 0, 0}) == stackOf({outer, middle}));
        CHECK(scene->mediaAt({0, -2.5F, 0}) == stackOf({outer}));
        CHECK(scene->mediaAt({0, 4, 0}) == MediaStack());
        CHECK(scene->mediaAt({0, -4, 0}) == MediaStack());
    }
}

TEST_CASE("the hollow of a solid is outside of it, and a solid in two parts is one solid") {
    SceneBuilder b;
    b.add(joined(sphere({0, 0, 0}, 2, 3), flipped(sphere({0, 0, 0}, 1, 3))), glass(1.5F), "hollow");
    b.add(joined(sphere({5, 0, 0}, 1, 3), sphere({5, 3, 0}, 1, 3)), glass(1.5F), "two");
    const auto scene = b.build();
    CHECK(scene->media().size() == 3);
    CHECK(scene->mediaAt({0, 0, 0}) == MediaStack());
    CHECK(scene->mediaAt({1.5F, 0, 0}) == stackOf({1}));
    CHECK(scene->mediaAt({5, 0, 0}) == stackOf({2}));
    CHECK(scene->mediaAt({5, 1.5F, 0}) == MediaStack());
    CHECK(scene->mediaAt({5, 3, 0}) == stackOf({2}));
}

TEST_CASE("below an open sheet of water is water") {
    SceneBuilder b;
    b.add(plate({0, 1, 0}, 2), glass(1.33F), "water");
    const auto scene = b.build();
    CHECK(scene->mediaAt({0, 0, 0}) == stackOf({1}));
    CHECK(scene->mediaAt({0, 2, 0}) == MediaStack());
}

TEST_CASE("a point below a hundred glass balls is in none of them, and within one in just that one") {
    SceneBuilder b;
    for (int i = 0; i < 100; ++i)
        b.add(
            sphere({0.0123F * static_cast<float>(i), static_cast<float>(i), 0.0071F * static_cast<float>(i)}, 0.4F, 2),
            glass(1.5F));
    b.add(box({-3, -5, -3}, {5, 200, 5}), glass(1.33F), "block");
    const auto scene = b.build();
    CHECK(scene->mediaAt({0, -2, 0}) == stackOf({101}));
    CHECK(scene->mediaAt({0, 0, 0}) == stackOf({101, 1}));
    CHECK(scene->mediaAt({0, -6, 0}) == MediaStack());
}

TEST_CASE("a solid's medium has its ior, its priority, and the absorption that leaves the colour after the distance") {
    SceneBuilder b;
    b.add(sphere({0, 0, 0}, 1, 2), glass(1.4F, {Rgb(0.5F, 1, 0), 2.0F})).priority = 7;
    const auto scene = b.build();
    const Medium& m = scene->media()[1];
    CHECK(m.ior == 1.4F);
    CHECK(m.priority == 7);
    CHECK(std::exp(-2 * m.absorption.x) == doctest::Approx(0.5));
    CHECK(m.absorption.y == 0);
    CHECK(std::exp(-2 * m.absorption.z) < 1e-20F);
    CHECK(std::isfinite(m.absorption.z));
}

TEST_CASE("solids nested deeper than the stack are refused on loading, those side by side are not") {
    const auto nested = [](int count) {
        SceneBuilder b;
        for (int i = 0; i < count; ++i)
            b.add(sphere({0, 0, 0}, static_cast<float>(count - i), 2), glass(1.5F), "ball " + std::to_string(i));
        b.build();
    };
    CHECK_NOTHROW(nested(MediaStack::kMaxDepth));
    CHECK_THROWS_WITH_AS(nested(MediaStack::kMaxDepth + 1), ": \"ball 8\" lies in 8 solids at once, limit 7", Error);
    SceneBuilder b;
    for (int i = 0; i < 30; ++i) b.add(sphere({3.0F * static_cast<float>(i), 0, 0}, 1, 1), glass(1.5F));
    CHECK_NOTHROW(b.build());
}

TEST_CASE("a solid that a ray only touches, at a corner of its outline, holds nothing before it") {
    // The ray that looks for solids goes nearly straight up: through these corners exactly.
    const Vec3 up = glm::normalize(Vec3(0.0123F, 1, 0.0071F));
    SceneBuilder b;
    for (int i = 1; i <= 20; ++i) b.add(sphere(static_cast<float>(i) * up - Vec3(0.4F, 0, 0), 0.4F, 2), glass(1.5F));
    const auto scene = b.build();
    CHECK(scene->mediaAt({0, 0, 0}) == MediaStack());
}
