#include "passes/emission_pilot.h"

#include <cmath>

namespace lsde {

namespace {

constexpr uint64_t kPathsPerTask = 512;

float powerOf(const PhotonPayload& p) {
    const Rgb power = unpackPower(p.power);
    return power.x + power.y + power.z;
}

// Irradiance where photons lie, up to a factor, by those next to them.
class PilotIrradiance {
  public:
    PilotIrradiance(const std::vector<LightPaths>& results, ThreadPool& pool) {
        std::vector<PackedPhoton> all;
        for (const LightPaths& paths : results)
            for (const auto& photons : paths.photons) all.insert(all.end(), photons.begin(), photons.end());
        tree_ = buildPhotonTree(std::move(all), pool);
    }
    float at(const PackedPhoton& photon, NeighbourList& found) const {
        constexpr uint32_t kNeighbours = 24;
        const PhotonTreeView photons = view(tree_);
        KdIndex(photons).nearest(photon.position, kNeighbours, kInfinity, found);
        float power = 0, rim = 0;
        for (const Neighbour& n : found) {
            power += powerOf(photons.payload[n.index]);
            rim = std::max(rim, n.distanceSquared);
        }
        return rim > 0 ? power / rim : kInfinity;
    }

  private:
    PhotonTree tree_;
};

// By the pilot's paths, in parts.
Dispersion dispersionOf(const std::vector<LightPaths>& pilot, PhotonClass c, ThreadPool& pool) {
    constexpr size_t kParts = 16;
    std::vector<std::vector<PackedPhoton>> parts(kParts);
    for (size_t i = 0; i < pilot.size(); ++i) {
        const std::vector<PackedPhoton>& photons = pilot[i].photons[static_cast<size_t>(c)];
        std::vector<PackedPhoton>& part = parts[i * kParts / pilot.size()];
        part.insert(part.end(), photons.begin(), photons.end());
    }
    return measureDispersion(parts, pool);
}

}  // namespace

std::vector<LightPaths> tracePilot(LightTracerInput input, uint64_t paths, ThreadPool& pool) {
    input.stage = Stage::EmissionPilot;
    std::vector<LightPaths> results(paths / kPathsPerTask);
    pool.forEach(results.size(), [&](size_t i) {
        results[i] = traceLightPaths(input, pathsInOrder(i * kPathsPerTask, kPathsPerTask));
    });
    return results;
}

AimTrials tryAims(LightTracerInput input, ThreadPool& pool) {
    constexpr uint64_t kPaths = 65536;
    // Of the largest power of light that met a D: many aimed paths to learn from.
    constexpr float kFairShare = 0.1F;
    // Dimmer than this share of the mean over caustics, light is not worth more.
    constexpr float kDim = 0.1F;
    // Light that lands without a bend is seen by other means; that it goes on from there is worth something.
    constexpr float kWorthOfDirect = 0.25F;
    if (input.scene.casters().empty()) return {};
    const Store store = input.store;
    input.store = Store::All;
    // Infinite: nothing goes on.
    input.fairPower = store == Store::Caustic ? kInfinity : kFairShare * input.sources.fairPower();
    input.keepTrials = true;
    const std::vector<LightPaths> results = tracePilot(input, kPaths, pool);
    const PilotIrradiance irradiance(results, pool);
    std::vector<std::array<std::vector<float>, kPhotonClasses>> at(results.size());
    pool.forEach(results.size(), [&](size_t i) {
        NeighbourList found;
        for (size_t c = 0; c < kPhotonClasses; ++c)
            for (const PackedPhoton& p : results[i].photons[c]) at[i][c].push_back(irradiance.at(p, found));
    });
    constexpr auto kCaustic = static_cast<size_t>(PhotonClass::Caustic);
    constexpr auto kDirect = static_cast<size_t>(PhotonClass::Direct);
    constexpr auto kIndirect = static_cast<size_t>(PhotonClass::Indirect);
    // Harmonic where most photons are: a focus of no size does not count for all.
    double power = 0, area = 0;
    for (size_t i = 0; i < results.size(); ++i)
        for (size_t p = 0; p < at[i][kCaustic].size(); ++p) {
            const double each = static_cast<double>(powerOf(results[i].photons[kCaustic][p].payload));
            power += each;
            area += each / static_cast<double>(at[i][kCaustic][p]);
        }
    if (!(area > 0)) return {};
    const float dim = kDim * static_cast<float>(power / area);
    const auto worthOf = [&](size_t task, size_t c, size_t photon) {
        return powerOf(results[task].photons[c][photon].payload) / std::sqrt(at[task][c][photon] + dim);
    };
    AimTrials trials;
    for (size_t i = 0; i < results.size(); ++i) {
        std::array<size_t, kPhotonClasses> next{};
        for (const TracedStart& start : results[i].starts) {
            AimTrial trial = start.aim;
            for (size_t c = 0; c < kPhotonClasses; ++c)
                for (uint32_t n = 0; n < start.photons[c]; ++n, ++next[c]) {
                    const float direct = store == Store::Caustic ? 0 : kWorthOfDirect;
                    const float share = c == kCaustic ? 1 : c == kDirect ? direct : 0;
                    trial.trial.worth += share * worthOf(i, c, next[c]);
                }
            trials.starts.push_back(trial);
        }
        std::vector<DiffuseAim::Trial> aims = results[i].diffuseAims;
        for (size_t p = 0; p < results[i].aimedBy.size(); ++p)
            if (const uint32_t trial = results[i].aimedBy[p]; trial != kNoTrial)
                aims[trial].trial.worth += worthOf(i, kIndirect, p);
        trials.afterDiffuse.insert(trials.afterDiffuse.end(), aims.begin(), aims.end());
    }
    return trials;
}

PilotFindings pilotEmission(LightTracerInput input, ThreadPool& pool) {
    constexpr uint64_t kPaths = 8192;
    // Of light that met a D, the share of rays that follow what is aimed at casters: as much as escapes unaimed.
    constexpr double kLeastAimed = 0.25, kMostAimed = 0.9;
    // Rays of light that met a D, for each other ray: as its flux is to that of caustics, within bounds.
    constexpr double kLeastRaysAfterDiffuse = 0.3, kMostRaysAfterDiffuse = 2;
    constexpr uint64_t kRaysOfAimed = 4;  // where none was seen
    input.fairPower = input.sources.fairPower();
    const std::vector<LightPaths> results = tracePilot(input, kPaths, pool);
    PilotFindings found{input.fairPower, kPilotDiffuseBoost, {}};
    for (const PhotonClass c : {PhotonClass::Caustic, PhotonClass::Indirect})
        found.dispersion[static_cast<size_t>(c)] = dispersionOf(results, c, pool);
    if (input.store == Store::Caustic) return found;
    Ledger ledger(input.scene.lights().size(), input.scene.objects().size());
    AfterDiffuse after;
    uint64_t rays = 0;
    for (const LightPaths& paths : results) {
        ledger.merge(paths.ledger);
        after += paths.afterDiffuse;
        rays += paths.rays;
    }
    const double caustic = ledger.fluxOf(static_cast<size_t>(PhotonClass::Caustic));
    const double indirect = ledger.fluxOf(static_cast<size_t>(PhotonClass::Indirect));
    const double share = caustic > 0 ? std::clamp(indirect / caustic, kLeastRaysAfterDiffuse, kMostRaysAfterDiffuse)
                                     : kMostRaysAfterDiffuse;
    const auto unaimed = static_cast<double>(after.rays);
    const double wanted = share * static_cast<double>(rays - after.aimedRays - after.rays);
    const double escaped = static_cast<double>(after.escaped) / std::max<double>(1, static_cast<double>(after.bounces));
    const double aimedShare = std::clamp(escaped, kLeastAimed, kMostAimed);
    const double seeing = after.seeingPaths / std::max(after.lobePaths, 1e-30);
    const double aimed = unaimed * seeing * aimedShare / (1 - aimedShare);
    const double fairer = std::clamp((unaimed + aimed) / std::max(1.0, wanted), 1.0 / 64, 4.0);
    const double raysOfAimed =
        static_cast<double>(after.aimedRays + kRaysOfAimed) / static_cast<double>(after.aimedBounces + 1);
    const double boost = aimed > 0 ? aimed / (after.inCones * raysOfAimed) : 0;
    found.fairPower *= static_cast<float>(fairer);
    found.diffuseBoost = static_cast<float>(boost);
    return found;
}

}  // namespace lsde
