#include "photon/block_sums.h"

#include <doctest/doctest.h>

#include "photon/square.h"

using namespace lsde;
using test::photonAt;
using test::Random;
using test::Square;

namespace {

// Photons on the square [0, 1]^2 of the plane z = 0; change(photon, number) before they are packed.
template <typename Change>
PhotonTree treeWith(size_t count, const Change& change) {
    Random random(1);
    std::vector<Photon> photons;
    for (size_t i = 0; i < count; ++i) {
        Photon p = photonAt({random.uniform(), random.uniform(), 0}, random.bits());
        change(p, i);
        photons.push_back(p);
    }
    return test::treeOf(photons);
}

BlockTable tableOf(const PhotonTree& tree) {
    ThreadPool pool(1);
    const std::vector<uint16_t> groups(tree.count, 0);
    return {view(tree), groups, 1, ScratchPlace::Memory, pool};
}

size_t alike(const PhotonTree& tree, const BlockTable& table) {
    size_t count = 0;
    for (uint32_t b = 0; b < tree.blocks.size(); ++b) count += table[b].alike() ? 1 : 0;
    return count;
}

}  // namespace

TEST_CASE("a block's sums are those of its photons") {
    const Square square(1, 500, 3);
    const PhotonTreeView tree = view(square.tree);
    for (uint32_t b = 0; b < tree.count / kBlockSize; ++b) {
        const BlockSums& sums = square.blocks[1][b];
        REQUIRE(sums.alike());
        CHECK(sums.count == kBlockSize);
        Rgb power(0), first(0);
        float total = 0, spread = 0, farthest = 0;
        Vec3 middle(0);
        for (uint32_t i = b * kBlockSize; i < (b + 1) * kBlockSize; ++i) {
            const Rgb each = unpackPower(tree.payload[i].power);
            power += each;
            if (square.groups[i] == 0) first += each;
            const float p = each.x + each.y + each.z;
            total += p;
            middle += p * tree.position(i);
            spread += p * lengthSquared(tree.position(i) - sums.centre);
            farthest = std::max(farthest, glm::length(tree.position(i) - sums.centre));
        }
        CHECK(sums.total == doctest::Approx(total));
        CHECK(square.blocks[1].powers(b)[0].y == doctest::Approx(first.y));
        CHECK(square.blocks[1].powers(b)[1].y == doctest::Approx(power.y - first.y));
        CHECK(square.blocks[0].powers(b)[0].y == doctest::Approx(first.y));
        CHECK(glm::length(sums.centre - middle / total) < 1e-5F);
        CHECK(sums.spread == doctest::Approx(spread / total).epsilon(1e-4));
        CHECK(sums.radius == doctest::Approx(farthest));
    }
}

TEST_CASE("photons that count for other points are not summed together") {
    constexpr size_t kCount = 1600;
    const auto none = [](Photon&, size_t) {};
    const PhotonTree same = treeWith(kCount, none);
    CHECK(alike(same, tableOf(same)) == kCount / kBlockSize);
    // The last block is not full.
    const PhotonTree odd = treeWith(kCount - 1, none);
    CHECK(alike(odd, tableOf(odd)) == kCount / kBlockSize - 1);
    const PhotonTree behind = treeWith(kCount, [](Photon& p, size_t i) {
        if (i % 2 == 0) p.direction = -p.direction;
    });
    CHECK(alike(behind, tableOf(behind)) < 2);
    const PhotonTree media = treeWith(kCount, [](Photon& p, size_t i) { p.medium = static_cast<uint16_t>(i % 2); });
    CHECK(alike(media, tableOf(media)) < 2);
    const PhotonTree turned = treeWith(kCount, [](Photon& p, size_t i) {
        if (i % 2 == 0) p.ng = glm::normalize(Vec3(1, 0, 5));
    });
    CHECK(alike(turned, tableOf(turned)) < 2);
    const PhotonTree step = treeWith(kCount, [](Photon& p, size_t i) { p.position.z = i % 2 == 0 ? 0 : 0.01F; });
    CHECK(alike(step, tableOf(step)) < 2);
    const PhotonTree dispersed =
        treeWith(kCount, [](Photon& p, size_t) { p.wavelength = static_cast<WavelengthId>(400); });
    CHECK(alike(dispersed, tableOf(dispersed)) == 0);
}

TEST_CASE("what blocks a sphere touches hold is what it holds") {
    const Square square(2, 2000, 10);
    const KdIndex index(view(square.tree));
    Random random(3);
    ScratchList<uint32_t> blocks;
    NeighbourList all, byBlocks;
    for (int i = 0; i < 100; ++i) {
        const Vec3 centre(random.between(-1, 1), random.between(-1, 1), random.between(-0.1F, 0.1F));
        const float radius = random.between(0, 0.3F);
        index.within(centre, radius, all);
        index.blocksWithin(centre, radius, blocks);
        byBlocks.clear();
        for (const uint32_t b : blocks) index.appendWithin(b, centre, radius, byBlocks);
        REQUIRE(all.size() == byBlocks.size());
        CHECK(std::equal(all.begin(), all.end(), byBlocks.begin()));
    }
    index.blocksWithin(Vec3(std::nanf(""), 0, 0), 1, blocks);
    CHECK(blocks.empty());
}
