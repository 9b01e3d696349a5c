#include "passes/render.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "passes/clock.h"
#include "passes/explain.h"
#include "passes/map_source.h"
#include "passes/picture.h"
#include "passes/sample_plan.h"
#include "passes/scene_source.h"
#include "scene/creases.h"

namespace lsde {

namespace {

constexpr double kDefaultSamples = 64;
// Of a time limit, where there are caustics: what the pixels can spare, within bounds.
constexpr double kLeastEmissionShare = 0.25, kMostEmissionShare = 0.45;
constexpr double kPixelSeconds = 6e-5;  // for half a dozen samples, roughly, of a pixel that sees a surface
constexpr uint32_t kPilotRadiusPhotons = 50;

// What ends the camera pass.
struct SampleLimits {
    uint64_t begin = 0;           // number of the first sample
    std::optional<double> count;  // samples a pixel
    std::optional<Clock> clock;
    double reserve = 0;           // s, kept for what comes after
    std::optional<double> error;  // of the estimated relMSE
    bool whole = false;           // every pixel gets the same number
    double taken = 0;             // samples that the integrator has had already
};

// Of the picture as far as it has come.
std::optional<PictureError::Relative> relativeError(const Integrator& integrator, double samples) {
    const auto error = integrator.error(samples);
    return error ? std::optional(error->relativeTo(integrator.develop(0, samples))) : std::nullopt;
}

// Samples after `done` that an error of the camera's part would take to come down to what the photons leave of the
// limit; 0: it is there, or the photons alone exceed it and samples cannot help.
double samplesForError(const Integrator& integrator, double done, double limit) {
    constexpr double kLeast = SamplePlan::kUniform + 1;  // fewer say too little of the noise
    constexpr double kSmallPart = 0.1;
    if (done < kLeast) return kLeast - done;
    const PictureError::Relative error = relativeError(integrator, done).value();
    if (error.total() <= limit) return 0;
    const double left = std::max(limit - error.photons, kSmallPart * error.photons);
    if (error.camera <= left) return 0;
    return std::clamp(std::floor(done * (error.camera / left - 1)), 1.0, done);
}

// Samples until the count or the time is reached; returns how many. At least one for each square of eight by eight
// pixels is taken.
double takeSamples(Integrator& integrator, const SampleLimits& limits, RunContext& run, bool& interrupted) {
    // Fractions are few, so that they are exact in decimal as well; less than the last is lost of the time.
    constexpr double kFraction = 1.0 / 64, kLeastStep = 1.0 / 16;
    // What a sample costs is known while every pixel gets its first ones, and again when some were taken after them,
    // which go where there is most to do and may cost ten times as much: then up to so many are taken at once where
    // time ends.
    constexpr double kLastSamples = 2, kSure = 0.95;
    const PhaseTimer timer(run, "camera");
    const auto begin = static_cast<double>(limits.begin);
    double done = limits.taken, step = 1;
    if (limits.clock && !limits.whole) step = done < SamplePlan::kUniform ? kFraction : kLeastStep;
    const double start = limits.clock ? limits.clock->used() : 0;
    double usedBefore = 0;
    while (!limits.count || done < *limits.count) {
        if (run.interrupted() && done > 0) {
            interrupted = true;
            break;
        }
        if (limits.error) {
            const double more = samplesForError(integrator, done, *limits.error);
            if (more == 0) break;
            step = limits.clock ? std::min(step, more) : more;
        }
        if (limits.count) step = std::min(step, *limits.count - done);
        integrator.render(begin + done, begin + done + step, run);
        done += step;
        if (!limits.clock) {
            run.progress("camera", done / limits.count.value_or(2 * done));
            step = std::min(2 * step, 16.0);
            continue;
        }
        const Clock& clock = *limits.clock;
        const bool first = done < SamplePlan::kUniform, adapted = done - step >= SamplePlan::kUniform;
        const double used = clock.used() - start;
        const double perSample = (used - usedBefore) / step;
        usedBefore = used;
        const double affordable = (clock.left() - limits.reserve) / perSample;
        run.progress("camera", used / std::max(1e-9, clock.limit() - limits.reserve - start));
        if (affordable < (limits.whole ? 0.5 : first ? kFraction : kLeastStep)) break;
        const double share = first || affordable <= kLastSamples ? kSure : 0.5;
        step = std::min(share * affordable, first ? SamplePlan::kUniform - done : adapted ? 64.0 : kLeastStep);
        step = limits.whole ? std::max(1.0, std::floor(step)) : std::max(1.0, std::floor(step / kFraction)) * kFraction;
    }
    return done;
}

float progressiveScale(uint32_t pass) {  // Knaus & Zwicker 2011, eq. 20, a = 2/3
    double ratio = 1;
    for (uint32_t j = 1; j <= pass; ++j) ratio *= (j + 2.0 / 3) / (j + 1);
    return static_cast<float>(std::sqrt(ratio));
}

Camera makeCamera(const CameraDescription& d, const RenderSettings& settings) {
    const auto size = pictureSize(d, settings.size);
    Camera camera(d, size[0], size[1]);
    if (!settings.crop) return camera;
    const Crop& c = *settings.crop;
    if (c.x0 < 0 || c.y0 < 0 || c.x1 > size[0] || c.y1 > size[1] || c.x0 >= c.x1 || c.y0 >= c.y1)
        throw UsageError(fmt::format("--crop {},{},{},{}: expected X0,Y0,X1,Y1 within 0,0,{},{}", c.x0, c.y0, c.x1,
                                     c.y1, size[0], size[1]));
    camera.crop(c.x0, c.y0, c.x1, c.y1);
    return camera;
}

class Render {
  public:
    Render(const Scene& scene, const IntegratorEntry& method, const RenderSettings& settings,
           std::span<const CameraDescription> cameras, RunContext& run)
        : scene_(scene),
          settings_(settings),
          run_(run),
          method_(method),
          layers_(settings.paths, settings.only),
          selected_(scene.lightSelection(settings.lights)),
          clock_(settings.cpuLimit, settings.wallLimit) {
        if (scene.lights().empty()) throw Error(noLightError(scene));
        for (const CameraDescription& camera : cameras) cameras_.push_back(makeCamera(camera, settings));
        if (settings.progressive > 0 && cameras_.size() > 1)
            throw UsageError(
                "--progressive: emits maps for a picture of its own, cannot be combined with --camera all");
        if (settings.errorLimit && settings.progressive > 0)
            throw UsageError("--error: says when one picture is done, cannot be combined with --progressive");
        if (settings.errorLimit && !method.knowsError)
            throw UsageError(fmt::format("--error: the method {} does not know its error", method.name));
        if (const std::string missing = method_.cannotMake(scene); !missing.empty()) run.warn(missing);
    }

    void pictures(const OnPicture& onPicture) {
        samples_ = settings_.spp;
        if (!clock_.limited() && !settings_.errorLimit && !samples_) samples_ = kDefaultSamples;
        if (settings_.progressive > 0 && method_.usesPhotons) {
            progressivePasses();
            onPicture(0, finished());
            return;
        }
        preparePhotons();
        for (frame_ = 0; frame_ < cameras_.size() && !result_.interrupted; ++frame_) {
            mean_ = {};
            result_.samples = 0;
            result_.notFinite = 0;
            SampleLimits limits{0, samples_, {}, 0, settings_.errorLimit};
            if (clock_.limited()) {
                limits.clock = clock_.slice(clock_.left() / static_cast<double>(cameras_.size() - frame_));
                limits.reserve = reserve();
            }
            see(gather_ ? &*gather_ : nullptr, limits, 1);
            onPicture(frame_, finished());
        }
    }

  private:
    const Camera& camera() const { return cameras_[frame_]; }

    RenderResult finished() const {
        RenderResult r = result_;
        r.image = mean_.file(layers_.filmLayers());
        r.picture = mean_.full();
        if (mean_.hasError()) r.relativeError = mean_.error().relativeTo(r.picture);
        r.metadata = describePicture(scene_, camera(), layers_,
                                     {method_.name, settings_.only.value_or(""), run_.seed, r.photons, r.samples});
        if (r.notFinite > 0) run_.warn(fmt::format("{} contributions were not finite and were left out", r.notFinite));
        return r;
    }

    double emissionShare() const {
        double pixels = 0;
        for (const Camera& c : cameras_)
            pixels += filledShare(c) * static_cast<double>(c.filmWidth()) * static_cast<double>(c.filmHeight());
        const double cpuSeconds = clock_.limit() * (clock_.wall() ? run_.pool.threads() : 1);
        return std::clamp(1 - kPixelSeconds * pixels / cpuSeconds, kLeastEmissionShare, kMostEmissionShare);
    }

    double emissionSeconds() const { return emissionShare() * (clock_.left() - reserve()); }

    // Of the picture: where there is anything to see.
    double filledShare(const Camera& camera) const {
        constexpr int kSide = 64;
        int hits = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const Vec2 at((static_cast<float>(x) + 0.5F) / kSide, (static_cast<float>(y) + 0.5F) / kSide);
                const Vec2 pixel =
                    Vec2(camera.filmX(), camera.filmY()) + at * Vec2(camera.filmWidth(), camera.filmHeight());
                Hit hit;
                if (scene_.accel().intersect(camera.ray(pixel, Vec2(0)).ray, hit)) ++hits;
            }
        return static_cast<double>(hits) / (kSide * kSide);
    }

    double reserve() const {  // s: developing and writing the picture
        const double values = static_cast<double>(camera().filmWidth()) * camera().filmHeight() * 3 *
                              static_cast<double>(layers_.filmLayers().size());
        // What is black compresses well.
        const double seconds = 0.03 + (4.5e-8 + 5e-8 * filledShare(camera())) * values;
        // Most of it is shared by the threads.
        return clock_.wall() ? seconds * (0.2 + 0.8 / run_.pool.threads()) : seconds;
    }

    bool indirectFromMap() const { return settings_.indirectFromMap && layers_.wantsIndirect(); }

    EmitSettings emitSettings() const {
        EmitSettings e;
        e.photons = settings_.photons.value_or(kDefaultPhotons);
        e.lights = settings_.lights;
        e.store = indirectFromMap() ? Store::Indirect : Store::Caustic;
        return e;
    }

    PhotonMap map() {
        if (clock_.limited() && settings_.map.empty() && !settings_.photons)
            return mapByTime(scene_, emitSettings(), clock_, {emissionSeconds()}, run_);
        SourcedMap sourced =
            mapByCount(scene_, {settings_.map, settings_.cache, settings_.otherScene, emitSettings()}, run_);
        result_.cachedMap = sourced.cached;
        return std::move(sourced.map);
    }

    void note(const PhotonMap& map) {
        result_.photons += map.header.emittedPaths();
        result_.storedPhotons += map.photons(PhotonClass::Caustic).count;
        result_.storedIndirect += map.photons(PhotonClass::Indirect).count;
        const Explanation e = explain(scene_, selected_, map.header.ledger, map.header.emittedPaths());
        if (!e.noCaustics.empty()) noCaustics_ = e.noCaustics;
    }

    GatherInput gatherInput(const PhotonMap& map) {
        if (!creases_) creases_ = findCreases(scene_);
        return {scene_, map, *creases_, selected_, layers_.filter()};
    }
    GatherSettings gatherSettings() const {
        GatherSettings g;
        g.index = settings_.index;
        g.indirectFromMap = indirectFromMap();
        return g;
    }

    std::unique_ptr<Integrator> makeIntegrator(const PhotonGather* photons) const {
        return method_.make({scene_, camera(), layers_, selected_, photons, run_.seed});
    }

    // The camera pass, and its picture added to the mean; returns the samples taken.
    double see(const PhotonGather* photons, SampleLimits limits, double weight) {
        auto [integrator, taken] = std::exchange(begun_, {});
        if (!integrator) integrator = makeIntegrator(photons);
        limits.taken = taken;
        const double done = takeSamples(*integrator, limits, run_, result_.interrupted);
        const PhaseTimer timer(run_, "develop");
        std::vector<RgbImage> pictures(layers_.filmLayers().size());
        run_.pool.forEach(pictures.size(),
                          [&](size_t i) { pictures[i] = integrator->develop(static_cast<int>(i), done); });
        mean_.add(pictures, weight);
        if (const auto error = integrator->error(done)) mean_.addError(*error, weight);
        result_.samples += done;
        result_.notFinite += integrator->notFinite();
        return done;
    }

    // What all pictures share.
    void preparePhotons() {
        if (!method_.usesPhotons || !(layers_.wantsCaustic() || indirectFromMap())) return;
        if (settings_.errorLimit && settings_.map.empty() && !settings_.photons) {
            emitForError(*settings_.errorLimit);
        } else {
            map_ = map();
            gather_.emplace(gatherInput(map_), gatherSettings(), run_);
        }
        note(map_);
        if (!noCaustics_.empty()) run_.warn(noCaustics_);
    }

    // As many photons as bring their part of the first picture's error down to a share of the limit; that picture is
    // begun.
    void emitForError(double limit);

    void progressivePasses();

    const Scene& scene_;
    const RenderSettings& settings_;
    RunContext& run_;
    const IntegratorEntry& method_;
    RenderLayers layers_;
    std::vector<bool> selected_;
    std::vector<Camera> cameras_;
    size_t frame_ = 0;  // the camera whose picture is being made
    Clock clock_;
    std::optional<double> samples_;
    std::optional<std::vector<Segment>> creases_;
    std::string noCaustics_;
    PhotonMap map_;
    std::optional<PhotonGather> gather_;
    struct Begun {
        std::unique_ptr<Integrator> integrator;
        double samples = 0;
    } begun_;  // of the picture that is next
    PictureMean mean_;
    RenderResult result_;
};

void Render::emitForError(double limit) {
    constexpr double kShare = 0.5;        // of the limit that photons may take
    constexpr double kAim = 0.4;          // and that the next number is reckoned by
    constexpr double kExponent = 1.3;     // their error falls slower than by their number
    constexpr double kMostPhotons = 2e8;  // paths: 8 GB of photons
    constexpr double kLeastGrowth = 2, kMostGrowth = 8;
    EmitSettings emit = emitSettings();
    for (bool first = true;; first = false) {
        const double start = clock_.used();
        SampleLimits limits;
        limits.count = std::min<double>(SamplePlan::kUniform, samples_.value_or(SamplePlan::kUniform));
        if (first && clock_.limited()) {
            map_ = mapByTime(scene_, emit, clock_, {emissionSeconds(), emit.photons}, run_);
            limits.clock = clock_.slice(0.5 * clock_.left());
        } else {
            map_ = emitPhotons(scene_, emit, run_);
        }
        gather_.emplace(gatherInput(map_), gatherSettings(), run_);
        begun_.integrator = makeIntegrator(&*gather_);
        begun_.samples = takeSamples(*begun_.integrator, limits, run_, result_.interrupted);
        const auto error = relativeError(*begun_.integrator, begun_.samples);
        if (!error || result_.interrupted) return;
        const double photons = error->photons;
        const auto paths = static_cast<double>(map_.header.emittedPaths());
        if (photons <= kShare * limit || paths >= kMostPhotons) return;
        const double growth = std::clamp(std::pow(photons / (kAim * limit), kExponent), kLeastGrowth, kMostGrowth);
        // Half of what time there is, at most: the rest is for the picture.
        if (clock_.limited() && growth * (clock_.used() - start) > 0.5 * clock_.left()) return;
        emit.photons = static_cast<uint64_t>(std::min(growth * paths, kMostPhotons));
    }
}

// Each pass has photons of its own and a radius that shrinks from the pilot's (the first pass's map); the pictures are
// averaged. Under a time limit the first pass finds out what a pass may cost, and all others have its counts, so that
// the same picture can be had by counts.
void Render::progressivePasses() {
    if (!settings_.map.empty()) throw UsageError("--progressive: emits its own maps, cannot be combined with --map");
    const uint32_t passes = settings_.progressive;
    const uint64_t photons = settings_.photons.value_or(kDefaultPhotons);
    if (samples_.value_or(passes) < passes || photons < passes)
        throw UsageError(fmt::format("--progressive {}: expected at most --spp ({}) and --photons ({}) passes", passes,
                                     samples_.value_or(kDefaultSamples), photons));
    if (samples_ && *samples_ != std::floor(*samples_))
        throw UsageError(fmt::format("--spp {}: expected a whole number with --progressive", *samples_));
    const uint64_t seed = run_.seed;
    std::optional<PhotonMap> pilotMap;
    std::optional<PhotonGather> pilot;
    const AnyIndex* pilotIndex = nullptr;
    std::optional<uint64_t> pathsEach;
    std::optional<double> samplesEach;
    double longest = 0;
    for (uint32_t pass = 0; pass < passes && !result_.interrupted; ++pass) {
        if (clock_.limited() && pass > 0 && clock_.left() - reserve() < longest) break;
        const double start = clock_.used();
        const double slice = clock_.limited() ? (clock_.left() - reserve()) / (passes - pass) : 0;
        EmitSettings emit = emitSettings();
        const IndexRange share = shardRange(photons, pass + 1, passes);
        emit.photons = pathsEach.value_or(share.end - share.begin);
        run_.seed = hashCombine(seed, pass);  // independent photons
        const bool byTime = clock_.limited() && !settings_.photons && pass == 0;
        const PhotonMap map =
            byTime ? mapByTime(scene_, emit, clock_, {emissionShare() * slice}, run_) : emitPhotons(scene_, emit, run_);
        run_.seed = seed;
        note(map);
        if (byTime) pathsEach = map.header.emittedPaths();
        if (pass == 0) {
            const PhotonMap& kept = pilotMap.emplace(map);
            pilotIndex = &pilot.emplace(gatherInput(kept), gatherSettings(), run_).caustic().index();
        }
        GatherSettings settings = gatherSettings();
        settings.progressive = {pilotIndex, kPilotRadiusPhotons, progressiveScale(pass)};
        const PhotonGather gather(gatherInput(map), settings, run_);
        SampleLimits limits{static_cast<uint64_t>(result_.samples), samplesEach, {}, 0, {}, true};
        if (samples_) {
            const IndexRange range = shardRange(static_cast<uint64_t>(*samples_), pass + 1, passes);
            limits.count = static_cast<double>(range.end - range.begin);
        } else if (!samplesEach) {
            limits.clock = clock_.slice(slice - (clock_.used() - start));
        }
        const double done = see(&gather, limits, static_cast<double>(map.header.emittedPaths()));
        if (!samples_) samplesEach = done;
        longest = std::max(longest, clock_.used() - start);
        ++result_.passes;
        run_.progress("passes", static_cast<double>(pass + 1) / passes);
    }
    if (!noCaustics_.empty()) run_.warn(noCaustics_);
}

}  // namespace

void renderPictures(const Scene& scene, const IntegratorEntry& method, const RenderSettings& settings,
                    std::span<const CameraDescription> cameras, RunContext& run, const OnPicture& onPicture) {
    Render(scene, method, settings, cameras, run).pictures(onPicture);
}

RenderResult renderPicture(const Scene& scene, const IntegratorEntry& method, const RenderSettings& settings,
                           RunContext& run) {
    RenderResult result;
    const std::array cameras{scene.camera(settings.camera)};
    renderPictures(scene, method, settings, cameras, run, [&](size_t, RenderResult&& r) { result = std::move(r); });
    return result;
}

}  // namespace lsde
