#include "photon/index.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>

#include "base/error.h"
#include "photon/brute_index.h"
#include "photon/photons.h"

using namespace lsde;
using test::Random;
using test::treeOf;

static_assert(PhotonIndex<KdIndex> && PhotonIndex<FlannIndex> && PhotonIndex<BruteIndex>);

namespace {

struct Cloud {
    std::string name;
    std::function<Vec3(Random&)> point;
};

const Cloud kClouds[] = {
    {"a cube", [](Random& r) { return r.inCube(); }},
    {"a plane", [](Random& r) { return Vec3(r.uniform(), 0, r.uniform()); }},
    {"a sphere far from the origin", [](Random& r) { return Vec3(1000, -2000, 500) + r.onSphere(); }},
    {"a focus", [](Random& r) { return std::pow(r.uniform(), 6.0F) * Vec3(r.onSphere().x, r.onSphere().y, 0); }},
    {"a line", [](Random& r) { return Vec3(0.5F, r.uniform(), 0.5F); }},
    {"a coarse grid, with many at the same place", [](Random& r) { return glm::floor(r.inCube() * 4.0F) * 0.25F; }},
    {"one place", [](Random&) { return Vec3(0.25F); }},
    {"two places far apart", [](Random& r) { return r.uniform() < 0.1F ? Vec3(-1e15F) : Vec3(1e15F, 0, 0); }},
    {"tiny coordinates", [](Random& r) { return 1e-20F * r.inCube(); }},
};

std::vector<Vec3> pointsOf(const Cloud& cloud, size_t count, uint32_t seed = 1) {
    Random random(seed);
    std::vector<Vec3> points(count);
    for (Vec3& p : points) p = cloud.point(random);
    return points;
}

std::vector<Neighbour> sorted(const NeighbourList& list) {
    std::vector<Neighbour> out(list.begin(), list.end());
    std::sort(out.begin(), out.end());
    return out;
}

// Queries at photons, between them, around the bounds, and far outside.
Vec3 queryPoint(const PhotonTree& tree, Random& random, int i) {
    if (tree.count == 0) return random.inCube();
    const auto photon = [&] { return view(tree).position(static_cast<uint32_t>(random.bits() % tree.count)); };
    if (i % 4 == 0) return photon();
    if (i % 4 == 1) return 0.5F * (photon() + photon());
    const Vec3 size = tree.bounds.extent() + 1e-3F * glm::length(tree.bounds.extent());
    return tree.bounds.centre() + (i % 4 == 2 ? 1.0F : 10.0F) * size * (random.inCube() - 0.5F);
}

void checkAgreement(const PhotonTree& tree, uint32_t seed) {
    const KdIndex kd(view(tree));
    const FlannIndex flann(view(tree));
    const BruteIndex brute(view(tree));
    Random random(seed);
    NeighbourList a, b, c;
    const float size = tree.count == 0 ? 1 : glm::length(tree.bounds.extent()) + 1e-9F;
    for (int i = 0; i < 60; ++i) {
        const Vec3 centre = queryPoint(tree, random, i);
        const float radius = i % 10 == 9 ? kInfinity : size * std::pow(10.0F, random.between(-3, 0.7F));
        CAPTURE(i);
        CAPTURE(radius);
        kd.within(centre, radius, a);
        flann.within(centre, radius, b);
        brute.within(centre, radius, c);
        REQUIRE(std::is_sorted(a.begin(), a.end(), [](auto& x, auto& y) { return x.index < y.index; }));
        REQUIRE(sorted(a) == sorted(c));
        REQUIRE(sorted(b) == sorted(c));

        const uint32_t k = random.bits() % (i % 3 == 0 ? 200 : 20);
        const auto accept = [&](uint32_t index) { return i % 2 == 0 || index % 3 == 0; };
        kd.nearest(centre, k, radius, a, accept);
        flann.nearest(centre, k, radius, b, accept);
        brute.nearest(centre, k, radius, c, accept);
        REQUIRE(std::equal(a.begin(), a.end(), c.begin(), c.end()));
        REQUIRE(std::equal(b.begin(), b.end(), c.begin(), c.end()));
    }
}

}  // namespace

TEST_CASE("all indices find the same photons at the same distances") {
    for (const Cloud& cloud : kClouds)
        for (const size_t count : {0, 1, 2, 15, 16, 17, 128, 129, 1024, 1025, 5000}) {
            CAPTURE(cloud.name);
            CAPTURE(count);
            checkAgreement(treeOf(pointsOf(cloud, count)), static_cast<uint32_t>(count));
        }
}

TEST_CASE("every n-th of the photons within a radius, from each place on, are all of them") {
    Random random(5);
    NeighbourList all, some;
    for (const Cloud& cloud : kClouds)
        for (const size_t count : {0, 1, 17, 1025, 5000}) {
            CAPTURE(cloud.name);
            CAPTURE(count);
            const PhotonTree tree = treeOf(pointsOf(cloud, count));
            const KdIndex kd(view(tree));
            const float size = tree.count == 0 ? 1 : glm::length(tree.bounds.extent()) + 1e-9F;
            for (const uint32_t stride : {1U, 2U, 16U, 64U}) {
                const Vec3 centre = queryPoint(tree, random, static_cast<int>(stride));
                const float radius = size * std::pow(10.0F, random.between(-2, 0.7F));
                std::vector<Neighbour> together;
                for (uint32_t first = 0; first < stride; ++first) {
                    kd.someWithin(centre, radius, {stride, first}, some);
                    for (const Neighbour& n : some) REQUIRE(n.index % stride == first);
                    together.insert(together.end(), some.begin(), some.end());
                }
                std::sort(together.begin(), together.end());
                kd.within(centre, radius, all);
                REQUIRE(together == sorted(all));
            }
        }
}

TEST_CASE("all indices find the same among a million photons") {
    // A cube, a plane, a focus and a coarse grid at once: from sparse to 3000 photons at one place.
    const size_t mixed[] = {0, 1, 3, 5};
    Random random(8);
    std::vector<Vec3> points(1'000'000);
    for (Vec3& p : points) p = kClouds[mixed[random.bits() % 4]].point(random);
    const PhotonTree tree = treeOf(points);
    const KdIndex kd(view(tree));
    const FlannIndex flann(view(tree));
    const BruteIndex brute(view(tree));
    NeighbourList a, b, c;
    for (int i = 0; i < 48; ++i) {
        const Vec3 centre = (i % 8 == 7 ? 1000.0F : 1.0F) * queryPoint(tree, random, i);
        const uint32_t k = i % 3 == 0 ? 200 : 50;
        CAPTURE(i);
        kd.nearest(centre, k, kInfinity, a);
        flann.nearest(centre, k, kInfinity, b);
        REQUIRE(a.size() == k);
        // Brute force sorts only what is no farther than the tree's answer: a nearer photon that it missed is there.
        const float reach = std::sqrt(a[k - 1].distanceSquared);
        brute.nearest(centre, k, 1.001F * reach + 1e-6F, c);
        REQUIRE(std::equal(a.begin(), a.end(), c.begin(), c.end()));
        REQUIRE(std::equal(b.begin(), b.end(), c.begin(), c.end()));
        // As far as the last one itself, which is out or in by one rounding, and farther.
        for (const float radius : {reach, 1.5F * reach}) {
            if (i % 8 == 7 && radius > reach) continue;  // holds all photons
            CAPTURE(radius);
            kd.within(centre, radius, a);
            flann.within(centre, radius, b);
            brute.within(centre, radius, c);
            REQUIRE(std::equal(a.begin(), a.end(), c.begin(), c.end()));
            REQUIRE(sorted(b) == sorted(c));
        }
    }
}

TEST_CASE("a query that is not finite finds nothing") {
    const PhotonTree tree = treeOf(pointsOf(kClouds[0], 1000));
    const FlannIndex flann(view(tree));
    NeighbourList found;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity})
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 centre(0.5F);
            centre[axis] = bad;
            KdIndex(view(tree)).within(centre, kInfinity, found);
            CHECK(found.empty());
            KdIndex(view(tree)).nearest(centre, 5, kInfinity, found);
            CHECK(found.empty());
            flann.within(centre, kInfinity, found);
            CHECK(found.empty());
        }
    KdIndex(view(tree)).within(Vec3(0.5F), std::numeric_limits<float>::quiet_NaN(), found);
    CHECK(found.empty());
    KdIndex(view(tree)).within(Vec3(kAbsentPhoton), kInfinity, found);
    CHECK(found.empty());
}

TEST_CASE("radii exclude photons exactly at their end") {
    const PhotonTree tree = treeOf({Vec3(0), Vec3(3, 0, 4), Vec3(0, 0, 5)});
    NeighbourList found;
    KdIndex(view(tree)).within(Vec3(0), 5, found);
    CHECK(found.size() == 1);
    KdIndex(view(tree)).within(Vec3(0), std::nextafter(5.0F, 6.0F), found);
    CHECK(found.size() == 3);
}

TEST_CASE("photons of equal distance are taken by index") {
    std::vector<Vec3> ring;
    ring.reserve(400);
    for (int i = 0; i < 400; ++i) ring.emplace_back(i % 2, i / 2 % 2, 0);
    const PhotonTree tree = treeOf(ring);
    NeighbourList found;
    KdIndex(view(tree)).nearest({0.5F, 0.5F, 0}, 100, kInfinity, found);
    REQUIRE(found.size() == 100);
    for (uint32_t i = 0; i < 100; ++i) CHECK(found[i].index == i);
}

TEST_CASE("a photon at no finite place is refused") {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -1e19F}) {
        std::vector<PackedPhoton> photons(100);
        photons[42].position.z = bad;
        ThreadPool pool(1);
        CHECK_THROWS_WITH_AS(buildPhotonTree(std::move(photons), pool), doctest::Contains("position"), Error);
    }
}

TEST_CASE("order statistics by buckets agree with sorting") {
    Random random(7);
    for (int i = 0; i < 2000; ++i) {
        std::vector<float> values(1 + random.bits() % 300);
        const float bound = std::pow(10.0F, random.between(-38, 38));
        for (float& v : values)
            v = 0.999F * bound * (i % 3 == 0 ? std::pow(random.uniform(), 20.0F) : random.uniform());
        NeighbourList list;
        for (const float v : values) list.push({static_cast<uint32_t>(list.size()), v});
        std::vector<Neighbour> expected = sorted(list);
        const size_t k = 1 + random.bits() % values.size();
        CHECK(kthSmallest(values, k, bound) == expected[k - 1].distanceSquared);
        keepNearest(list, k, bound);
        expected.resize(k);
        CHECK(sorted(list) == expected);
        CHECK(std::is_sorted(list.begin(), list.end()));
    }
}

namespace {

// Floor, wall and ceiling of a room, to rounding, which puts a photon before its plane or behind.
std::vector<Vec3> corner(size_t count, Random& random) {
    std::vector<Vec3> points(count);
    for (Vec3& p : points) {
        const float x = random.between(-1, 1), z = random.between(-1, 1);
        const float jitter = static_cast<float>(random.bits() % 3) * 2.4e-7F - 2.4e-7F;
        const uint32_t face = random.bits() % 3;
        p = face == 0 ? Vec3(x, 2 + jitter, z) : face == 1 ? Vec3(-1 + jitter, x + 1, z) : Vec3(x, jitter, z);
    }
    return points;
}

}  // namespace

TEST_CASE("the nearest block holds the nearest photon") {
    Random random(5);
    for (const size_t count : {1, 16, 17, 1000, 20'000}) {
        CAPTURE(count);
        const PhotonTree tree = treeOf(corner(count, random));
        for (int i = 0; i < 300; ++i) {
            const Vec3 p = queryPoint(tree, random, i);
            NeighbourList nearest;
            BruteIndex(view(tree)).nearest(p, 1, kInfinity, nearest);
            REQUIRE(nearest.size() == 1);
            const Vec3 found = view(tree).position(nearest[0].index);
            bool holds = false;
            const uint32_t block = nearestBlock(view(tree), p);
            for (uint32_t k = kBlockSize * block; k < std::min<uint64_t>(tree.count, kBlockSize * (block + 1)); ++k)
                holds |= lengthSquared(view(tree).position(k) - p) <= lengthSquared(found - p) * (1 + 1e-6F);
            CHECK(holds);
        }
    }
}

TEST_CASE("blocks of photons on a plane do not overlap where rounding puts some behind it") {
    Random random(6);
    std::vector<Vec3> points(40'000);
    // Three quarters on a ceiling, on which the middle of a high wall's photons falls.
    for (size_t i = 0; i < points.size(); ++i) {
        const float jitter = static_cast<float>(random.bits() % 2) * 2.4e-7F;
        const Vec3 ceiling(random.between(-1, 1), 2 + jitter, random.between(-1, 1));
        points[i] = i % 4 > 0 ? ceiling : Vec3(-1, 2 - 4 * random.uniform(), ceiling.z);
    }
    const PhotonTree tree = treeOf(points);
    double area = 0;
    size_t photons = 0;
    for (uint32_t b = 0; kBlockSize * (b + 1) <= tree.count; ++b) {
        Bounds box;
        for (uint32_t k = 0; k < kBlockSize; ++k) box.grow(view(tree).position(kBlockSize * b + k));
        if (box.lo.y < 1.999F) continue;
        area += static_cast<double>(boxArea(view(tree), b));
        photons += kBlockSize;
    }
    CHECK(photons > 25'000);
    // 7500 photons a m2; boxes that just hold 16 of them are somewhat smaller than their share of the ceiling.
    MESSAGE("share of the ceiling: ", area * 7500 / static_cast<double>(photons));
    CHECK(area * 7500 / static_cast<double>(photons) == doctest::Approx(0.8).epsilon(0.15));
}
