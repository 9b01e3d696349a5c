// Photon estimates at a vertex: the map's caustic class, its index, and the radius rule.
#pragma once

#include <span>
#include <vector>

#include "photon/density.h"
#include "photon/index.h"
#include "photon/map_file.h"
#include "photon/surface_extent.h"
#include "scene/scene.h"

namespace lsde {

enum class IndexKind : uint8_t { Kd, Flann };

struct PhotonGatherQuery {
    SurfacePoint point;  // footprint 0: as small a radius as holds enough photons
    Vec3 sideNormal{0};  // ng on wo's side
    MediumId medium = kOutside;
    bool glossyOnly = false;         // only photons flagged for Glossy vertices are of use
    bool glossyFromAll = false;      // the glossy lobe takes every photon (it is of class Diffuse)
    bool glossyFromFlagged = false;  // the glossy lobe takes flagged photons
};

// Radiance by the path that the photons took.
struct GatheredPaths {
    PathCode path;
    Rgb diffuse{0}, glossy{0};  // W/(m2 sr)
};
struct GatheredLight {
    std::vector<GatheredPaths> paths;
    uint32_t photons = 0;
};

struct GatherScratch {
    DensityScratch density;
    DensityScratch pilot;
    SurfaceAround surface;
    GatheredLight light;
    uint64_t clamped = 0;  // photons whose |wi.Ns| / |wi.Ng| was bounded
};

// Progressive mode (Knaus & Zwicker 2011): radius = scale * distance to the k-th photon of the pilot map.
struct ProgressiveRadius {
    const AnyIndex* pilot = nullptr;
    uint32_t k = 50;
    float scale = 1;
};

struct GatherSettings {
    IndexKind index = IndexKind::Kd;
    uint32_t minCount = 20;        // photons that the radius grows to hold
    uint32_t maxCountAtMean = 80;  // it grows at most to the radius that holds these at the class's mean density
    float footprintShare = 0.5F;   // radius over short side of the pixel's footprint
    ProgressiveRadius progressive;
};

// What is gathered from, and where surfaces end. All outlive the gather.
struct GatherInput {
    const Scene& scene;
    const PhotonMap& map;
    std::span<const Segment> creases;
    const std::vector<bool>& lights;  // those that take part, by index as in the map's header
};

class PhotonGather {
  public:
    PhotonGather(const GatherInput& input, const GatherSettings& settings, RunContext& run);

    const AnyIndex& index() const { return index_; }
    bool empty() const { return tree_.count == 0; }

    // Light that the photons bring to wo by each lobe. The result stays valid until the scratch's next use.
    const GatheredLight& gather(const PhotonGatherQuery& query, const Bsdf& bsdf, const Frame& frame, Vec3 wo,
                                GatherScratch& scratch) const;

  private:
    DensityQuery densityQuery(const PhotonGatherQuery& query, GatherScratch& scratch) const;

    PhotonTreeView tree_;
    AnyIndex index_;
    std::vector<bool> lights_;  // empty: all
    GatherSettings settings_;
    float maxRadius_ = 0;  // m
    SurfaceExtent extent_;
    double perPath_ = 0;  // 1 / emitted paths
};

}  // namespace lsde
