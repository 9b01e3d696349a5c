#include "photon/density.h"

#include <doctest/doctest.h>

#include <string>

#include "photon/brute_index.h"
#include "photon/photons.h"

using namespace lsde;
using test::photonAt;
using test::Random;
using test::treeOf;

namespace {

DensityQuery queryAtOrigin(uint32_t minCount, float minRadius, float maxRadius) {
    DensityQuery query;
    query.sideNormal = {0, 0, 1};
    query.minCount = minCount;
    query.minRadius = minRadius;
    query.maxRadius = maxRadius;
    return query;
}

struct Estimate {
    GatheredDisc disc;
    double density = 0;  // photons / m2
    std::vector<uint32_t> taken;
};

template <typename Index>
Estimate estimate(const Index& index, const DensityQuery& query) {
    DensityScratch scratch;
    Estimate e;
    e.disc = gatherPhotons(index, query, scratch, [&](uint32_t i, float weight) {
        e.density += static_cast<double>(weight);
        e.taken.push_back(i);
    });
    CHECK(e.taken.size() == e.disc.accepted);
    return e;
}

Estimate estimate(const std::vector<Photon>& photons, const DensityQuery& query) {
    const PhotonTree tree = treeOf(photons);
    return estimate(KdIndex(view(tree)), query);
}

// Mean of estimates over independent Poisson maps of 100 photons/m2, in standard errors from the truth.
struct Bias {
    double relative, sigmas;
    double deviation;  // of one estimate, relative
};
Bias biasOnPoissonMaps(const DensityQuery& query) {
    constexpr int kMaps = 8000;
    constexpr double kDensity = 100;
    constexpr float kHalf = 1;  // m: the maps are squares of twice this
    Random random(11);
    ThreadPool pool(1);
    double sum = 0, squares = 0;
    DensityScratch scratch;
    const PackedPhoton photon = pack(photonAt(Vec3(0)));
    for (int map = 0; map < kMaps; ++map) {
        std::vector<PackedPhoton> photons(random.poisson(kDensity * 4 * static_cast<double>(kHalf * kHalf)), photon);
        for (PackedPhoton& p : photons) p.position = {random.between(-kHalf, kHalf), random.between(-kHalf, kHalf), 0};
        const PhotonTree tree = buildPhotonTree(std::move(photons), pool);
        double density = 0;
        gatherPhotons(KdIndex(view(tree)), query, scratch,
                      [&](uint32_t, float w) { density += static_cast<double>(w); });
        sum += density;
        squares += density * density;
    }
    const double mean = sum / kMaps;
    const double error = std::sqrt((squares / kMaps - mean * mean) / kMaps);
    return {mean / kDensity - 1, (mean - kDensity) / error, error * std::sqrt(kMaps) / kDensity};
}

}  // namespace

TEST_CASE("an ellipse estimates an even density without bias, with the variance of as large a disc" *
          doctest::test_suite("statistics")) {
    DensityQuery query = queryAtOrigin(0, 0.1F, 0.1F);
    const Bias narrow = biasOnPoissonMaps(query);
    query.minRadius = 0.2F;
    const Bias wide = biasOnPoissonMaps(query);
    query.minRadius = 0.1F;
    query.along = std::sqrt(1 - 1 / 16.0F) * Vec3(0.6F, 0.8F, 0);
    const Bias ellipse = biasOnPoissonMaps(query);
    CHECK(std::fabs(ellipse.sigmas) < 3);
    // Four times as long: of four times the area, like a disc of twice the radius.
    CHECK(ellipse.deviation == doctest::Approx(wide.deviation).epsilon(0.05));
    CHECK(narrow.deviation > 1.8 * ellipse.deviation);
}

TEST_CASE("an ellipse holds what its norm says, of those off the plane what a disc of its width would") {
    std::vector<Photon> photons;
    const Vec3 direction(0.6F, 0.8F, 0), across(-0.8F, 0.6F, 0);
    const auto at = [&](float t, float q, float z) {
        photons.push_back(photonAt(t * direction + q * across + Vec3(0, 0, z)));
    };
    at(0.39F, 0, 0);
    at(0.41F, 0, 0);
    at(0, 0.09F, 0);
    at(0, 0.11F, 0);
    at(0.2F, 0.08F, 0);
    at(0.2F, 0.09F, 0);  // (0.2 / 4)^2 + 0.09^2 > 0.1^2
    at(0.2F, 0, 0.019F);
    at(0.2F, 0, 0.021F);  // above a fifth of the half width
    DensityQuery query = queryAtOrigin(0, 0.1F, 0.1F);
    query.along = std::sqrt(1 - 1 / 16.0F) * direction;
    const Estimate e = estimate(photons, query);
    CHECK(e.disc.accepted == 4);
    CHECK(e.disc.stretch == doctest::Approx(4));
    // Too few for what the query wants: a disc that grows.
    query.minCount = 5;
    query.maxRadius = 1;
    CHECK(estimate(photons, query).disc.stretch == 1);
}

TEST_CASE("every n-th photon with n times its weight has the light of all, in the mean over where one begins") {
    constexpr uint32_t kStride = 8;
    for (const bool mixed : {false, true}) {
        Random random(3);
        std::vector<Photon> photons;
        for (int i = 0; i < 4000; ++i) {
            const float z = mixed ? random.between(-0.1F, 0.1F) : 0;
            photons.push_back(photonAt({random.between(-1, 1), random.between(-1, 1), z}));
            photons.back().medium = static_cast<uint16_t>(mixed && i % 3 == 0);
        }
        const PhotonTree tree = treeOf(photons);
        for (const float stretch : {1.0F, 2.0F}) {
            CAPTURE(mixed);
            CAPTURE(stretch);
            DensityQuery query = queryAtOrigin(0, 0.4F, 0.4F);
            query.along = std::sqrt(1 - 1 / square(stretch)) * Vec3(0.6F, 0.8F, 0);
            const Estimate all = estimate(KdIndex(view(tree)), query);
            DensityScratch scratch;
            std::vector<uint32_t> taken;
            double mean = 0, variance = 0;
            for (uint32_t first = 0; first < kStride; ++first) {
                double density = 0;
                const size_t before = taken.size();
                const auto take = [&](uint32_t i, float weight) {
                    density += static_cast<double>(weight);
                    taken.push_back(i);
                };
                const GatheredDisc disc = gatherSome(view(tree), query, {kStride, first}, scratch, take);
                CHECK(disc.radius == query.minRadius);
                CHECK(disc.stretch == doctest::Approx(stretch));
                CHECK(disc.accepted == taken.size() - before);
                mean += density / kStride;
                variance += square(density / all.density - 1) / kStride;
            }
            std::sort(taken.begin(), taken.end());
            CHECK(taken == all.taken);
            CHECK(mean == doctest::Approx(all.density));
            // Drawn by chance as many would have a variance of 4/3 of one over their number, with this kernel. Every
            // n-th lies evenly.
            if (!mixed) CHECK(variance < 0.1 * (4 / 3.0) * kStride / static_cast<double>(all.disc.accepted));
        }
    }
}

TEST_CASE("the kernel has mass 1, and the share within a radius is its integral") {
    double mass = 0;
    constexpr int kSteps = 10'000;
    const float radius = 0.3F;
    for (int i = 0; i < kSteps; ++i) {
        const float r = radius * (static_cast<float>(i) + 0.5F) / kSteps;
        mass += static_cast<double>(epanechnikov(r * r, radius * radius) * 2 * kPi * r * radius / kSteps);
        if (i == kSteps / 2 - 1)
            CHECK(mass == doctest::Approx(static_cast<double>(epanechnikovWithin(0.5F))).epsilon(1e-4));
    }
    CHECK(mass == doctest::Approx(1).epsilon(1e-4));
    CHECK(epanechnikovWithin(1) == 1);
}

TEST_CASE("the estimate of a uniform density has no bias in any regime of the radius" *
          doctest::test_suite("statistics")) {
    const struct {
        std::string name;
        uint32_t minCount;
        float minRadius, maxRadius;
    } regimes[] = {{"least radius", 2, 0.25F, 0.9F},  // holds 20 photons on average
                   {"grown to 5 photons", 5, 0.001F, 0.9F}, {"grown to 20 photons", 20, 0.001F, 0.9F},
                   {"grown or not", 20, 0.25F, 0.9F},       {"grown to the largest radius or not", 20, 0.001F, 0.25F},
                   {"all of them", 20, 0.23F, 0.27F}};
    for (const auto& r : regimes) {
        const Bias bias = biasOnPoissonMaps(queryAtOrigin(r.minCount, r.minRadius, r.maxRadius));
        MESSAGE(r.name << ": bias " << 100 * bias.relative << " %, " << bias.sigmas << " sigma");
        CHECK(std::fabs(bias.sigmas) < 3.5);
    }
}

TEST_CASE("that a radius must be balanced adds no bias where light is even" * doctest::test_suite("statistics")) {
    for (const auto& [minCount, minRadius] : {std::pair(20U, 0.001F), std::pair(20U, 0.25F), std::pair(50U, 0.001F)}) {
        DensityQuery query = queryAtOrigin(minCount, minRadius, 0.9F);
        query.balanced = true;
        const Bias bias = biasOnPoissonMaps(query);
        MESSAGE(minCount << " photons: bias " << 100 * bias.relative << " %, " << bias.sigmas << " sigma");
        CHECK(std::fabs(bias.relative) < 0.01);
        CHECK(std::fabs(bias.sigmas) < 3.5);
    }
}

TEST_CASE("a balanced radius does not reach over an edge into the light") {
    // 25 and 10000 photons a m2: the disc of 20 at 5 cm from the edge ends within the light, balanced or not.
    Random random(3);
    double grown = 0, balanced = 0;
    constexpr int kMaps = 300;
    for (int map = 0; map < kMaps; ++map) {
        std::vector<Photon> photons;
        for (const auto& [from, to, density] : {std::tuple(-1.0F, 0.05F, 25.0), std::tuple(0.05F, 1.0F, 10'000.0)})
            for (uint32_t n = random.poisson(density * static_cast<double>(2 * (to - from))); n-- > 0;)
                photons.push_back(photonAt({random.between(from, to), random.between(-1, 1), 0}, random.bits()));
        const PhotonTree tree = treeOf(photons);
        DensityQuery query = queryAtOrigin(20, 0.01F, 0.9F);
        grown += estimate(KdIndex(view(tree)), query).density / kMaps;
        query.balanced = true;
        balanced += estimate(KdIndex(view(tree)), query).density / kMaps;
    }
    MESSAGE("grown: ", grown, ", balanced: ", balanced);
    CHECK(grown > 100);
    CHECK(balanced < 40);
}

TEST_CASE("a photon just outside the radius does not contribute") {
    const DensityQuery query = queryAtOrigin(0, 0.5F, 0.5F);
    CHECK(estimate({photonAt({0.4999F, 0, 0})}, query).disc.accepted == 1);
    CHECK(estimate({photonAt({0.5F, 0, 0})}, query).disc.accepted == 0);
    CHECK(estimate({photonAt({0.5001F, 0, 0})}, query).disc.accepted == 0);
}

TEST_CASE("the radius starts at the least, grows to hold enough photons, and stops at the largest") {
    std::vector<Photon> photons;
    for (int i = 1; i <= 100; ++i) photons.push_back(photonAt({0.01F * static_cast<float>(i), 0, 0}));
    CHECK(estimate(photons, queryAtOrigin(20, 0.505F, 2)).disc.radius == doctest::Approx(0.505F));
    CHECK(estimate(photons, queryAtOrigin(20, 0.505F, 2)).disc.accepted == 50);
    CHECK(estimate(photons, queryAtOrigin(20, 0.01F, 2)).disc.radius == doctest::Approx(0.2F));
    CHECK(estimate(photons, queryAtOrigin(20, 0, 2)).disc.radius == doctest::Approx(0.2F));
    CHECK(estimate(photons, queryAtOrigin(20, 0.01F, 0.105F)).disc.radius == 0.105F);
    CHECK(estimate(photons, queryAtOrigin(20, 0.01F, 0.105F)).disc.accepted == 10);
    CHECK(estimate(photons, queryAtOrigin(1000, 0.01F, 2)).disc.radius == 2);
    CHECK(estimate({}, queryAtOrigin(20, 0.01F, 2)).disc.radius == 2);
    CHECK(estimate(photons, queryAtOrigin(20, 0, 0)).disc.accepted == 0);
}

TEST_CASE("photons lit from the other side, or on the other side of a sheet, do not count") {
    Photon photon = photonAt(Vec3(0.1F, 0, 0));
    DensityQuery query = queryAtOrigin(0, 1, 1);
    CHECK(estimate({photon}, query).disc.accepted == 1);
    query.sideNormal = {0, 0, -1};
    CHECK(estimate({photon}, query).disc.accepted == 0);
    photon.direction = {0.6F, 0, -0.8F};
    CHECK(estimate({photon}, query).disc.accepted == 1);
    photon.ng = {0, 0, -1};
    CHECK(estimate({photon}, query).disc.accepted == 0);
}

TEST_CASE("photons on a surface turned away by more than 45 degrees do not count") {
    for (int degrees = 0; degrees < 180; degrees += 3) {
        const float angle = static_cast<float>(degrees) * kPi / 180;
        Photon photon = photonAt(Vec3(0.1F, 0, 0));
        photon.ng = {std::sin(angle), 0, std::cos(angle)};
        if (std::abs(degrees - 46) > 2)
            CHECK(estimate({photon}, queryAtOrigin(0, 1, 1)).disc.accepted == (degrees < 45 ? 1 : 0));
    }
}

TEST_CASE("photons of another medium, or without the flags asked for, do not count") {
    Photon photon = photonAt(Vec3(0.1F, 0, 0));
    photon.medium = 3;
    photon.flags = kFromDeltaLight;
    DensityQuery query = queryAtOrigin(0, 1, 1);
    CHECK(estimate({photon}, query).disc.accepted == 0);
    query.medium = 3;
    CHECK(estimate({photon}, query).disc.accepted == 1);
    query.requiredFlags = kGlossyGather;
    CHECK(estimate({photon}, query).disc.accepted == 0);
    photon.flags = kFromDeltaLight | kGlossyGather;
    CHECK(estimate({photon}, query).disc.accepted == 1);
}

TEST_CASE("photons beyond the plane's thickness do not count until the radius has grown") {
    const auto accepted = [](float height, float radius) {
        return estimate({photonAt(Vec3(0.01F, 0, height))}, queryAtOrigin(0, radius, radius)).disc.accepted;
    };
    CHECK(accepted(0.9F * kPlaneThickness, 1) == 1);
    CHECK(accepted(-0.9F * kPlaneThickness, 1) == 1);
    CHECK(accepted(1.1F * kPlaneThickness, 1) == 0);
    CHECK(accepted(-1.1F * kPlaneThickness, 1) == 0);
    CHECK(accepted(1.1F * kPlaneThickness, 1.2F) == 1);
    // Grown to hold three: those of the plane, not the many of steps that are closer by.
    std::vector<Photon> photons;
    photons.reserve(60);
    for (int i = 0; i < 50; ++i) photons.push_back(photonAt({0, 0, 0.0602F + 0.001F * static_cast<float>(i)}));
    for (int i = 1; i <= 3; ++i) photons.push_back(photonAt({0.1F * static_cast<float>(i), 0, 0}));
    const Estimate grown = estimate(photons, queryAtOrigin(3, 0, 1));
    CHECK(grown.disc.radius == doctest::Approx(0.3F));
    CHECK(grown.taken.size() == 2);  // and the third on the rim
}

TEST_CASE("rounded positions far from the origin do not lie beyond the plane, however small the radius") {
    const Vec3 normal = glm::normalize(Vec3(1, 2, 3));
    const Frame frame(normal);
    Random random(12);
    std::vector<Photon> photons;
    for (int i = 0; i < 1000; ++i) {
        Photon p =
            photonAt(Vec3(100, 50, 20) + 2e-5F * (frame.x * random.between(-1, 1) + frame.y * random.between(-1, 1)));
        p.ng = p.direction = normal;
        photons.push_back(p);
    }
    DensityQuery query = queryAtOrigin(0, 6e-6F, 6e-6F);
    query.point.position = {100, 50, 20};
    query.point.ng = query.sideNormal = normal;
    const PhotonTree tree = treeOf(photons);
    NeighbourList near;
    BruteIndex(view(tree)).within(query.point.position, query.minRadius, near);
    CHECK(near.size() > 0);
    CHECK(estimate(KdIndex(view(tree)), query).disc.accepted == near.size());
}

TEST_CASE("the estimate on a sphere is that of its density") {
    Random random(13);
    std::vector<Photon> photons;
    for (int i = 0; i < 200'000; ++i) {
        Photon p = photonAt(random.onSphere());
        p.ng = p.direction = p.position;
        photons.push_back(p);
    }
    const PhotonTree tree = treeOf(photons);
    const KdIndex index(view(tree));
    double sum = 0;
    constexpr int kQueries = 300;
    for (int i = 0; i < kQueries; ++i) {
        DensityQuery query = queryAtOrigin(0, 0.35F, 0.35F);
        query.point.position = query.point.ng = query.sideNormal = random.onSphere();
        sum += estimate(index, query).density / kQueries;
    }
    // 500 photons a disc, discs that overlap.
    CHECK(sum == doctest::Approx(photons.size() / (4 * static_cast<double>(kPi))).epsilon(0.01));
}

TEST_CASE("estimates agree over all indices") {
    Random random(14);
    std::vector<Photon> photons;
    for (int i = 0; i < 20'000; ++i) {
        Photon p = photonAt({random.uniform(), std::pow(random.uniform(), 3.0F), 0.02F * random.uniform()});
        p.medium = static_cast<uint16_t>(random.bits() % 2);
        photons.push_back(p);
    }
    const PhotonTree tree = treeOf(photons);
    const KdIndex kd(view(tree));
    const FlannIndex flann(view(tree));
    const BruteIndex brute(view(tree));
    for (int i = 0; i < 200; ++i) {
        DensityQuery query = queryAtOrigin(random.bits() % 60 + 2, random.between(0, 0.05F), random.between(0, 0.2F));
        query.point.position = {random.uniform(), random.uniform(), 0.01F};
        const Estimate a = estimate(kd, query), b = estimate(brute, query);
        Estimate c = estimate(flann, query);
        CHECK(a.taken == b.taken);
        CHECK(a.disc.radius == b.disc.radius);
        CHECK(c.disc.radius == b.disc.radius);
        std::sort(c.taken.begin(), c.taken.end());
        CHECK(c.taken == b.taken);
    }
}

TEST_CASE("the distance to the k-th photon is that of sorting, and the largest radius where there are fewer") {
    const PhotonTree tree = treeOf({Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)});
    DensityScratch scratch;
    for (const AnyIndex& index : {AnyIndex(std::in_place_type<KdIndex>, view(tree))}) {
        CHECK(distanceToKth(index, Vec3(0), 1, 10, scratch) == 1);
        CHECK(distanceToKth(index, Vec3(0), 3, 10, scratch) == 3);
        CHECK(distanceToKth(index, Vec3(0), 4, 10, scratch) == 10);
        CHECK(distanceToKth(index, Vec3(0), 3, 2.5F, scratch) == 2.5F);
    }
    const AnyIndex flann(std::in_place_type<FlannIndex>, view(tree));
    CHECK(distanceToKth(flann, Vec3(0), 2, 10, scratch) == 2);
}
