// Queries of the packed kd-tree and of FLANN's, on photons like those of two kinds of scene.
//
// Time is nanoseconds a query. Queries by radius and of the k nearest are answered with a list of photons and their
// distances, density estimates with a sum of weights over 20 photons or more. Names: PHOTONS/QUERY/ORDER/INDEX.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "photon/density.h"

using namespace lsde;

namespace {

struct Workload {
    std::string name;
    PhotonTree tree;
    std::vector<SurfacePoint> imageOrder, shuffled;
    std::unique_ptr<KdIndex> kd;
    std::unique_ptr<FlannIndex> flann;
};

using Random = std::mt19937;
float uniform(Random& random) { return static_cast<float>(random() >> 8) * 0x1p-24F; }

SurfacePoint surface(Vec3 position, Vec3 normal) { return {position, normal, normal}; }

// As under a glass ball: a focus, a bright rim that falls off inwards (a fold), and some light everywhere.
SurfacePoint photonOfConcentrated(Random& random) {
    const float kind = uniform(random), u = uniform(random), angle = 2 * kPi * uniform(random);
    const float radius = kind < 0.4F ? 0.2F * u * u * u : kind < 0.8F ? 0.5F - 0.5F * u * u : 2 * std::sqrt(u);
    return surface({radius * std::cos(angle), 0, radius * std::sin(angle)}, {0, 1, 0});
}

SurfacePoint pointOnWall(int wall, float u, float v) {
    Vec3 p, normal(0);
    p[wall % 3] = wall < 3 ? 0.0F : 1.0F;
    normal[wall % 3] = wall < 3 ? 1.0F : -1.0F;
    p[(wall + 1) % 3] = u;
    p[(wall + 2) % 3] = v;
    return surface(p, normal);
}

// As in a room with a metal ring: walls evenly lit, and a cardioid a few millimetres thin on the floor.
SurfacePoint photonOfBox(Random& random) {
    const float u = uniform(random), v = uniform(random);
    if (uniform(random) < 0.8F) return pointOnWall(static_cast<int>(random() % 6), u, v);
    const float angle = 2 * kPi * u, radius = 0.15F * (1 - std::cos(angle)) - 0.004F * v * v;
    return surface({0.5F + radius * std::cos(angle), 0, 0.5F + radius * std::sin(angle)}, {0, 1, 0});
}

std::vector<PackedPhoton> photonsOf(size_t count, const std::function<SurfacePoint(Random&)>& photon) {
    Random random(1);
    std::vector<PackedPhoton> photons(count);
    for (PackedPhoton& p : photons) {
        const SurfacePoint point = photon(random);
        p.position = point.position;
        p.payload.normal = packNormal(point.ng);
        p.payload.direction = packDirection(point.ng);
    }
    return photons;
}

PhotonTree treeOf(size_t count, const std::function<SurfacePoint(Random&)>& photon) {
    ThreadPool pool;
    return buildPhotonTree(photonsOf(count, photon), pool);
}

void finish(Workload& w) {
    w.shuffled = w.imageOrder;
    std::shuffle(w.shuffled.begin(), w.shuffled.end(), Random(2));
    w.kd = std::make_unique<KdIndex>(view(w.tree));
    w.flann = std::make_unique<FlannIndex>(view(w.tree));
}

Workload concentrated() {
    Workload w{"concentrated1M", treeOf(1'000'000, photonOfConcentrated), {}, {}, {}, {}};
    for (int y = 0; y < 512; ++y)
        for (int x = 0; x < 512; ++x)
            w.imageOrder.push_back(
                surface({1.2F * (static_cast<float>(x) / 512 - 0.5F), 0, 1.2F * (static_cast<float>(y) / 512 - 0.5F)},
                        {0, 1, 0}));
    finish(w);
    return w;
}

Workload box() {
    Workload w{"box10M", treeOf(10'000'000, photonOfBox), {}, {}, {}, {}};
    for (int wall = 0; wall < 6; ++wall)
        for (int y = 0; y < 512; ++y)
            for (int x = 0; x < 512; ++x)
                w.imageOrder.push_back(
                    pointOnWall(wall, (static_cast<float>(x) + 0.5F) / 512, (static_cast<float>(y) + 0.5F) / 512));
    finish(w);
    return w;
}

// The radius (m) that holds `count` photons at the mean of the queries.
float radiusForMean(const Workload& w, double count) {
    float low = 0, high = 1;
    for (int step = 0; step < 24; ++step) {
        const float radius = 0.5F * (low + high);
        NeighbourList found;
        double sum = 0;
        size_t queries = 0;
        for (size_t i = 0; i < w.shuffled.size(); i += 17, ++queries) {
            w.kd->within(w.shuffled[i].position, radius, found);
            sum += static_cast<double>(found.size());
            if (sum > count * static_cast<double>(w.shuffled.size())) break;
        }
        (sum < count * static_cast<double>(queries) ? low : high) = radius;
    }
    return low;
}

template <typename Query>
void run(benchmark::State& state, const std::vector<SurfacePoint>& queries, const Query& query) {
    DensityScratch scratch;
    size_t i = 0;
    double photons = 0;
    for (auto _ : state) {
        photons += static_cast<double>(query(queries[i], scratch));
        if (++i == queries.size()) i = 0;
    }
    state.counters["photons"] = benchmark::Counter(photons, benchmark::Counter::kAvgIterations);
}

template <typename Index>
void addQueries(const Workload& w, const Index& index, const std::string& indexName) {
    for (const bool ordered : {true, false}) {
        const std::vector<SurfacePoint>& queries = ordered ? w.imageOrder : w.shuffled;
        const auto add = [&](const std::string& kind, const auto& query) {
            const std::string name =
                fmt::format("{}/{}/{}/{}", w.name, kind, ordered ? "image" : "shuffled", indexName);
            benchmark::RegisterBenchmark(name.c_str(), [=, &queries](auto& state) { run(state, queries, query); });
        };
        for (const uint32_t count : {50U, 200U}) {
            add("radius" + std::to_string(count),
                [&index, radius = radiusForMean(w, count)](const SurfacePoint& q, DensityScratch& s) {
                    index.within(q.position, radius, s.found);
                    return s.found.size();
                });
            add("knn" + std::to_string(count), [&index, count](const SurfacePoint& q, DensityScratch& s) {
                index.nearest(q.position, count, kInfinity, s.found);
                return s.found.size();
            });
        }
        add("density20", [&index, radius = radiusForMean(w, 80)](const SurfacePoint& q, DensityScratch& s) {
            const DensityQuery query{
                .point = q, .sideNormal = q.ng, .minCount = 20, .minRadius = radius / 10, .maxRadius = radius};
            float sum = 0;
            const GatheredDisc disc = gatherPhotons(index, query, s, [&](uint32_t, float weight) { sum += weight; });
            benchmark::DoNotOptimize(sum);
            return disc.accepted;
        });
    }
}

void addBuild() {
    benchmark::RegisterBenchmark("build1M/1thread", [](auto& state) {
        const std::vector<PackedPhoton> photons = photonsOf(1'000'000, photonOfConcentrated);
        ThreadPool pool(1);
        while (state.KeepRunning()) {
            state.PauseTiming();
            auto copy = photons;
            state.ResumeTiming();
            benchmark::DoNotOptimize(buildPhotonTree(std::move(copy), pool));
        }
    })->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    const Workload workloads[] = {concentrated(), box()};
    for (const Workload& w : workloads) {
        addQueries(w, *w.kd, "kd");
        addQueries(w, *w.flann, "flann");
    }
    addBuild();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
