// Queries of the packed kd-tree and of FLANN's, on photons like those of two kinds of scene.
//
// usage: bench_index [--map MAP.lsmap] [--benchmark_...]
//
// Photons: those that a glass ball throws on a floor (of the map, which `lsde emit scenes/glass-sphere.glb --photons
// 1400000` makes, or else drawn from a density like it), and those of a box's walls. Queries: the points that a camera
// sees, in the order in which the camera pass visits them ("image") or shuffled.
//
// Time is nanoseconds a query. Queries by radius and of the k nearest are answered with a list of photons and their
// distances, density estimates with a sum of weights over the radius that the camera pass takes. Names:
// PHOTONS/QUERY/ORDER/INDEX. The table at the end has the least times of all repetitions.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "photon/density.h"
#include "photon/map_file.h"

using namespace lsde;

namespace {

// Photons, and points to query at.
struct Workload {
    PhotonMap map;                      // class Caustic
    float area;                         // m2, on which the photons lie
    std::vector<SurfacePoint> queries;  // in image order
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
        p = pack({.position = point.position, .direction = point.ng, .ng = point.ng});
    }
    return photons;
}

PhotonMap mapOf(size_t count, const std::function<SurfacePoint(Random&)>& photon) {
    ThreadPool pool;
    PhotonMap map;
    map.setTree(PhotonClass::Caustic, buildPhotonTree(photonsOf(count, photon), pool));
    return map;
}

constexpr int kImage = 512;  // pixels
constexpr int kTile = 16;    // pixels; as in the camera pass

// Calls pixel(x, y) for one tile in `share`, evenly over an image: whole passes over all pixels would take minutes,
// and part of a pass would not be the image.
template <typename Pixel>
void forTiles(int share, Pixel&& pixel) {
    constexpr int kTiles = kImage / kTile;
    for (int tile = 0; tile < kTiles * kTiles; ++tile) {
        if ((tile % kTiles + 3 * (tile / kTiles)) % share != 0) continue;
        for (int at = 0; at < kTile * kTile; ++at)
            pixel(tile % kTiles * kTile + at % kTile, tile / kTiles * kTile + at / kTile);
    }
}
float centreOf(int pixel) { return (static_cast<float>(pixel) + 0.5F) / kImage; }  // in [0,1]

// From straight above the caustic.
Workload concentrated() {
    constexpr float kSide = 1.2F;  // m
    Workload w{mapOf(1'000'000, photonOfConcentrated), kPi * 4, {}};
    forTiles(4, [&](int x, int y) {
        w.queries.push_back(surface({kSide * (centreOf(x) - 0.5F), 0, kSide * (centreOf(y) - 0.5F)}, {0, 1, 0}));
        w.queries.back().footprint = kSide / kImage;
    });
    return w;
}

// The floor as the camera of scenes/glass-sphere.glb sees it, did the ball not hide part of it.
Workload glassSphere(const std::string& file) {
    const Vec3 eye(0, 3.5F, 8), forward = glm::normalize(Vec3(0, 0.6F, 0) - eye);
    const Vec3 right(1, 0, 0), up = glm::cross(right, forward);
    const float halfHeight = std::tan(17.5F * kPi / 180), floor = 8;  // m
    RunContext run;
    Workload w{readPhotonMap(file, run), square(floor), {}};
    forTiles(4, [&](int x, int y) {
        const Vec3 ray = forward + halfHeight * ((2 * centreOf(x) - 1) * right - (2 * centreOf(y) - 1) * up);
        const float distance = -eye.y / ray.y;
        const Vec3 p = eye + distance * ray;
        if (!(ray.y < 0) || std::max(std::fabs(p.x), std::fabs(p.z)) > floor / 2) return;
        w.queries.push_back(surface({p.x, 0, p.z}, {0, 1, 0}));
        w.queries.back().footprint = distance * 2 * halfHeight / kImage;
    });
    return w;
}

// Each wall from in front of it.
Workload box() {
    Workload w{mapOf(10'000'000, photonOfBox), 6, {}};
    for (int wall = 0; wall < 6; ++wall)
        forTiles(16, [&](int x, int y) {
            w.queries.push_back(pointOnWall(wall, centreOf(x), centreOf(y)));
            w.queries.back().footprint = 1.0F / kImage;
        });
    return w;
}

// A workload with its indices, each made when the first benchmark of it runs: a filter that leaves it out saves the
// time.
class Subject {
  public:
    Subject(std::string name, std::function<Workload()> make) : name_(std::move(name)), make_(std::move(make)) {}
    const std::string& name() const { return name_; }

    const Workload& workload() {
        if (!workload_) {
            workload_ = std::make_unique<Workload>(make_());
            shuffled_ = workload_->queries;
            std::shuffle(shuffled_.begin(), shuffled_.end(), Random(2));
        }
        return *workload_;
    }
    const std::vector<SurfacePoint>& queries(bool imageOrder) {
        return imageOrder ? workload().queries : (workload(), shuffled_);
    }
    template <typename Index>
    const Index& index() {
        auto& index = std::get<std::unique_ptr<Index>>(indices_);
        if (!index) index = std::make_unique<Index>(workload().map.photons(PhotonClass::Caustic));
        return *index;
    }

    // The radius (m) that holds `count` photons at the mean of the queries.
    float radiusHolding(uint32_t count);

  private:
    std::string name_;
    std::function<Workload()> make_;
    std::unique_ptr<Workload> workload_;
    std::vector<SurfacePoint> shuffled_;
    std::map<uint32_t, float> radii_;  // m, by count
    std::tuple<std::unique_ptr<KdIndex>, std::unique_ptr<FlannIndex>> indices_;
};

float Subject::radiusHolding(uint32_t count) {
    if (const auto known = radii_.find(count); known != radii_.end()) return known->second;
    // At all queries, not at a few: in a focus, few hold most of the photons.
    const double wanted = count * static_cast<double>(workload().queries.size());
    float low = 1e-5F, high = 1;
    NeighbourList found;
    for (int step = 0; step < 12; ++step) {
        const float radius = std::sqrt(low * high);
        double sum = 0;
        for (size_t i = 0; i < shuffled_.size() && sum < wanted; ++i) {
            index<KdIndex>().within(shuffled_[i].position, radius, found);
            sum += static_cast<double>(found.size());
        }
        (sum < wanted ? low : high) = radius;
    }
    return radii_[count] = low;
}

// The queries. Each answers with the number of photons found.

struct WithinRadius {
    float radius;  // m
    size_t operator()(const auto& index, const SurfacePoint& q, DensityScratch& s) const {
        index.within(q.position, radius, s.found);
        return s.found.size();
    }
};
struct Nearest {
    uint32_t count;
    size_t operator()(const auto& index, const SurfacePoint& q, DensityScratch& s) const {
        index.nearest(q.position, count, kInfinity, s.found);
        return s.found.size();
    }
};
struct Density {
    float maxRadius;  // m: holds 80 photons at the mean density
    size_t operator()(const auto& index, const SurfacePoint& q, DensityScratch& s) const {
        const DensityQuery query{.point = q,
                                 .sideNormal = q.ng,
                                 .minCount = 20,
                                 .minRadius = std::min(0.5F * q.footprint, maxRadius),
                                 .maxRadius = maxRadius};
        float sum = 0;
        const GatheredDisc disc = gatherPhotons(index, query, s, [&](uint32_t, float weight) { sum += weight; });
        benchmark::DoNotOptimize(sum);
        return disc.accepted;
    }
};

// Whole passes over the queries only, so that every index answers the same.
template <typename Index, typename Query>
void run(benchmark::State& state, const Index& index, const std::vector<SurfacePoint>& queries, const Query& query) {
    DensityScratch scratch;
    double photons = 0;
    while (state.KeepRunningBatch(static_cast<benchmark::IterationCount>(queries.size())))
        for (const SurfacePoint& q : queries) photons += static_cast<double>(query(index, q, scratch));
    state.counters["photons"] = benchmark::Counter(photons, benchmark::Counter::kAvgIterations);
}

// makeQuery(subject) -> a query
template <typename MakeQuery>
void add(Subject& subject, const std::string& kind, bool imageOrder, const MakeQuery& makeQuery) {
    const std::string name = fmt::format("{}/{}/{}/", subject.name(), kind, imageOrder ? "image" : "shuffled");
    benchmark::RegisterBenchmark((name + "kd").c_str(), [=, &subject](benchmark::State& state) {
        run(state, subject.index<KdIndex>(), subject.queries(imageOrder), makeQuery(subject));
    });
    benchmark::RegisterBenchmark((name + "flann").c_str(), [=, &subject](benchmark::State& state) {
        run(state, subject.index<FlannIndex>(), subject.queries(imageOrder), makeQuery(subject));
    });
}

void addQueries(Subject& subject) {
    for (const bool imageOrder : {true, false}) {
        for (const uint32_t count : {50U, 200U})
            add(subject, "radius" + std::to_string(count), imageOrder,
                [count](Subject& s) { return WithinRadius{s.radiusHolding(count)}; });
        for (const uint32_t count : {50U, 200U})
            add(subject, "knn" + std::to_string(count), imageOrder, [count](Subject&) { return Nearest{count}; });
        add(subject, "density20", imageOrder, [](Subject& s) {
            const auto photons = static_cast<float>(s.index<KdIndex>().tree().count);
            return Density{std::sqrt(80 * s.workload().area / (kPi * photons))};
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

// Prints both indices side by side at the end.
class Comparison : public benchmark::ConsoleReporter {
  public:
    Comparison() : ConsoleReporter(OO_Tabular) {}  // no colours
    void ReportRuns(const std::vector<Run>& runs) override {
        ConsoleReporter::ReportRuns(runs);
        for (const Run& run : runs) {
            const std::string name = run.run_name.function_name;
            const size_t slash = name.rfind('/');
            if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
            const double time = run.GetAdjustedCPUTime();
            double& least = times_[name.substr(0, slash)].try_emplace(name.substr(slash + 1), time).first->second;
            least = std::min(least, time);
        }
    }
    void Finalize() override {
        double logs = 0;
        int cases = 0;
        fmt::print("\n{:40}{:>10}{:>10}{:>8}\n", "ns a query", "FLANN", "packed", "ratio");
        for (const auto& [name, times] : times_) {
            if (times.count("kd") + times.count("flann") < 2) continue;
            const double flann = times.at("flann"), kd = times.at("kd");
            fmt::print("{:40}{:10.0f}{:10.0f}{:8.2f}\n", name, flann, kd, flann / kd);
            if (name.find("density") != std::string::npos) continue;  // not a query of the index alone
            logs += std::log(flann / kd);
            ++cases;
        }
        if (cases > 0) fmt::print("{:60}{:8.2f}\n", "geometric mean without density", std::exp(logs / cases));
    }

  private:
    std::map<std::string, std::map<std::string, double>> times_;  // ns; by case, by index
};

}  // namespace

int main(int argc, char** argv) try {
    benchmark::Initialize(&argc, argv);
    const bool withMap = argc == 3 && std::string(argv[1]) == "--map";
    if (!withMap && benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    Subject ball = withMap ? Subject("glass-sphere", [file = std::string(argv[2])] { return glassSphere(file); })
                           : Subject("concentrated1M", concentrated);
    Subject walls("box10M", box);
    addQueries(ball);
    addQueries(walls);
    addBuild();
    Comparison reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return 0;
} catch (const Error& error) {  // a map that cannot be read
    fmt::print(stderr, "bench_index: {}\n", error.what());
    return 1;
}
