#include "base/bounds.h"

#include <doctest/doctest.h>

using namespace lsde;

TEST_CASE("bounds are empty until something is put in") {
    Bounds b;
    CHECK(b.empty());
    CHECK(!b.overlaps(b));
    b.grow(Bounds());
    CHECK(b.empty());
    b.grow(Vec3(1, 2, 3));
    CHECK(!b.empty());
    CHECK(b.lo == Vec3(1, 2, 3));
    CHECK(b.hi == Vec3(1, 2, 3));
    CHECK(b.radius() == 0);
}

TEST_CASE("bounds hold the points put in, and no more") {
    Bounds b;
    for (const Vec3 p : {Vec3(1, 5, -2), Vec3(-3, 4, 0), Vec3(0, 8, -1)}) b.grow(p);
    CHECK(b.lo == Vec3(-3, 4, -2));
    CHECK(b.hi == Vec3(1, 8, 0));
    CHECK(b.centre() == Vec3(-1, 6, -1));
    CHECK(b.extent() == Vec3(4, 4, 2));
    CHECK(b.radius() == doctest::Approx(3));
    Bounds all;
    all.grow(b);
    CHECK(all.lo == b.lo);
    CHECK(all.hi == b.hi);
    all.grow(Bounds());
    CHECK(all.lo == b.lo);
    CHECK(all.hi == b.hi);
}

TEST_CASE("bounds overlap if they share a point, on every axis") {
    const Bounds unit{Vec3(0), Vec3(1)};
    const auto moved = [&](Vec3 by) { return Bounds{unit.lo + by, unit.hi + by}; };
    CHECK(unit.overlaps(unit));
    CHECK(unit.overlaps({Vec3(0.4F), Vec3(0.6F)}));
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0F, 1.0F}) {
            Vec3 by(0);
            by[axis] = sign;
            CHECK(unit.overlaps(moved(0.5F * by)));
            CHECK(unit.overlaps(moved(by)));
            CHECK(!unit.overlaps(moved(1.25F * by)));
            CHECK(!moved(1.25F * by).overlaps(unit));
        }
}
