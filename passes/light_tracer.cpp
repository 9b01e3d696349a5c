#include "passes/light_tracer.h"

#include "base/hash.h"
#include "path/ownership.h"

namespace lsde {

namespace {

// Follows single light paths and keeps their books: at every step what the path loses is entered in one column, so that
// the columns add up to what was emitted, exactly. The books are in the picture's channels: wavelengths are weighed,
// which scenes without dispersion must not pay for.
template <bool kDisperses>
class LightTracer {
  public:
    LightTracer(const LightTracerInput& input, LightPaths& out) : in_(input), out_(out) {}

    void trace(uint64_t index) {
        Sampler sampler = Sampler::sequence(in_.seed, in_.stage, index);
        const Rgb total = in_.sources.totalPower();
        enter(LedgerColumn::Emitted, total);
        LightPathStart start;
        for (size_t c = 0; c < kPhotonClasses; ++c) photonsBefore_[c] = out_.photons[c].size();
        if (!in_.sources.sample(sampler, start)) {
            enter(LedgerColumn::Sampling, total);
            if (in_.keepStarts) keepStart(start);
            return;
        }
        move(LedgerColumn::Sampling, total, start.power);
        out_.ledger.emittedByLight[start.light] += FixedRgb(start.power);
        ++out_.ledger.pathsByLight[start.light];
        out_.ledger.maxAimWeight = std::max(out_.ledger.maxAimWeight, static_cast<double>(start.aimWeight));
        light_ = start.light;
        delta_ = in_.scene.lights()[light_].isDelta();
        index_ = index;
        stored_ = 0;
        waiting_.clear();
        waiting_.push_back({sampler, start.path()});
        while (!waiting_.empty()) {
            LightPath path = waiting_.back();
            waiting_.pop_back();
            follow(path);
        }
        if (in_.keepStarts) keepStart(start);
    }
    uint64_t rays() const { return scratch_.rays; }

  private:
    struct LightPath {
        Sampler sampler;
        PathState state;
        LightWalkClass walk;
        PathCode code;
        uint32_t depth = 0;
        bool unaimed = false;       // left a Lambertian surface by its own lobe
        bool aimedDiffuse = false;  // aimed since the light met a D
    };

    void enter(LedgerColumn column, Rgb power) { out_.ledger[column] += FixedRgb(power); }
    // Power went from `before` to `after`: the difference belongs to the column.
    void move(LedgerColumn column, Rgb before, Rgb after) {
        if (before == after) return;
        out_.ledger[column] += FixedRgb(before) - FixedRgb(after);
    }

    static Rgb inChannels(Rgb power, WavelengthId wavelength) {
        if constexpr (kDisperses) return weighed(power, wavelength);
        return power;
    }
    static Rgb carried(const LightPath& path) { return inChannels(path.state.throughput, path.state.wavelength); }

    void keepStart(const LightPathStart& start) {
        TracedStart& kept = out_.starts.emplace_back();
        kept.aim = {start.light, start.part, {start.u, 0}};
        for (size_t c = 0; c < kPhotonClasses; ++c)
            kept.photons[c] = static_cast<uint32_t>(out_.photons[c].size() - photonsBefore_[c]);
    }

    void follow(LightPath& path) {
        for (;; ++path.depth) {
            const Rgb before = carried(path);
            const uint64_t raysBefore = scratch_.rays;
            Vertex v;
            const bool arrives = advance(in_.scene, path.state, v, scratch_);
            if (path.walk.metDiffuse())
                (path.aimedDiffuse ? out_.afterDiffuse.aimedRays : out_.afterDiffuse.rays) +=
                    scratch_.rays - raysBefore;
            if (path.unaimed) {
                ++out_.afterDiffuse.bounces;
                out_.afterDiffuse.escaped += arrives ? 0 : 1;
                path.unaimed = false;
            }
            if (!arrives) {
                // What a medium takes from light that never arrives anywhere is not told apart from what escapes.
                enter(LedgerColumn::Escaped, before);
                return;
            }
            move(LedgerColumn::AbsorbedVolume, before, carried(path));
            land(v, path);
            if (path.depth >= in_.maxDepth) {
                enter(LedgerColumn::DepthCut, carried(path));
                return;
            }
            const auto* lambert = std::get_if<DiffuseBsdf>(&v.bsdf);
            if (lambert != nullptr && in_.store != Store::Caustic) {
                scatterFairly(v, *lambert, path);
                return;
            }
            if (!bounce(v, path)) return;
        }
    }

    void land(const Vertex& v, const LightPath& path) {
        const bool glossy = hasGlossyLobe(v.bsdf);
        const bool wide = hasDiffuseLobe(v.bsdf) || (glossy && glossyClass(v.bsdf) == VertexClass::Diffuse);
        const bool forGlossy = glossy && path.walk.causticAtGlossy(delta_);
        if (!wide && !forGlossy) return;
        const PhotonClass c = path.walk.metDiffuse() ? PhotonClass::Indirect
                              : path.walk.metAny()   ? PhotonClass::Caustic
                                                     : PhotonClass::Direct;
        const MeshInfo& info = in_.scene.meshes()[v.surface.mesh];
        ++out_.ledger.landed[static_cast<size_t>(c)];
        out_.ledger.flux[static_cast<size_t>(c) * in_.scene.objects().size() + info.object] += FixedRgb(carried(path));
        if (!info.receiver || !holds(in_.store, c)) return;
        Photon photon;
        photon.position = v.surface.position;
        // It lands by chance of what is covered, and only there is it gathered: on so much less area.
        photon.power = path.state.throughput / in_.scene.coverage(v.surface);
        photon.direction = v.woWorld;
        photon.ng = v.surface.ng;
        photon.light = static_cast<uint16_t>(light_);
        photon.medium = v.medium;
        photon.flags = static_cast<uint16_t>((delta_ ? kFromDeltaLight : 0) |
                                             (path.walk.causticAtGlossy(delta_) ? kGlossyGather : 0));
        photon.wavelength = path.state.wavelength;
        photon.path = path.code;
        photon.key = hashCombine(in_.seed, hashCombine(index_, stored_++));
        if (path.code.overflowed()) ++out_.ledger.unclassified;
        out_.photons[static_cast<size_t>(c)].push_back(pack(photon));
    }

    // Light goes on from a Lambertian surface as so many paths that each carries a fair power, none or several, and
    // towards casters as so many more that each carries less. What these light in turn goes on with the fair power: the
    // number of paths is bounded by the power there is.
    void scatterFairly(const Vertex& v, const DiffuseBsdf& lambert, LightPath& path) {
        const Rgb arriving = path.state.throughput;
        const DiffuseAim::At aim = in_.diffuseAim.at(v, lambert);
        const float fair = maxComponent(arriving * lambert.albedo) / in_.fairPower;
        const float lobe = std::min(fair, kMostCopies), copies = lobe * aim.effort();
        const auto count = static_cast<uint32_t>(copies + path.sampler.next());
        const Rgb each = arriving / copies;
        out_.afterDiffuse.lobePaths += static_cast<double>(lobe);
        if (aim.share() > 0) out_.afterDiffuse.seeingPaths += static_cast<double>(lobe);
        out_.afterDiffuse.inCones += static_cast<double>(lobe * aim.share());
        enter(LedgerColumn::Roulette, carried(path));
        ++path.depth;
        for (uint32_t i = 0; i < count; ++i) {
            out_.ledger[LedgerColumn::Roulette] -= FixedRgb(inChannels(each, path.state.wavelength));
            LightPath copy = path;
            if (count > 1) copy.sampler = path.sampler.fork(i);
            copy.state.throughput = each;
            if (leaveLambertian(v, lambert, aim, copy)) waiting_.push_back(copy);
        }
    }

    // False: the path ended, and its power has been entered.
    bool leaveLambertian(const Vertex& v, const DiffuseBsdf& lambert, const DiffuseAim::At& aim, LightPath& path) {
        const Rgb arriving = carried(path);
        const float uChoice = path.sampler.next();
        DiffuseAim::Direction next;
        const Rgb scattered = arriving * lambert.albedo;
        move(LedgerColumn::AbsorbedSurface, arriving, scattered);
        if (!aim.sample(uChoice, path.sampler.next2D(), next)) {
            enter(LedgerColumn::Sampling, scattered);
            return false;
        }
        next.sample.weight = lambert.albedo * (aim.effort() * next.weight);
        path.unaimed = !next.aimed;
        path.aimedDiffuse |= next.aimed;
        out_.afterDiffuse.aimedBounces += next.aimed ? 1 : 0;
        move(LedgerColumn::Sampling, scattered, arriving * next.sample.weight);
        return leave(v, next.sample, path);
    }

    bool bounce(const Vertex& v, LightPath& path) {
        const Rgb arriving = carried(path);
        const Rgb power = path.state.throughput;
        BsdfSample sample;
        const float uLobe = path.sampler.next();
        const Vec2 u = path.sampler.next2D();
        if (std::holds_alternative<BlackBsdf>(v.bsdf) || !sampleBsdf(v.bsdf, v.wo, uLobe, u, sample)) {
            enter(LedgerColumn::AbsorbedSurface, arriving);
            return false;
        }
        const Rgb scattered = arriving * sample.weight;
        move(LedgerColumn::AbsorbedSurface, arriving, scattered);
        if (classOf(v.bsdf, sample) == VertexClass::Diffuse && in_.store == Store::Caustic) {
            enter(LedgerColumn::Continued, scattered);
            return false;
        }
        return leave(v, sample, path) && roulette(power, path);
    }

    bool leave(const Vertex& v, const BsdfSample& sample, LightPath& path) {
        const WavelengthId before = path.state.wavelength;
        const Rgb sampled = carried(path) * sample.weight;
        if (!scatter(v, sample, Quantity::Power, path.state)) {
            enter(LedgerColumn::ShadingNormal, sampled);
            return false;
        }
        const Rgb scattered = inChannels(path.state.throughput, before);
        move(LedgerColumn::ShadingNormal, sampled, scattered);
        if constexpr (kDisperses) move(LedgerColumn::Sampling, scattered, carried(path));
        path.walk.pass(classOf(v.bsdf, sample));
        path.code.append(sample.event);
        return true;
    }

    // By what a path lost at a surface, so that what is kept has even power.
    bool roulette(Rgb arriving, LightPath& path) {
        const Rgb before = carried(path);
        const float keep = std::min(1.0F, maxComponent(path.state.throughput) / maxComponent(arriving));
        if (keep >= 1) return true;
        if (path.sampler.next() >= keep) {
            enter(LedgerColumn::Roulette, before);
            return false;
        }
        path.state.throughput /= keep;
        move(LedgerColumn::Roulette, before, carried(path));
        return true;
    }

    static constexpr float kMostCopies = 64;

    const LightTracerInput& in_;
    LightPaths& out_;
    WalkScratch scratch_;
    size_t light_ = 0;
    uint64_t index_ = 0;
    uint64_t stored_ = 0;  // photons of this path
    bool delta_ = false;
    std::array<size_t, kPhotonClasses> photonsBefore_{};
    std::vector<LightPath> waiting_;
};

}  // namespace

std::string_view name(Store store) {
    constexpr std::array<std::string_view, 3> kNames = {"caustic", "indirect", "all"};
    return kNames[static_cast<size_t>(store)];
}

AfterDiffuse& AfterDiffuse::operator+=(const AfterDiffuse& other) {
    rays += other.rays;
    aimedRays += other.aimedRays;
    bounces += other.bounces;
    aimedBounces += other.aimedBounces;
    escaped += other.escaped;
    lobePaths += other.lobePaths;
    seeingPaths += other.seeingPaths;
    inCones += other.inCones;
    return *this;
}

LightPaths traceLightPaths(const LightTracerInput& input, const PathRun& paths) {
    LightPaths out;
    out.ledger = Ledger(input.scene.lights().size(), input.scene.objects().size());
    const auto traceAll = [&](auto&& tracer) {
        for (uint64_t k = paths.from; k < paths.to; ++k) tracer.trace(paths.start + paths.order.index(k));
        out.rays = tracer.rays();
    };
    if (input.scene.disperses())
        traceAll(LightTracer<true>(input, out));
    else
        traceAll(LightTracer<false>(input, out));
    return out;
}

}  // namespace lsde
