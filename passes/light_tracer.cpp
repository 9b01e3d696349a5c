#include "passes/light_tracer.h"

#include <optional>

#include "base/hash.h"
#include "path/ownership.h"

namespace lsde {

namespace {

// The power of a path, as the books have it: what it loses is entered in a column when it is lost, so that the columns
// add up to what was emitted, exactly.
class BookedPower {
  public:
    BookedPower() = default;
    explicit BookedPower(Rgb power) : power_(power), fixed_(power) {}

    const FixedRgb& fixed() const { return fixed_; }
    void become(Rgb power, FixedRgb& column) {
        if (power == power_) return;
        column += fixed_;
        *this = BookedPower(power);
        column -= fixed_;
    }
    void endIn(FixedRgb& column) const { column += fixed_; }

  private:
    Rgb power_{0};
    FixedRgb fixed_;
};

// Follows light paths and keeps their books. They are in the picture's channels: wavelengths are weighed, which scenes
// without dispersion must not pay for.
template <bool kDisperses>
class LightTracer {
  public:
    LightTracer(const LightTracerInput& input, LightPaths& out)
        : in_(input), out_(out), total_(input.sources.totalPower()) {}

    // Some paths side by side, from surface to surface all at once: while one waits for what memory has of the triangle
    // that it met, the others go on.
    void trace(const PathRun& paths) {
        constexpr size_t kSideBySide = 16;
        uint64_t next = paths.from;
        // Trials are in order, if they are kept: one path at a time.
        std::vector<Lane> lanes(in_.keepTrials ? 1 : kSideBySide);
        const auto refill = [&](Lane& lane) {
            while (next < paths.to)
                if (start(paths.start + paths.order.index(next++), lane)) return true;
            return false;
        };
        std::erase_if(lanes, [&](Lane& lane) { return !refill(lane); });
        while (!lanes.empty()) {
            for (Lane& lane : lanes) {
                lane.hits = in_.scene.accel().intersect(lane.path.state.ray, lane.hit);
                if (lane.hits) in_.scene.prefetchTriangle(lane.hit);
            }
            out_.rays += lanes.size();
            for (const Lane& lane : lanes)
                if (lane.hits) in_.scene.prefetchVertices(lane.hit);
            std::erase_if(lanes, [&](Lane& lane) { return !step(lane) && !nextOf(lane) && !refill(lane); });
        }
        out_.rays += scratch_.rays;
    }

  private:
    struct LightPath {
        Sampler sampler;
        PathState state;
        BookedPower booked;
        LightWalkClass walk;
        PathCode code;
        uint32_t depth = 0;
        int crossings = 0;            // since the last event
        bool unaimed = false;         // left a Lambertian surface by its own lobe
        bool aimedDiffuse = false;    // aimed since the light met a D
        uint32_t trial = kNoTrial;    // where it was aimed last
        std::optional<float> uEvent;  // chosen with the direction, for the next event; without value: used

        // The first number of an event.
        float next() {
            const float u = uEvent ? *uEvent : sampler.next();
            uEvent.reset();
            return u;
        }
    };

    // A path of the emission, with all that it splits into.
    struct Lane {
        LightPath path;
        std::vector<LightPath> waiting;
        LightPathStart start;
        std::array<size_t, kPhotonClasses> photonsBefore{};
        uint64_t index = 0;
        uint64_t stored = 0;  // photons of this path
        bool delta = false;
        Hit hit;
        bool hits = false;
    };

    FixedRgb& column(LedgerColumn c) { return out_.ledger[c]; }

    static Rgb inChannels(Rgb power, WavelengthId wavelength) {
        if constexpr (kDisperses) return weighed(power, wavelength);
        return power;
    }
    static Rgb carried(const LightPath& path) { return inChannels(path.state.throughput, path.state.wavelength); }

    // False: no light goes that way.
    bool start(uint64_t index, Lane& lane) {
        Sampler sampler = Sampler::sequence(in_.seed, in_.stage, index);
        total_.endIn(column(LedgerColumn::Emitted));
        LightPathStart& start = lane.start = {};
        for (size_t c = 0; c < kPhotonClasses; ++c) lane.photonsBefore[c] = out_.photons[c].size();
        if (!in_.sources.sample(sampler, start)) {
            total_.endIn(column(LedgerColumn::Sampling));
            if (in_.keepTrials) keepStart(lane);
            return false;
        }
        lane.path = {sampler, start.path(), total_};
        lane.path.booked.become(start.power, column(LedgerColumn::Sampling));
        out_.ledger.emittedByLight[start.light] += lane.path.booked.fixed();
        ++out_.ledger.pathsByLight[start.light];
        out_.ledger.maxAimWeight = std::max(out_.ledger.maxAimWeight, static_cast<double>(start.aimWeight));
        lane.delta = in_.scene.lights()[start.light].isDelta();
        lane.index = index;
        lane.stored = 0;
        return true;
    }

    // The next of the paths that a path has split into; false: there is none, and it is done.
    bool nextOf(Lane& lane) {
        if (lane.waiting.empty()) {
            if (in_.keepTrials) keepStart(lane);
            return false;
        }
        lane.path = lane.waiting.back();
        lane.waiting.pop_back();
        return true;
    }

    void keepStart(const Lane& lane) {
        TracedStart& kept = out_.starts.emplace_back();
        kept.aim = {lane.start.light, lane.start.part, {lane.start.u, 0}};
        for (size_t c = 0; c < kPhotonClasses; ++c)
            kept.photons[c] = static_cast<uint32_t>(out_.photons[c].size() - lane.photonsBefore[c]);
    }

    // From where the path's ray arrives to its next ray. False: it has ended, and its power has been entered.
    bool step(Lane& lane) {
        LightPath& path = lane.path;
        const bool escapes = !lane.hits || path.crossings == kMostCrossings;
        const uint64_t raysBefore = scratch_.rays;
        Vertex v;
        const bool arrives = !escapes && arrive(in_.scene, lane.hit, path.state, v, scratch_);
        if (path.walk.metDiffuse())
            (path.aimedDiffuse ? out_.afterDiffuse.aimedRays : out_.afterDiffuse.rays) +=
                1 + scratch_.rays - raysBefore;
        if (!escapes && !arrives) {
            ++path.crossings;
            return true;
        }
        path.crossings = 0;
        if (path.unaimed) {
            ++out_.afterDiffuse.bounces;
            out_.afterDiffuse.escaped += escapes ? 1 : 0;
            path.unaimed = false;
        }
        if (escapes) {
            // What a medium takes from light that never arrives anywhere is not told apart from what escapes.
            path.booked.endIn(column(LedgerColumn::Escaped));
            return false;
        }
        path.booked.become(carried(path), column(LedgerColumn::AbsorbedVolume));
        land(v, lane);
        if (path.depth++ >= in_.maxDepth) {
            path.booked.endIn(column(LedgerColumn::DepthCut));
            return false;
        }
        const auto* lambert = std::get_if<DiffuseBsdf>(&v.bsdf);
        if (lambert != nullptr && in_.store != Store::Caustic) return scatterFairly(v, *lambert, lane);
        return bounce(v, path);
    }

    void land(const Vertex& v, Lane& lane) {
        const LightPath& path = lane.path;
        const bool glossy = hasGlossyLobe(v.bsdf);
        const bool wide = hasDiffuseLobe(v.bsdf) || (glossy && glossyClass(v.bsdf) == VertexClass::Diffuse);
        const bool forGlossy = glossy && path.walk.causticAtGlossy(lane.delta);
        if (!wide && !forGlossy) return;
        const PhotonClass c = path.walk.metDiffuse() ? PhotonClass::Indirect
                              : path.walk.metAny()   ? PhotonClass::Caustic
                                                     : PhotonClass::Direct;
        const MeshInfo& info = in_.scene.meshes()[v.surface.mesh];
        ++out_.ledger.landed[static_cast<size_t>(c)];
        path.booked.endIn(out_.ledger.flux[static_cast<size_t>(c) * in_.scene.objects().size() + info.object]);
        if (!info.receiver || !holds(in_.store, c)) return;
        Photon photon;
        photon.position = v.surface.position;
        // It lands by chance of what is covered, and only there is it gathered: on so much less area.
        photon.power = path.state.throughput / in_.scene.coverage(v.surface);
        photon.direction = v.woWorld;
        photon.ng = v.surface.ng;
        photon.light = static_cast<uint16_t>(lane.start.light);
        photon.medium = v.medium;
        photon.flags = static_cast<uint16_t>((lane.delta ? kFromDeltaLight : 0) |
                                             (path.walk.causticAtGlossy(lane.delta) ? kGlossyGather : 0));
        photon.wavelength = path.state.wavelength;
        photon.path = path.code;
        photon.key = hashCombine(in_.seed, hashCombine(lane.index, lane.stored++));
        if (path.code.overflowed()) ++out_.ledger.unclassified;
        out_.photons[static_cast<size_t>(c)].push_back(pack(photon));
        if (in_.keepTrials && c == PhotonClass::Indirect) out_.aimedBy.push_back(path.uEvent ? kNoTrial : path.trial);
    }

    // Light goes on from a Lambertian surface as so many paths that each carries a fair power, none or several, and
    // towards casters as so many more that each carries less. What these light in turn goes on with the fair power: the
    // number of paths is bounded by the power there is. Always false: they wait.
    bool scatterFairly(const Vertex& v, const DiffuseBsdf& lambert, Lane& lane) {
        LightPath& path = lane.path;
        const Rgb arriving = path.state.throughput;
        const DiffuseAim::At aim = in_.diffuseAim.at(v, lambert);
        const float fair = maxComponent(arriving * lambert.albedo) / in_.fairPower;
        const float lobe = std::min(fair, kMostCopies), copies = lobe * aim.effort();
        const auto count = static_cast<uint32_t>(copies + path.next());
        out_.afterDiffuse.lobePaths += static_cast<double>(lobe);
        if (aim.share() > 0) out_.afterDiffuse.seeingPaths += static_cast<double>(lobe);
        out_.afterDiffuse.inCones += static_cast<double>(lobe * aim.share());
        path.booked.endIn(column(LedgerColumn::Roulette));
        if (count == 0) return false;
        path.state.throughput = arriving / copies;
        path.booked = BookedPower(carried(path));
        for (uint32_t i = 0; i < count; ++i) {
            column(LedgerColumn::Roulette) -= path.booked.fixed();
            LightPath copy = path;
            if (count > 1) copy.sampler = path.sampler.fork(i);
            if (leaveLambertian(v, lambert, aim, copy)) lane.waiting.push_back(copy);
        }
        return false;
    }

    // False: the path ended, and its power has been entered.
    bool leaveLambertian(const Vertex& v, const DiffuseBsdf& lambert, const DiffuseAim::At& aim, LightPath& path) {
        const Rgb arriving = carried(path);
        const float uChoice = path.sampler.next();
        DiffuseAim::Direction next;
        path.booked.become(arriving * lambert.albedo, column(LedgerColumn::AbsorbedSurface));
        const Vec2 u = path.sampler.next2D();
        const bool goesOn = aim.sample(uChoice, u, path.sampler.next(), next);
        if (in_.keepTrials) keepAim(next, path);
        if (!goesOn) {
            path.booked.endIn(column(LedgerColumn::Sampling));
            return false;
        }
        next.sample.weight = lambert.albedo * (aim.effort() * next.weight);
        path.uEvent = next.uEvent;
        path.unaimed = !next.aimed();
        path.aimedDiffuse |= next.aimed();
        out_.afterDiffuse.aimedBounces += next.aimed() ? 1 : 0;
        path.booked.become(arriving * next.sample.weight, column(LedgerColumn::Sampling));
        return leave(v, next.sample, path);
    }

    void keepAim(const DiffuseAim::Direction& direction, LightPath& path) {
        path.trial = direction.aimed() ? static_cast<uint32_t>(out_.diffuseAims.size()) : kNoTrial;
        if (direction.aimed()) out_.diffuseAims.push_back({direction.caster, {direction.u, 0}});
    }

    bool bounce(const Vertex& v, LightPath& path) {
        const Rgb power = path.state.throughput;
        BsdfSample sample;
        const float uLobe = path.next();
        const Vec2 u = path.sampler.next2D();
        if (std::holds_alternative<BlackBsdf>(v.bsdf) || !sampleBsdf(v.bsdf, v.wo, uLobe, u, sample)) {
            path.booked.endIn(column(LedgerColumn::AbsorbedSurface));
            return false;
        }
        path.booked.become(carried(path) * sample.weight, column(LedgerColumn::AbsorbedSurface));
        if (classOf(v.bsdf, sample) == VertexClass::Diffuse && in_.store == Store::Caustic) {
            path.booked.endIn(column(LedgerColumn::Continued));
            return false;
        }
        return leave(v, sample, path) && roulette(power, path);
    }

    bool leave(const Vertex& v, const BsdfSample& sample, LightPath& path) {
        const WavelengthId before = path.state.wavelength;
        if (!scatter(v, sample, Quantity::Power, path.state)) {
            path.booked.endIn(column(LedgerColumn::ShadingNormal));
            return false;
        }
        path.booked.become(inChannels(path.state.throughput, before), column(LedgerColumn::ShadingNormal));
        if constexpr (kDisperses) path.booked.become(carried(path), column(LedgerColumn::Sampling));
        path.walk.pass(classOf(v.bsdf, sample));
        path.code.append(sample.event);
        return true;
    }

    // By what a path lost at a surface, so that what is kept has even power.
    bool roulette(Rgb arriving, LightPath& path) {
        const float keep = std::min(1.0F, maxComponent(path.state.throughput) / maxComponent(arriving));
        if (keep >= 1) return true;
        if (path.sampler.next() >= keep) {
            path.booked.endIn(column(LedgerColumn::Roulette));
            return false;
        }
        path.state.throughput /= keep;
        path.booked.become(carried(path), column(LedgerColumn::Roulette));
        return true;
    }

    static constexpr float kMostCopies = 64;

    const LightTracerInput& in_;
    LightPaths& out_;
    const BookedPower total_;  // of the lights
    WalkScratch scratch_;
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
    if (input.scene.disperses())
        LightTracer<true>(input, out).trace(paths);
    else
        LightTracer<false>(input, out).trace(paths);
    return out;
}

}  // namespace lsde
