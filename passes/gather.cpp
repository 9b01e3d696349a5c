#include "passes/gather.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lsde {

namespace {

// Where the normals agree so closely a Lambertian surface needs no photon's direction.
constexpr float kFlat = 0.999999F;

// Where a shading normal is further than this (cosine) from the geometric one, light may come from behind it.
constexpr float kBentNormal = 0.998F;

// Sums of a block take 12 bytes for each group, a third of a photon: for 16 photons, no more than they take.
constexpr size_t kMostGroupsOfBlocks = 16;

// Area on which the class's photons lie: that of the objects on which any landed.
double litArea(const Scene& scene, const PhotonMap& map, PhotonClass c) {
    const auto& flux = map.header.ledger.flux;
    const size_t objects = map.header.objects.size();
    double area = 0;
    for (const MeshInfo& mesh : scene.meshes()) {
        // A map of another scene (--other-scene) names objects that are not there.
        if (mesh.object >= objects) continue;
        const size_t at = static_cast<size_t>(c) * objects + mesh.object;
        if (at < flux.size() && !(flux[at] == FixedRgb())) area += mesh.area;
    }
    return area;
}

AnyIndex makeIndex(IndexKind kind, const PhotonTreeView& tree, RunContext& run) {
    if (kind == IndexKind::Kd) return AnyIndex(std::in_place_type<KdIndex>, tree);
    const PhaseTimer timer(run, "build FLANN index");
    return AnyIndex(std::in_place_type<FlannIndex>, tree);
}

// The radius that holds `count` photons of the class at its mean density on what is lit.
float radiusAtMean(const GatherInput& input, PhotonClass c, float count) {
    const PhotonTreeView tree = input.map.photons(c);
    if (tree.count == 0) return 0;
    double area = litArea(input.scene, input.map, c);
    if (!(area > 0)) area = kPi * square(input.scene.boundingSphere().radius);
    return static_cast<float>(std::sqrt(count * area / (kPi * static_cast<double>(tree.count))));
}

// The radius that holds kNear photons around nearly all of them: by area most of a stadium is dark, and the radius of
// the mean density would reach over all there is to see.
constexpr uint32_t kNear = 50;
float radiusAtMost(const PhotonTreeView& tree, const AnyIndex& index) {
    constexpr size_t kSampled = 256;
    constexpr double kShare = 0.95;
    constexpr float kBeyond = 3;
    if (tree.count <= kNear) return kInfinity;
    DensityScratch scratch;
    std::vector<float> radii;
    const size_t step = std::max<size_t>(1, tree.count / kSampled);
    for (size_t i = 0; i < tree.count; i += step)
        radii.push_back(distanceToKth(index, tree.position(i), kNear, kInfinity, scratch));
    const auto most = radii.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(radii.size()));
    std::nth_element(radii.begin(), most, radii.end());
    return kBeyond * *most;
}

// Further than this the surface turns away from its tangent plane, and a disc would count what it does not reach: of a
// thin tube most.
float reachOnSurface(const SurfacePoint& p) {
    constexpr float kShare = 0.4F;  // of the radius of curvature (kPlaneThickness)
    return p.curvature > 0 ? kShare / p.curvature : kInfinity;
}

// A pilot radius may exceed that of the mean density, where photons are sparse.
constexpr float kPilotRadius = 4;

// Photons of a disc that are enough for one of a pixel's samples, where each has to be scattered by itself: at least so
// many are taken, less than twice as many. From 16 to 64 error times CPU seconds is the same; all of a wide disc's
// thousands take ten times as long.
constexpr float kEnoughScattered = 32;

// One in as many as leaves enough.
EveryNth someOf(const DensityQuery& query, float enough, float u) {
    constexpr float kMost = 65536;
    const uint32_t stride = std::bit_floor(static_cast<uint32_t>(std::clamp(query.expected / enough, 1.0F, kMost)));
    return {stride, static_cast<uint32_t>(u * static_cast<float>(stride))};
}

struct Receiver {
    const PhotonGatherQuery& query;
    const Bsdf& bsdf;
    const Frame& frame;
    Vec3 wo;
    bool passes;        // its glossy lobe
    uint16_t packedNg;  // the query's, as photons have theirs
};

// Whether neither direction's shading side is the other of its geometric one: reflected light would count as light that
// went through.
bool sidesAgree(const Receiver& at, Vec3 direction, Vec3 wi) {
    const Vec3 ng = at.query.point.ng;
    return glm::dot(direction, ng) * wi.z > 0 && glm::dot(at.frame.toWorld(at.wo), ng) * at.wo.z > 0;
}

// Adds one photon's light, of the arriving irradiance, by lobe; that of a Lambertian surface without its albedo / pi.
void scatterPhoton(const PhotonPayload& p, Rgb arriving, const Receiver& at, GatheredPaths& out,
                   GatherScratch& scratch) {
    const Vec3 direction = unpackDirection(p.direction);
    const Vec3 wi = at.frame.toLocal(direction);
    // On curved surfaces the facet that it met is another one, on which power lies more or less densely.
    const Vec3 ng = p.normal == at.packedNg ? at.query.point.ng : unpackNormal(p.normal);
    float shading = std::fabs(wi.z / glm::dot(direction, ng));
    if (!(shading <= kMaxShadingWeight)) {
        shading = kMaxShadingWeight;
        ++scratch.clamped;
    }
    const Rgb power = arriving * shading;
    if (std::holds_alternative<DiffuseBsdf>(at.bsdf)) {
        if (wi.z * at.wo.z > 0) out.diffuse += power;
        return;
    }
    if (at.passes && !sidesAgree(at, direction, wi)) return;
    const bool glossy = at.query.glossyFromAll || (at.query.glossyFromFlagged && (p.flags & kGlossyGather) != 0);
    const BsdfEval f = evalBsdf(at.bsdf, at.wo, wi, glossy ? Asked::F : Asked::DiffuseF);
    if (!at.query.glossyOnly) out.diffuse += power * f.diffuse.f;
    if (glossy) out.glossy += power * f.glossy.f / square(f.eta);
}

// A photon as a path from the eye sees it.
struct Match {
    Rgb power{0};      // W of one path, in the picture's channels
    float kernel = 1;  // over wavelengths, where both have one; in `power`
};

// The weight is the photon's where both have a wavelength: where light of one arrives, its colour is kept, and what the
// eye's path carries is smeared over wavelengths.
Match matchOf(const PhotonPayload& p, WavelengthId eye, float share) {
    if (p.wavelength == kAllWavelengths) return {weighed(unpackPower(p.power), eye)};
    if (eye == kAllWavelengths) return {rgbPower(p)};
    const float kernel = wavelengthKernel(p.wavelength, eye, share);
    return {kernel * rgbPower(p), kernel};
}

PathGroups groupsOf(const GatherInput& input, const PhotonTreeView& tree, RunContext& run) {
    const PhaseTimer timer(run, "group photons");
    return {input.filter, tree.count,
            [&](size_t i) {
                const PhotonPayload& p = tree.payload[i];
                return input.lights[p.light] ? std::optional(PathCode(p.path)) : std::nullopt;
            },
            input.map.scratchPlace(), run.pool};
}

}  // namespace

RadiusRule scaledTo(uint64_t photons, RadiusRule rule) {
    constexpr double kLeast = 0.15;
    const double growth = std::max(kLeast, std::cbrt(square(static_cast<double>(photons) / rule.photons)));
    uint32_t& mostCount = rule.irradiance.bandwidth.mostCount;
    mostCount = static_cast<uint32_t>(std::lround(static_cast<double>(mostCount) * growth));
    rule.reachAtMean *= static_cast<float>(growth);
    return rule;
}

bool scattersAlike(const Bsdf& bsdf, const SurfacePoint& point) {
    return std::holds_alternative<DiffuseBsdf>(bsdf) && glm::dot(point.ng, point.ns) > kFlat;
}

ClassGather::ClassGather(const GatherInput& input, PhotonClass c, const GatherSettings& settings,
                         const RadiusRule& rule, const ProgressiveRadius& progressive, RunContext& run)
    : tree_(input.map.photons(c)),
      index_(makeIndex(settings.index, tree_, run)),
      rule_(scaledTo(tree_.count, rule)),
      progressive_(progressive),
      wavelengthShare_(settings.wavelengthShare * settings.progressive.scale),
      dispersion_(input.map.header.dispersion[static_cast<size_t>(c)]),
      groups_(groupsOf(input, tree_, run)),
      maxRadius_(radiusAtMean(input, c, rule_.growthAtMean)),
      reach_(radiusAtMean(input, c, rule_.reachAtMean)) {
    const float most = radiusAtMost(tree_, index_);
    maxRadius_ = std::min(maxRadius_, most * std::sqrt(rule_.growthAtMean / static_cast<float>(kNear)));
    reach_ = std::min(reach_, most * std::sqrt(rule_.reachAtMean / static_cast<float>(kNear)));
    if (progressive.pilot != nullptr) maxRadius_ *= kPilotRadius;
    extent_ = SurfaceExtent(input.creases);
    const uint64_t paths = input.map.header.emittedPaths();
    perPath_ = paths > 0 ? 1 / static_cast<double>(paths) : 0;
    if (progressive.pilot != nullptr) return;
    const bool dispersed = input.scene.disperses();
    const ScratchPlace place = input.map.scratchPlace();
    if (!dispersed && groups_.size() <= kMostGroupsOfBlocks)
        blocks_ = BlockTable(tree_, groups_.all(), groups_.size(), place, run.pool);
    cache_ =
        std::make_unique<IrradianceCache>(PhotonSource{index_, extent_, groups_.all(), groups_.size(), perPath_, reach_,
                                                       dispersed, blocks_.empty() ? nullptr : &blocks_, place},
                                          rule_.irradiance);
}

DensityQuery ClassGather::densityQuery(const PhotonGatherQuery& query, GatherScratch& scratch) const {
    DensityQuery density;
    density.point = query.point;
    density.sideNormal = query.sideNormal;
    density.medium = query.medium;
    density.minCount = rule_.minCount;
    density.requiredFlags = query.glossyOnly ? kGlossyGather : 0;
    const float least = leastRadius(query.point.position);
    density.maxRadius = std::max(std::min(maxRadius_, reachOnSurface(query.point)), least);
    if (progressive_.pilot != nullptr) {
        const float r1 =
            distanceToKth(*progressive_.pilot, query.point.position, progressive_.k, density.maxRadius, scratch.pilot);
        density.minRadius = density.maxRadius = std::max(r1 * progressive_.scale, least);
    } else {
        density.minRadius = std::clamp(rule_.footprintShare * query.point.footprint, least, density.maxRadius);
    }
    return density;
}

float ClassGather::sharedVariance(const PhotonGatherQuery& query, Vec3 wo, float area, float photons) const {
    // The integral of Epanechnikov's kernel squared is that of an even one of 3/4 the area.
    const float kernel = 0.75F * area;
    const float pixel = square(query.point.footprint) / std::max(0.01F, std::fabs(wo.z));
    return kernel / (kernel + pixel) * dispersion_.at(photons * (kernel + pixel) / area);
}

// Whether the light was found in the cache; else `density` gets the bandwidth as its least radius.
bool ClassGather::known(const PhotonGatherQuery& query, DensityQuery& density, const Bsdf& bsdf, Vec3 wo,
                        GatherScratch& scratch) const {
    if (cache_ == nullptr) return false;
    const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
    // What is kept is light of all wavelengths.
    const bool even = diffuse != nullptr && query.wavelength == kAllWavelengths &&
                      glm::dot(query.point.ng, query.point.ns) > kBentNormal;
    const CachedLight light = cache_->at(density, even, scratch.bandwidth);
    const float reach = reachOnSurface(query.point);
    if (!light.irradiance.empty() && light.over.length() <= reach) {
        const Rgb albedo = diffuse->albedo * (kInvPi * light.shading);
        for (size_t g = 0; g < groups_.size(); ++g)
            if (!isBlack(light.irradiance[g]))
                scratch.light.paths.push_back({static_cast<uint16_t>(g), albedo * light.irradiance[g]});
        scratch.light.total = albedo * light.irradiance[groups_.size()];
        scratch.light.variance = albedo * albedo * light.variance *
                                 sharedVariance(query, wo, light.over.area(), static_cast<float>(light.over.count));
        return true;
    }
    density.minRadius = std::max(density.minRadius, std::min(light.bandwidth.radius, reach));
    if (light.bandwidth.radius > 0)
        density.expected =
            static_cast<float>(light.bandwidth.count) * square(density.minRadius / light.bandwidth.radius);
    // Where the pixel's footprint is wider, it is as long.
    const float length = std::min(light.bandwidth.length(), reach);
    if (light.bandwidth.along != Vec3(0) && length > density.minRadius)
        density.along = glm::normalize(light.bandwidth.along) * std::sqrt(1 - square(density.minRadius / length));
    return false;
}

const GatheredLight& ClassGather::gather(const PhotonGatherQuery& query, const Bsdf& bsdf, const Frame& frame, Vec3 wo,
                                         GatherScratch& scratch) const {
    GatheredLight& out = scratch.light;
    out.paths.clear();
    out.total = out.variance = Rgb(0);
    out.photons = 0;
    if (empty() || glm::dot(query.sideNormal, frame.toWorld(wo)) == 0) return out;
    DensityQuery density = densityQuery(query, scratch);
    if (known(query, density, bsdf, wo, scratch)) return out;
    const SurfaceAround& surface = scratch.surface;
    extent_.around(query.point.position, query.point.ng, std::max(density.minRadius, density.maxRadius),
                   scratch.surface);
    density.balanced = surface.whole();
    if (!surface.whole() && surface.creaseNear(query.point.position, density.minRadius * stretchOf(density.along)))
        density.along = Vec3(0);
    const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
    const bool alike = scattersAlike(bsdf, query.point);
    const Receiver receiver{query, bsdf, frame, wo, glossyLobePasses(bsdf), packNormal(query.point.ng)};
    GatheredPaths total;
    Rgb squares(0);
    // Of those with a wavelength only what has about the eye's counts.
    const float enough = kEnoughScattered / (query.wavelength == kAllWavelengths ? 1 : wavelengthShare_);
    // A narrow lobe takes few of them: all.
    const EveryNth every = alike || query.glossyFromFlagged ? EveryNth() : someOf(density, enough, query.u);
    const auto take = [&](uint32_t i, float kernel) {
        const PhotonPayload& p = tree_.payload[i];
        const uint16_t group = groups_.of(i);
        if (group == PathGroups::kNone) return;
        if (!surface.whole() && surface.hides(tree_.position(i))) return;
        const Match match = matchOf(p, query.wavelength, wavelengthShare_);
        if (match.kernel == 0) return;
        ++out.photons;
        auto at =
            std::find_if(out.paths.begin(), out.paths.end(), [&](const GatheredPaths& g) { return g.group == group; });
        if (at == out.paths.end()) at = out.paths.insert(at, {group});
        GatheredPaths light;
        if (alike)
            light.diffuse = match.power * kernel;
        else
            scatterPhoton(p, match.power * kernel, receiver, light, scratch);
        at->diffuse += light.diffuse;
        at->glossy += light.glossy;
        total.diffuse += light.diffuse;
        total.glossy += light.glossy;
        // Over a pixel's samples, of all wavelengths, each photon counts as often as its kernel is narrow.
        squares += square(light.diffuse + light.glossy) / (match.kernel * static_cast<float>(every.stride));
    };
    const GatheredDisc disc =
        every.stride > 1
            ? gatherSome(tree_, density, every, scratch.density, take)
            : std::visit([&](const auto& index) { return gatherPhotons(index, density, scratch.density, take); },
                         index_);
    const auto perPath = static_cast<float>(perPath_) / surface.share(disc.radius);
    const Rgb scale = diffuse != nullptr ? diffuse->albedo * (kInvPi * perPath) : Rgb(perPath);
    for (GatheredPaths& g : out.paths) {
        g.diffuse *= scale;
        g.glossy *= perPath;
    }
    out.total = total.diffuse * scale + total.glossy * perPath;
    out.variance = squares * square(scale) *
                   sharedVariance(query, wo, kPi * square(disc.radius) * disc.stretch,
                                  static_cast<float>(out.photons * every.stride));
    return out;
}

PhotonGather::PhotonGather(const GatherInput& input, const GatherSettings& settings, RunContext& run)
    : caustic_(input, PhotonClass::Caustic, settings, settings.caustic, settings.progressive, run) {
    if (settings.indirectFromMap && input.map.stores(PhotonClass::Indirect)) makeIndirect(input, settings, run);
    input.map.expectLookups();
}

void PhotonGather::makeIndirect(const GatherInput& input, const GatherSettings& settings, RunContext& run) {
    RadiusRule rule = settings.indirect;
    BandwidthRule& bandwidth = rule.irradiance.bandwidth;
    // Pass by pass smaller, like the caustics' radius.
    const float shrunk = square(settings.progressive.scale);
    bandwidth.leastCount = std::max(2U, static_cast<uint32_t>(static_cast<float>(bandwidth.leastCount) * shrunk));
    bandwidth.mostCount =
        std::max(bandwidth.leastCount, static_cast<uint32_t>(static_cast<float>(bandwidth.mostCount) * shrunk));
    indirect_.emplace(input, PhotonClass::Indirect, settings, rule, ProgressiveRadius(), run);
}

}  // namespace lsde
