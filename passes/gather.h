// Photon estimates at a vertex: the map's classes, their indices and radius rules.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "path/path_groups.h"
#include "photon/irradiance_cache.h"
#include "photon/map_file.h"
#include "scene/scene.h"

namespace lsde {

enum class IndexKind : uint8_t { Kd, Flann };

struct PhotonGatherQuery {
    SurfacePoint point;              // footprint 0: as small a radius as holds enough photons
    Vec3 sideNormal{0};              // ng on the side from which the light came: wo's, or the other if it went through
    MediumId medium = kOutside;      // on that side
    bool glossyOnly = false;         // only photons flagged for Glossy vertices are of use
    bool glossyFromAll = false;      // the glossy lobe takes every photon (it is of class Diffuse)
    bool glossyFromFlagged = false;  // the glossy lobe takes flagged photons
    WavelengthId wavelength = kAllWavelengths;  // of the path from the eye
    float u = 0;  // in [0,1), even over samples: which photons, where some of them will do
};

// Whether the surface scatters all light that arrives on one side alike, so that no photon's direction matters: a
// Lambertian one whose normals agree. Elsewhere some of a wide disc's photons will do, chosen by PhotonGatherQuery::u.
bool scattersAlike(const Bsdf& bsdf, const SurfacePoint& point);

// Radiance by the group of paths that the photons took, in the picture's channels: wavelengths have been weighed.
struct GatheredPaths {
    uint16_t group = 0;
    Rgb diffuse{0}, glossy{0};  // W/(m2 sr)
};
struct GatheredLight {
    std::vector<GatheredPaths> paths;
    Rgb total{0};     // of all
    Rgb variance{0};  // of the total's mean over the pixel, as the number of photons makes it
    uint32_t photons = 0;
};

struct GatherScratch {
    DensityScratch density;
    DensityScratch pilot;
    SurfaceAround surface;
    BandwidthScratch bandwidth;
    GatheredLight light;
    uint64_t clamped = 0;  // photons whose |wi.Ns| / |wi.Ng| was bounded
};

// Progressive mode (Knaus & Zwicker 2011): radius = scale * distance to the k-th photon of the pilot map.
struct ProgressiveRadius {
    const AnyIndex* pilot = nullptr;
    uint32_t k = 50;
    float scale = 1;  // also of the width over which wavelengths count as one
};

// Of one class.
struct RadiusRule {
    double photons = 0;  // in the class, for which the largest bandwidth is as it says; see scaledTo()
    IrradianceRule irradiance;
    float reachAtMean = 0;     // photons of the class's mean density that the largest bandwidth holds
    uint32_t minCount = 0;     // photons that the radius grows to hold where the bandwidth is less
    float growthAtMean = 0;    // it grows at most to the radius that holds these at the class's mean density
    float footprintShare = 0;  // least radius over short side of the pixel's footprint
};

// The rule for a class of so many photons. The more there are, the more of them the largest bandwidths hold: by
// N^(2/3), so that in two dimensions variance and squared bias fall alike (Silverman 1986, section 4.3). Were the count
// fixed, variance would not fall, and the few photons of a small map would be smoothed over all of a caustic. But not
// below a seventh, where noise would hide what is there.
RadiusRule scaledTo(uint64_t photons, RadiusRule rule);

struct GatherSettings {
    IndexKind index = IndexKind::Kd;
    RadiusRule caustic{3.5e5, {{20, 2000, 2.5F}, 300}, 1600, 20, 80, 0.5F};
    RadiusRule indirect{1e6, {{50, 8000, 3, 1}, 25}, 8000, 50, 400, 0};
    bool indirectFromMap = true;  // where the map holds that class
    // Width of the kernel by which a dispersed path from the eye takes dispersed photons of other wavelengths.
    float wavelengthShare = 0.1F;
    ProgressiveRadius progressive;
};

// What is gathered from, and where surfaces end. All outlive the gather.
struct GatherInput {
    const Scene& scene;
    const PhotonMap& map;
    std::span<const Segment> creases;
    const std::vector<bool>& lights;  // those that take part, by index as in the map's header
    const PathFilter& filter;
};

// Photons of one class.
class ClassGather {
  public:
    ClassGather(const GatherInput& input, PhotonClass c, const GatherSettings& settings, const RadiusRule& rule,
                const ProgressiveRadius& progressive, RunContext& run);
    ClassGather(const ClassGather&) = delete;  // the cache refers to the extent
    ClassGather& operator=(const ClassGather&) = delete;

    const AnyIndex& index() const { return index_; }
    const PathGroups& groups() const { return groups_; }
    bool empty() const { return tree_.count == 0; }
    // Light that the photons bring to wo by each lobe. The result stays valid until the scratch's next use.
    const GatheredLight& gather(const PhotonGatherQuery& query, const Bsdf& bsdf, const Frame& frame, Vec3 wo,
                                GatherScratch& scratch) const;

  private:
    // What a pixel's samples, spread over its footprint, have of the variance that independent paths would give one of
    // them, with a kernel of an area (m2) and so many photons: about its share in both together, and as much as the
    // sequence of paths leaves where so many photons lie.
    float sharedVariance(const PhotonGatherQuery& query, Vec3 wo, float area, float photons) const;
    DensityQuery densityQuery(const PhotonGatherQuery& query, GatherScratch& scratch) const;
    bool known(const PhotonGatherQuery& query, DensityQuery& density, const Bsdf& bsdf, Vec3 wo,
               GatherScratch& scratch) const;

    PhotonTreeView tree_;
    AnyIndex index_;
    RadiusRule rule_;
    ProgressiveRadius progressive_;
    float wavelengthShare_;
    Dispersion dispersion_;
    PathGroups groups_;
    float maxRadius_ = 0;  // m, of a growing radius
    float reach_ = 0;      // m, of the largest bandwidth
    SurfaceExtent extent_;
    double perPath_ = 0;                      // 1 / emitted paths
    BlockTable blocks_;                       // for the cache
    std::unique_ptr<IrradianceCache> cache_;  // filled while it is used
};

class PhotonGather {
  public:
    PhotonGather(const GatherInput& input, const GatherSettings& settings, RunContext& run);

    const ClassGather& caustic() const { return caustic_; }
    // Light that met a Diffuse vertex before. Null: the map does not hold the class, or it is not asked for.
    const ClassGather* indirect() const { return indirect_ ? &*indirect_ : nullptr; }

  private:
    void makeIndirect(const GatherInput& input, const GatherSettings& settings, RunContext& run);

    ClassGather caustic_;
    std::optional<ClassGather> indirect_;
};

}  // namespace lsde
