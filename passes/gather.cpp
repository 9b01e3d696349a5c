#include "passes/gather.h"

#include <algorithm>
#include <cmath>

namespace lsde {

namespace {

// |wi.Ns| / |wi.Ng| brings stored power to the shading frame (Veach 1997, section 5.3); grazing photons on bent normals
// would carry any weight, so it is bounded, and counted.
constexpr float kMaxShadingWeight = 10;

// Area on which the class's photons lie: that of the objects on which any landed.
double litArea(const Scene& scene, const PhotonMap& map) {
    const auto& flux = map.header.ledger.flux;
    const size_t objects = map.header.objects.size();
    double area = 0;
    for (const MeshInfo& mesh : scene.meshes()) {
        // A map of another scene (--other-scene) names objects that are not there.
        if (mesh.object >= objects) continue;
        const size_t at = static_cast<size_t>(PhotonClass::Caustic) * objects + mesh.object;
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
float radiusAtMean(const GatherInput& input, const PhotonTreeView& tree, uint32_t count) {
    if (tree.count == 0) return 0;
    double area = litArea(input.scene, input.map);
    if (!(area > 0)) area = kPi * square(input.scene.boundingSphere().radius);
    return static_cast<float>(std::sqrt(count * area / (kPi * static_cast<double>(tree.count))));
}

// A pilot radius may exceed that of the mean density, where photons are sparse.
constexpr float kPilotRadius = 4;

}  // namespace

PhotonGather::PhotonGather(const GatherInput& input, const GatherSettings& settings, RunContext& run)
    : tree_(input.map.photons(PhotonClass::Caustic)),
      index_(makeIndex(settings.index, tree_, run)),
      settings_(settings),
      maxRadius_(radiusAtMean(input, tree_, settings.maxCountAtMean)) {
    if (settings.progressive.pilot != nullptr) maxRadius_ *= kPilotRadius;
    extent_ = SurfaceExtent(input.creases, maxRadius_);
    const uint64_t paths = input.map.header.emittedPaths();
    perPath_ = paths > 0 ? 1 / static_cast<double>(paths) : 0;
    if (!std::all_of(input.lights.begin(), input.lights.end(), [](bool s) { return s; })) lights_ = input.lights;
}

DensityQuery PhotonGather::densityQuery(const PhotonGatherQuery& query, GatherScratch& scratch) const {
    DensityQuery density;
    density.point = query.point;
    density.sideNormal = query.sideNormal;
    density.medium = query.medium;
    density.minCount = settings_.minCount;
    density.requiredFlags = query.glossyOnly ? kGlossyGather : 0;
    density.minRadius = std::min(settings_.footprintShare * query.point.footprint, maxRadius_);
    density.maxRadius = maxRadius_;
    const ProgressiveRadius& progressive = settings_.progressive;
    if (progressive.pilot != nullptr) {
        const float r1 =
            distanceToKth(*progressive.pilot, query.point.position, progressive.k, maxRadius_, scratch.pilot);
        density.minRadius = density.maxRadius = r1 * progressive.scale;
    }
    return density;
}

const GatheredLight& PhotonGather::gather(const PhotonGatherQuery& query, const Bsdf& bsdf, const Frame& frame, Vec3 wo,
                                          GatherScratch& scratch) const {
    GatheredLight& out = scratch.light;
    out.paths.clear();
    out.photons = 0;
    if (empty() || glm::dot(query.sideNormal, frame.toWorld(wo)) <= 0) return out;
    const DensityQuery density = densityQuery(query, scratch);
    const SurfaceAround& surface = scratch.surface;
    extent_.around(query.point.position, query.point.ng, density.maxRadius, scratch.surface);
    const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
    const auto take = [&](uint32_t i, float kernel) {
        const PhotonPayload& p = tree_.payload[i];
        if (!lights_.empty() && !lights_[p.light]) return;
        if (!surface.whole() && surface.hides(tree_.position(i))) return;
        ++out.photons;
        const Vec3 direction = unpackDirection(p.direction);
        const Vec3 wi = frame.toLocal(direction);
        float shading = std::fabs(wi.z / glm::dot(direction, query.point.ng));
        if (!(shading <= kMaxShadingWeight)) {
            shading = kMaxShadingWeight;
            ++scratch.clamped;
        }
        const Rgb power = unpackPower(p.power) * (kernel * shading);
        Rgb fromDiffuse(0), fromGlossy(0);
        if (diffuse != nullptr) {
            if (wi.z * wo.z > 0) fromDiffuse = power;  // times albedo / pi, below
        } else {
            const BsdfEval f = evalBsdf(bsdf, wo, wi);
            if (!query.glossyOnly) fromDiffuse = power * f.diffuse.f;
            if (query.glossyFromAll || (query.glossyFromFlagged && (p.flags & kGlossyGather) != 0))
                fromGlossy = power * f.glossy.f;
        }
        const PathCode code(p.path);
        auto at =
            std::find_if(out.paths.begin(), out.paths.end(), [&](const GatheredPaths& g) { return g.path == code; });
        if (at == out.paths.end()) at = out.paths.insert(at, {code});
        at->diffuse += fromDiffuse;
        at->glossy += fromGlossy;
    };
    const GatheredDisc disc =
        std::visit([&](const auto& index) { return gatherPhotons(index, density, scratch.density, take); }, index_);
    const auto perPath = static_cast<float>(perPath_) / surface.share(disc.radius);
    const Rgb scale = diffuse != nullptr ? diffuse->albedo * (kInvPi * perPath) : Rgb(perPath);
    for (GatheredPaths& g : out.paths) {
        g.diffuse *= scale;
        g.glossy *= perPath;
    }
    return out;
}

}  // namespace lsde
