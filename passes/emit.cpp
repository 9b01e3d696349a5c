#include "passes/emit.h"

#include <fmt/format.h>

#include <mutex>

#include "base/error.h"
#include "base/hash.h"
#include "path/ownership.h"

namespace lsde {

namespace {

constexpr uint64_t kPathsPerChunk = 8192;
constexpr uint64_t kPathsPerRound = 64 * kPathsPerChunk;  // between two looks at the interrupt

// One chunk's results, merged by sums that do not depend on the order.
struct Chunk {
    std::array<std::vector<PackedPhoton>, kPhotonClasses> photons;
    Ledger ledger;
};

// Follows single light paths and keeps their books: at every step what the path loses is entered in one column, so that
// the columns add up to what was emitted, exactly.
class LightTracer {
  public:
    LightTracer(const Scene& scene, const EmissionSampler& sources, const EmitSettings& settings, uint64_t seed,
                Chunk& out)
        : scene_(scene), sources_(sources), settings_(settings), seed_(seed), out_(out) {}

    void trace(uint64_t index) {
        Sampler sampler = Sampler::sequence(seed_, Stage::Emission, index);
        const Rgb total = sources_.totalPower();
        enter(LedgerColumn::Emitted, total);
        LightPathStart start;
        if (!sources_.sample(sampler, start)) {
            enter(LedgerColumn::Sampling, total);
            return;
        }
        move(LedgerColumn::Sampling, total, start.power);
        out_.ledger.emittedByLight[start.light] += FixedRgb(start.power);
        ++out_.ledger.pathsByLight[start.light];
        out_.ledger.maxAimWeight = std::max(out_.ledger.maxAimWeight, static_cast<double>(start.aimWeight));
        light_ = start.light;
        delta_ = scene_.lights()[light_].isDelta();
        index_ = index;
        follow({start.ray, start.media, start.power}, sampler);
    }

  private:
    void enter(LedgerColumn column, Rgb power) { out_.ledger[column] += FixedRgb(power); }
    // Power went from `before` to `after`: the difference belongs to the column.
    void move(LedgerColumn column, Rgb before, Rgb after) {
        if (before == after) return;
        out_.ledger[column] += FixedRgb(before) - FixedRgb(after);
    }

    void follow(PathState path, Sampler& sampler) {
        LightWalkClass walk;
        PathCode code;
        for (uint32_t depth = 0;; ++depth) {
            const Rgb before = path.throughput;
            Vertex v;
            if (!advance(scene_, path, v, scratch_)) {
                // What a medium takes from light that never arrives anywhere is not told apart from what escapes.
                enter(LedgerColumn::Escaped, before);
                return;
            }
            move(LedgerColumn::AbsorbedVolume, before, path.throughput);
            land(v, path, walk, code, depth);
            if (depth >= settings_.maxDepth) {
                enter(LedgerColumn::DepthCut, path.throughput);
                return;
            }
            if (!bounce(v, path, walk, code, sampler)) return;
        }
    }

    void land(const Vertex& v, const PathState& path, const LightWalkClass& walk, PathCode code, uint32_t depth) {
        const bool glossy = hasGlossyLobe(v.bsdf);
        const bool wide = hasDiffuseLobe(v.bsdf) || (glossy && glossyClass(v.bsdf) == VertexClass::Diffuse);
        const bool forGlossy = glossy && walk.causticAtGlossy(delta_);
        if (!wide && !forGlossy) return;
        const PhotonClass c = walk.metDiffuse() ? PhotonClass::Indirect
                              : walk.metAny()   ? PhotonClass::Caustic
                                                : PhotonClass::Direct;
        const MeshInfo& info = scene_.meshes()[v.surface.mesh];
        ++out_.ledger.landed[static_cast<size_t>(c)];
        out_.ledger.flux[static_cast<size_t>(c) * scene_.objects().size() + info.object] += FixedRgb(path.throughput);
        if (!info.receiver || (c != PhotonClass::Caustic && !settings_.storeAll)) return;
        Photon photon;
        photon.position = v.surface.position;
        photon.power = path.throughput;
        photon.direction = v.woWorld;
        photon.ng = v.surface.ng;
        photon.light = static_cast<uint16_t>(light_);
        photon.medium = v.medium;
        photon.flags =
            static_cast<uint16_t>((delta_ ? kFromDeltaLight : 0) | (walk.causticAtGlossy(delta_) ? kGlossyGather : 0));
        photon.path = code;
        photon.key = hashCombine(seed_, hashCombine(index_, depth));
        if (code.overflowed()) ++out_.ledger.unclassified;
        out_.photons[static_cast<size_t>(c)].push_back(pack(photon));
    }

    // False: the path ended, and its power has been entered.
    bool bounce(const Vertex& v, PathState& path, LightWalkClass& walk, PathCode& code, Sampler& sampler) {
        const Rgb arriving = path.throughput;
        BsdfSample sample;
        const float uLobe = sampler.next();
        const Vec2 u = sampler.next2D();
        if (std::holds_alternative<BlackBsdf>(v.bsdf) || !sampleBsdf(v.bsdf, v.wo, uLobe, u, sample)) {
            enter(LedgerColumn::AbsorbedSurface, arriving);
            return false;
        }
        const Rgb scattered = arriving * sample.weight;
        move(LedgerColumn::AbsorbedSurface, arriving, scattered);
        const VertexClass c = classOf(v.bsdf, sample);
        if (c == VertexClass::Diffuse && !settings_.storeAll) {
            enter(LedgerColumn::Continued, scattered);
            return false;
        }
        if (!scatter(v, sample, Quantity::Power, path)) {
            enter(LedgerColumn::ShadingNormal, scattered);
            return false;
        }
        move(LedgerColumn::ShadingNormal, scattered, path.throughput);
        walk.pass(c);
        code.append(sample.event);
        return roulette(arriving, path, sampler);
    }

    // Keeps the power of all photons of a path even: survival by the power that is left.
    bool roulette(Rgb arriving, PathState& path, Sampler& sampler) {
        const float keep = std::min(1.0F, maxComponent(path.throughput) / maxComponent(arriving));
        if (keep >= 1) return true;
        const Rgb before = path.throughput;
        if (sampler.next() >= keep) {
            enter(LedgerColumn::Roulette, before);
            return false;
        }
        path.throughput /= keep;
        move(LedgerColumn::Roulette, before, path.throughput);
        return true;
    }

    const Scene& scene_;
    const EmissionSampler& sources_;
    const EmitSettings& settings_;
    uint64_t seed_;
    Chunk& out_;
    WalkScratch scratch_;
    size_t light_ = 0;
    uint64_t index_ = 0;
    bool delta_ = false;

  public:
    uint64_t rays() const { return scratch_.rays; }
};

}  // namespace

IndexRange shardRange(uint64_t photons, uint64_t i, uint64_t n) {
    __extension__ using Wide = unsigned __int128;
    const auto at = [&](uint64_t k) { return static_cast<uint64_t>(static_cast<Wide>(photons) * k / n); };
    return {at(i - 1), at(i)};
}

Emission::Emission(const Scene& scene, const EmitSettings& settings, uint64_t seed)
    : scene_(scene),
      settings_(settings),
      seed_(seed),
      sources_(scene, scene.lightSelection(settings.lights), settings.aim),
      ledger_(scene.lights().size(), scene.objects().size()) {}

void Emission::trace(uint64_t next, uint64_t count, RunContext& run) {
    const size_t chunks = (count + kPathsPerChunk - 1) / kPathsPerChunk;
    std::vector<Chunk> results(chunks);
    run.pool.forEach(chunks, [&](size_t i) {
        Chunk& chunk = results[i];
        chunk.ledger = Ledger(scene_.lights().size(), scene_.objects().size());
        LightTracer tracer(scene_, sources_, settings_, seed_, chunk);
        const uint64_t begin = next + i * kPathsPerChunk, end = std::min(next + count, begin + kPathsPerChunk);
        for (uint64_t path = begin; path < end; ++path) tracer.trace(path);
        run.rays += tracer.rays();
    });
    for (Chunk& chunk : results) {
        ledger_.merge(chunk.ledger);
        for (size_t c = 0; c < kPhotonClasses; ++c)
            photons_[c].insert(photons_[c].end(), chunk.photons[c].begin(), chunk.photons[c].end());
        chunk = {};
    }
    if (!ranges_.empty() && ranges_.back().end == next)
        ranges_.back().end = next + count;
    else if (count > 0)
        ranges_.push_back({next, next + count});
}

PhotonMap Emission::finish(uint64_t total, RunContext& run) {
    PhotonMap map;
    MapHeader& h = map.header;
    h.sceneHash = scene_.hash();
    h.seed = seed_;
    h.totalPaths = total;
    h.maxDepth = settings_.maxDepth;
    h.store = settings_.storeAll ? "all" : "caustic";
    h.aimed = settings_.aim;
    for (const Light& light : scene_.lights()) h.lights.push_back(light.name);
    h.objects = scene_.objects();
    h.ranges = ranges_;
    h.ledger = ledger_;
    for (size_t c = 0; c < kPhotonClasses; ++c)
        if (c == static_cast<size_t>(PhotonClass::Caustic) || settings_.storeAll)
            map.setTree(static_cast<PhotonClass>(c), buildPhotonTree(std::move(photons_[c]), run.pool));
    return map;
}

PhotonMap emitPhotons(const Scene& scene, const EmitSettings& settings, RunContext& run, bool* interrupted) {
    IndexRange range = settings.range;
    if (range.end == 0) range = {0, settings.photons};
    Emission emission(scene, settings, run.seed);
    {
        const PhaseTimer timer(run, "emit");
        for (uint64_t at = range.begin; at < range.end; at += kPathsPerRound) {
            if (run.interrupted()) {
                if (interrupted == nullptr) run.checkInterrupt();
                *interrupted = true;
                break;
            }
            emission.trace(at, std::min(kPathsPerRound, range.end - at), run);
            run.progress("emit", static_cast<double>(std::min(at + kPathsPerRound, range.end) - range.begin) /
                                     static_cast<double>(range.end - range.begin));
        }
    }
    const PhaseTimer timer(run, "build");
    return emission.finish(settings.photons, run);
}

std::string whyNoCaustics(const Scene& scene, const Ledger* ledger) {
    if (scene.lights().empty()) return "no caustics here: the scene has no lights";
    const bool anyCaster =
        std::any_of(scene.meshes().begin(), scene.meshes().end(), [](const MeshInfo& m) { return m.caster; });
    if (!anyCaster)
        return fmt::format(
            "no caustics here: nothing in the scene is specular (no mirror, no glass, no roughness below {})",
            kGlossyRoughness);
    if (ledger != nullptr && ledger->landed[static_cast<size_t>(PhotonClass::Caustic)] == 0)
        return "no caustics here: no light arrived at a diffuse surface by way of a specular one";
    return {};
}

}  // namespace lsde
