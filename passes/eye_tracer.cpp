#include "passes/eye_tracer.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "sampling/mis.h"
#include "sampling/strata.h"

namespace lsde {

namespace {

constexpr int kTile = 16;  // pixels
// Of the random numbers: which photons are gathered. No branch of a path has it.
constexpr uint32_t kPhotonBranch = ~0U;

}  // namespace

struct EyePath {
    PathState state;
    EyeWalkClass walk;  // events so far, as the owners see them
    EyePathState mask;  // events so far, as the filters see them
    Sampler sampler;
    int splits = 0;         // interfaces that may still be split
    int depth = 0;          // events so far
    int lightSamples = 1;   // until it has left a Diffuse vertex
    float misPdf = 0;       // 1/sr with which the last non-delta vertex drew this direction
    LitPlace place;         // and that vertex, for the choice of a light there
    float travelled = 0;    // m since the last vertex that was not passed straight
    float width = 0;        // m: short side of the pixel's footprint at the ray's origin
    float spread = 0;       // its growth per metre
    bool fresh = true;      // nothing met yet
    bool mayBranch = true;  // has not gone on in several directions yet
    bool lastDelta = true;  // the last bend, or the camera itself
    bool metDiffuse = false;
    bool endsAtDiffuse = false;  // the map owns what reaches a diffuse lobe of this vertex, but for direct light
    float bsdfSamples = 1;       // directions sampled at the last non-delta vertex, for MIS

    int lightSamplesHere() const { return metDiffuse ? 1 : lightSamples; }
    // Nothing goes on from v but a look for emitters.
    bool endsAt(const Vertex& v) const { return endsAtDiffuse && std::holds_alternative<DiffuseBsdf>(v.bsdf); }
};

struct EyeScratch {
    WalkScratch walk;
    GatherScratch gather;
    std::vector<EyePath> branches;
    SampleSums sums;
    EyeCounters counters;
};

EyeTracer::EyeTracer(const Scene& scene, const Camera& camera, const LightSampler& lights, const RenderLayers& layers,
                     const PhotonGather* photons, const EyeSettings& settings, uint64_t seed)
    : scene_(scene),
      camera_(camera),
      lights_(lights),
      layers_(layers),
      photons_(photons),
      settings_(settings),
      seed_(seed),
      cameraMedia_(scene.mediaAt(camera.description().position)) {}

void EyeTracer::render(Film& film, std::vector<SampleStatistics>& statistics, const SamplePlan& plan,
                       const SampleSpan& span, RunContext& run, EyeCounters& counters) const {
    const int tilesX = (film.width() + kTile - 1) / kTile, tilesY = (film.height() + kTile - 1) / kTile;
    std::mutex mutex;
    run.pool.forEach(static_cast<size_t>(tilesX) * static_cast<size_t>(tilesY), [&](size_t tile) {
        run.checkInterrupt();
        EyeScratch scratch;
        const int x0 = static_cast<int>(tile % static_cast<size_t>(tilesX)) * kTile;
        const int y0 = static_cast<int>(tile / static_cast<size_t>(tilesX)) * kTile;
        for (int y = y0; y < std::min(y0 + kTile, film.height()); ++y)
            for (int x = x0; x < std::min(x0 + kTile, film.width()); ++x) {
                const size_t pixel =
                    static_cast<size_t>(y) * static_cast<size_t>(film.width()) + static_cast<size_t>(x);
                const uint64_t end = plan.count(pixel, span.end);
                for (uint64_t i = span.begin > 0 ? plan.count(pixel, span.begin) : 0; i < end; ++i) {
                    samplePixel(camera_.filmX() + x, camera_.filmY() + y, span.first + i, plan.lightSamples(pixel),
                                scratch);
                    statistics[pixel].add(i, scratch.sums.layer[0], std::sqrt(scratch.sums.photonVariance));
                    scratch.sums.photonVariance = 0;
                    scratch.sums.addTo(film, x, y);
                }
            }
        const std::scoped_lock lock(mutex);
        counters.rays += scratch.walk.rays;
        counters.notFinite += scratch.sums.notFinite;
        counters.gathers += scratch.counters.gathers;
        counters.gathered += scratch.counters.gathered;
    });
}

void EyeTracer::samplePixel(int x, int y, uint64_t index, int lightSamples, EyeScratch& scratch) const {
    EyePath path;
    path.sampler = Sampler::pixel(seed_, settings_.stage, static_cast<uint32_t>(x), static_cast<uint32_t>(y), index);
    const Vec2 inPixel = path.sampler.next2D();
    const bool lens = camera_.description().kind == CameraKind::ThinLens;
    const CameraRay ray = camera_.ray(Vec2(x, y) + inPixel, lens ? path.sampler.next2D() : Vec2(0));
    path.state.ray = ray.ray;
    path.state.media = cameraMedia_;
    path.state.reserved = reserveWavelength(scene_, path.sampler);
    path.mask = layers_.filter().eye();
    path.splits = settings_.splits;
    path.lightSamples = lightSamples;
    path.width = ray.width;
    path.spread = ray.spread;
    scratch.branches.clear();
    scratch.branches.push_back(path);
    while (!scratch.branches.empty()) {
        EyePath next = scratch.branches.back();
        scratch.branches.pop_back();
        follow(next, scratch);
    }
}

void EyeTracer::follow(EyePath& path, EyeScratch& scratch) const {
    Vertex v;
    while (advance(scene_, path.state, v, scratch.walk)) {
        path.travelled += v.distance;
        path.width += path.spread * v.distance;
        if (path.fresh) recordFirst(v, scratch.sums);
        path.fresh = false;
        addEmission(v, path, scratch);
        if (path.walk.onlyEmitters()) {
            if (!passStraight(v, path)) return;
            continue;
        }
        if (settings_.maxDepth > 0 && path.depth >= settings_.maxDepth) return;
        if (hasDiffuseLobe(v.bsdf) || hasGlossyLobe(v.bsdf)) {
            path.endsAtDiffuse = indirectFromMap(v);
            path.bsdfSamples = path.endsAt(v) ? lights_.bsdfSamples(litPlace(v)) : 1;
            addDirect(v, path, scratch);
            if (photons_ != nullptr) addPhotons(v, path, scratch);
        }
        if (!split(v, path, scratch)) return;
    }
    addBackground(path, scratch);
}

void EyeTracer::recordFirst(const Vertex& v, SampleSums& sums) const {
    sums.layer[static_cast<size_t>(layers_.albedo())] = albedo(v.bsdf);
    sums.layer[static_cast<size_t>(layers_.normal())] = v.wo.z < 0 ? -v.surface.ns : v.surface.ns;
    sums.layer[static_cast<size_t>(layers_.depth())] = Rgb(v.distance);
}

void EyeTracer::addEmission(const Vertex& v, const EyePath& path, EyeScratch& scratch) const {
    const int light = scene_.meshes()[v.surface.mesh].light;
    if (light < 0 || !lights_.selected(static_cast<size_t>(light))) return;
    addEmitter(
        scene_.emission(v.surface, v.woWorld),
        [&] {
            return directLightPdf(scene_, lights_.at(path.place), path.place.position, v.surface, -v.woWorld,
                                  path.travelled);
        },
        path, scratch);
}

// What escapes sees the lights beyond the scene.
void EyeTracer::addBackground(const EyePath& path, EyeScratch& scratch) const {
    const Vec3 direction = path.state.ray.direction;
    for (const size_t light : scene_.infiniteLights()) {
        if (!lights_.selected(light)) continue;
        const Rgb radiance = std::get<InfiniteLight>(scene_.lights()[light].shape).radiance(direction);
        addEmitter(
            radiance * absorption(scene_, path.state.media, kInfinity),
            [&] { return directLightPdf(scene_, lights_.at(path.place), light, direction); }, path, scratch);
    }
}

template <typename PdfW>
void EyeTracer::addEmitter(Rgb radiance, const PdfW& pdfW, const EyePath& path, EyeScratch& scratch) const {
    if (isBlack(radiance)) return;
    auto hit = path.walk.emitterHit();
    if (photons_ == nullptr) hit = path.lastDelta ? EyeWalkClass::EmitterHit::Full : EyeWalkClass::EmitterHit::Mis;
    if (hit == EyeWalkClass::EmitterHit::Dropped) return;
    const float weight = hit == EyeWalkClass::EmitterHit::Mis ? powerHeuristic(path.misPdf, pdfW()) : 1;
    scratch.sums.contribute(layers_, path.state.rgb() * radiance * weight, layers_.filter().light(), path.mask);
}

void EyeTracer::addDirect(const Vertex& v, EyePath& path, EyeScratch& scratch) const {
    DirectLightQuery query;
    const int samples = path.lightSamplesHere();
    query.bsdfSamples = path.bsdfSamples / static_cast<float>(samples);
    query.glossy = photons_ == nullptr || path.walk.samplesLight(glossyClass(v.bsdf));
    EyePathState diffuse = path.mask, glossy = path.mask;
    layers_.filter().prepend(diffuse, Event::Diffuse);
    layers_.filter().prepend(glossy, Event::Glossy);
    // Drawn even where nothing can count, so that filters never change the numbers of what follows.
    const Vec2 onLight = path.sampler.next2D();
    const LightNumbers u{path.sampler.next(), onLight};
    const LightPathState light = layers_.filter().light();
    if (layers_.hasOnly() && !scene_.hasThinWalls()) {
        query.diffuse &= layers_.counts(layers_.filter().accepted(light, diffuse));
        query.glossy &= layers_.counts(layers_.filter().accepted(light, glossy));
    }
    if (!query.diffuse && !query.glossy) return;
    const Rgb throughput = path.state.rgbAt(v) / static_cast<float>(samples);
    const LightChoice choice = lights_.at(litPlace(v));
    for (int i = 0; i < samples; ++i) {
        const LightNumbers each = lightStratum(u, static_cast<uint32_t>(i), static_cast<uint32_t>(samples));
        const DirectLight d = sampleDirectLight(scene_, choice, v, query, each.which, each.on, scratch.walk);
        LightPathState arriving = light;
        for (int k = 0; k < d.straightPassages; ++k) layers_.filter().append(arriving, Event::Specular);
        if (!isBlack(d.diffuse)) scratch.sums.contribute(layers_, throughput * d.diffuse, arriving, diffuse);
        if (!isBlack(d.glossy)) scratch.sums.contribute(layers_, throughput * d.glossy, arriving, glossy);
    }
}

// Light that met a Diffuse vertex before it comes to a Lambertian lobe is the map's, if the map has it.
bool EyeTracer::indirectFromMap(const Vertex& v) const {
    return photons_ != nullptr && photons_->indirect() != nullptr && scene_.meshes()[v.surface.mesh].receiver &&
           hasDiffuseLobe(v.bsdf);
}

void EyeTracer::addPhotons(const Vertex& v, const EyePath& path, EyeScratch& scratch) const {
    if (!scene_.meshes()[v.surface.mesh].receiver) return;
    const bool diffuse = hasDiffuseLobe(v.bsdf), glossy = hasGlossyLobe(v.bsdf);
    const bool glossyIsWide = glossy && glossyClass(v.bsdf) == VertexClass::Diffuse;
    const bool glossyGathers = glossy && !glossyIsWide && path.walk.gathers(VertexClass::Glossy);
    if (!diffuse && !glossyIsWide && !glossyGathers) return;
    PhotonGatherQuery query;
    query.point = {v.surface.position, v.surface.ng, v.surface.ns, path.metDiffuse ? 0 : path.width,
                   scene_.curvature(v.surface)};
    query.sideNormal = v.sideNormal();
    query.medium = v.medium;
    query.glossyOnly = !diffuse && !glossyIsWide;
    query.glossyFromAll = glossyIsWide;
    query.glossyFromFlagged = glossyGathers;
    query.wavelength = path.state.wavelengthAt(v);
    if (!scattersAlike(v.bsdf, query.point)) query.u = path.sampler.fork(kPhotonBranch).next();
    addGathered(photons_->caustic(), query, v, path, scratch);
    if ((glossyIsWide || glossyGathers) && glossyLobePasses(v.bsdf)) {
        PhotonGatherQuery through = query;
        through.sideNormal = -query.sideNormal;
        through.medium = v.media(true).dominant(scene_.media());
        through.glossyOnly = !glossyIsWide;
        addGathered(photons_->caustic(), through, v, path, scratch);
    }
    if (!path.endsAtDiffuse) return;
    query.glossyFromAll = query.glossyFromFlagged = false;
    addGathered(*photons_->indirect(), query, v, path, scratch);
}

// Light of a class of photons at the vertex, towards the eye.
void EyeTracer::addGathered(const ClassGather& from, const PhotonGatherQuery& query, const Vertex& v,
                            const EyePath& path, EyeScratch& scratch) const {
    EyePathState diffuseMask = path.mask, glossyMask = path.mask;
    layers_.filter().prepend(diffuseMask, Event::Diffuse);
    layers_.filter().prepend(glossyMask, Event::Glossy);
    const bool counts = &from == &photons_->caustic()
                            ? layers_.causticCounts(diffuseMask) || layers_.causticCounts(glossyMask)
                            : layers_.indirectCounts(diffuseMask);
    if (!counts) return;
    const GatheredLight& light = from.gather(query, v.bsdf, v.frame, v.wo, scratch.gather);
    ++scratch.counters.gathers;
    scratch.counters.gathered += light.photons;
    // The full picture gets the sum over all photons, which does not depend on how layers group them.
    const Rgb before = scratch.sums.layer[0];
    if (!layers_.hasOnly()) scratch.sums.addFull(path.state.throughput * light.total);
    for (const GatheredPaths& g : light.paths) {
        const Rgb fromDiffuse = path.state.throughput * g.diffuse, fromGlossy = path.state.throughput * g.glossy;
        const auto& state = from.groups().state(g.group);
        if (!state) {
            if (!layers_.hasOnly())
                scratch.sums.layer[static_cast<size_t>(layers_.unclassified())] += fromDiffuse + fromGlossy;
            continue;
        }
        if (!isBlack(fromDiffuse)) scratch.sums.contributeToLayers(layers_, fromDiffuse, *state, diffuseMask);
        if (!isBlack(fromGlossy)) scratch.sums.contributeToLayers(layers_, fromGlossy, *state, glossyMask);
    }
    // Of --only's paths as much of it as they have of the light.
    const float of = luminance(path.state.throughput * light.total);
    const float share = of != 0 ? std::clamp(luminance(scratch.sums.layer[0] - before) / of, 0.0F, 1.0F) : 0;
    scratch.sums.photonVariance += share * mean(square(path.state.throughput) * light.variance);
}

// Goes on from the vertex: all delta lobes as branches while there are splits left, else one sampled lobe. False: the
// path ends (its branches are on the stack).
bool EyeTracer::split(const Vertex& v, EyePath& path, EyeScratch& scratch) const {
    BsdfSample sample;
    if (path.bsdfSamples < 1) {
        if (path.sampler.next() >= path.bsdfSamples) return false;
        path.state.throughput /= path.bsdfSamples;
    }
    if (!hasDelta(v.bsdf)) return bounce(v, path, scratch);
    if (path.splits == 0 || std::holds_alternative<MirrorBsdf>(v.bsdf)) {
        const float uLobe = path.sampler.next();
        return sampleBsdf(v.bsdf, v.wo, uLobe, path.sampler.next2D(), sample) && step(v, sample, path);
    }
    const DeltaLobes lobes = deltaLobes(v.bsdf, v.wo);
    const bool others = hasDiffuseLobe(v.bsdf) || hasGlossyLobe(v.bsdf);
    const float weight = maxComponent(path.state.throughput);
    float least = kInfinity;
    for (int i = 0; i < lobes.count; ++i)
        least = std::min(least, maxComponent(lobes.lobe[static_cast<size_t>(i)].weight));
    if (weight * least < settings_.splitThreshold && lobes.count + (others ? 1 : 0) > 1) {
        const float uLobe = path.sampler.next();
        return sampleBsdf(v.bsdf, v.wo, uLobe, path.sampler.next2D(), sample) && step(v, sample, path);
    }
    // Branches after the first have numbers of their own; the path itself goes on with the last lobe.
    const int last = lobes.count - 1;
    for (int i = 0; i < (others ? lobes.count : last); ++i) {
        EyePath branch = path;
        branch.sampler = path.sampler.fork(static_cast<uint32_t>(i));
        --branch.splits;
        if (step(v, lobes.lobe[static_cast<size_t>(i)], branch)) scratch.branches.push_back(branch);
    }
    if (!others) {
        --path.splits;
        return step(v, lobes.lobe[static_cast<size_t>(last)], path);
    }
    const float uLobe = path.sampler.next();
    return sampleNonDelta(v.bsdf, v.wo, uLobe, path.sampler.next2D(), sample) && step(v, sample, path);
}

// Goes on from a vertex without delta lobes: at the first one of a path in several directions, since it is there that
// most of the variance of indirect light arises. Their numbers are one point shifted by even steps (Cranley & Patterson
// 1976), so that they lie apart.
bool EyeTracer::bounce(const Vertex& v, EyePath& path, EyeScratch& scratch) const {
    const float uLobe = path.sampler.next();
    const Vec2 u = path.sampler.next2D();
    const int branches = path.mayBranch && !path.endsAt(v) ? settings_.indirectBranches : 1;
    path.mayBranch = false;
    path.state.throughput /= static_cast<float>(branches);
    BsdfSample sample;
    for (int i = 1; i < branches; ++i) {
        EyePath branch = path;
        branch.sampler = path.sampler.fork(static_cast<uint32_t>(i));
        const float x = rotated(u.x, static_cast<float>(i) / static_cast<float>(branches));
        if (sampleBsdf(v.bsdf, v.wo, uLobe, {x, u.y}, sample) && step(v, sample, branch))
            scratch.branches.push_back(branch);
    }
    return sampleBsdf(v.bsdf, v.wo, uLobe, u, sample) && step(v, sample, path);
}

// Through a smooth thin wall, on the way to an emitter. False: there is something else.
bool EyeTracer::passStraight(const Vertex& v, EyePath& path) const {
    if (!hasDelta(v.bsdf)) return false;
    const DeltaLobes lobes = deltaLobes(v.bsdf, v.wo);
    for (int i = 0; i < lobes.count; ++i) {
        const BsdfSample& lobe = lobes.lobe[static_cast<size_t>(i)];
        if (lobe.straight) return step(v, lobe, path);
    }
    return false;
}

bool EyeTracer::step(const Vertex& v, const BsdfSample& sample, EyePath& path) const {
    if (!scatter(v, sample, Quantity::Radiance, path.state)) return false;
    const VertexClass c = classOf(v.bsdf, sample);
    path.walk.pass(c, path.endsAtDiffuse && sample.event == Event::Diffuse);
    path.endsAtDiffuse = false;
    layers_.filter().prepend(path.mask, sample.event);
    if (!layers_.alive(path.mask)) return false;
    ++path.depth;
    if (c != VertexClass::Straight) {
        path.travelled = 0;
        path.lastDelta = sample.delta;
    }
    const bool again = path.metDiffuse;
    if (!sample.delta) {
        path.splits = settings_.splits;
        path.misPdf = sample.pdfW;
        path.place = litPlace(v);
        // Weights must sum to one with those of light sampling, which knows of no split.
        if (hasDelta(v.bsdf)) {
            const BsdfEval f = evalBsdf(v.bsdf, v.wo, sample.wi);
            path.misPdf = sample.event == Event::Diffuse ? f.diffuse.pdfW : f.glossy.pdfW;
        }
        path.misPdf *= path.bsdfSamples / static_cast<float>(path.lightSamplesHere());
        path.bsdfSamples = 1;
        path.metDiffuse |= c == VertexClass::Diffuse;
    }
    // Russian roulette: by the lobe's weight from the second diffuse event on, which keeps the throughput even; by the
    // throughput itself only where little is left of it; and a little for what a mirror or glass may keep for ever.
    float keep = 1;
    if (!sample.delta && again) keep = std::min(1.0F, maxComponent(sample.weight));
    keep = std::min(keep, maxComponent(path.state.throughput) / settings_.rouletteThreshold);
    if (path.depth > settings_.freeDepth) keep = std::min(keep, 0.95F);
    if (keep >= 1) return true;
    if (path.sampler.next() >= keep) return false;
    path.state.throughput /= keep;
    return true;
}

}  // namespace lsde
