// What is found out about the light at some of the photons, when it is first asked for: how far to smooth there, and
// the irradiance (Christensen 1999) where that is far.
#pragma once

#include <optional>
#include <vector>

#include "base/scratch_array.h"
#include "photon/bandwidth.h"

namespace lsde {

// |wi.Ns| / |wi.Ng| brings stored power to the shading frame (Veach 1997, section 5.3); grazing photons on bent normals
// would carry any weight, so it is bounded.
inline constexpr float kMaxShadingWeight = 10;

struct IrradianceRule {
    BandwidthRule bandwidth;
    uint32_t smoothCount = 0;  // photons in the bandwidth from which on irradiance is kept
};

struct CachedLight {
    // From that of photons near the point: what about it is like theirs and lies within, and its share of their count.
    Bandwidth bandwidth;
    // W/m2 by group, and last their sum, which does not depend on the groups. Empty: not known here, gather.
    std::span<const Rgb> irradiance;
    // (W/m2)^2, of their sum, as the photons' number makes it; and the longest bandwidth that it is a mean over.
    Rgb variance{0};
    Bandwidth over;
    // What the query's shading normal makes of the irradiance: mean of |wi.Ns| / |wi.Ng|.
    float shading = 1;
};

// Records at photons about the middle of runs of the tree's blocks: few where light is smooth, one in each block where
// it is not. They are functions of the map alone: who asks first, and from which thread, changes nothing.
class IrradianceCache {
  public:
    IrradianceCache(const PhotonSource& source, const IrradianceRule& rule);

    // At the query's point, on its side and in its medium. Irradiance if it is wanted, and if the bandwidth is at least
    // the query's least radius: the mean of two records', as far as they tell. One is nearest to the point; the other
    // to the point moved by about the distance of records, by a hash of its position. That one's would be smooth in the
    // mean over many points, but in a pixel's few the first halves the noise. Valid until the scratch's next use.
    CachedLight at(const DensityQuery& query, bool wantIrradiance, BandwidthScratch& scratch);

  private:
    struct Record {
        uint32_t photon = 0;
        uint32_t photonsPerRecord = 0;  // of its level
        Bandwidth bandwidth;
        std::span<const Rgb> irradiance;
        Rgb variance{0};
        Vec3 arriving{0};  // mean, by power, of the direction it came from over its cosine
    };
    // The records for runs of one length, two for each run: a sheet without thickness may be lit from both sides, and
    // then photons of both lie in the same runs.
    struct Level {
        uint32_t photonsPerRecord = 0;
        BandwidthRule rule;
        ScratchArray<uint16_t> offsets;  // of the record's photon in its run, coded (placeOf)
        ScratchArray<float> clearances;  // m, of the record's photon; 0: not known yet
        ScratchArray<uint8_t> states;
        ScratchArray<Bandwidth> bandwidths;
        ScratchArray<Rgb> irradiance;  // of slot i and group g: [i * (groups + 1) + g]
        ScratchArray<Rgb> variances;   // of the sum over groups
        ScratchArray<Vec3> arriving;
    };
    bool answers(Level& level, size_t run, const DensityQuery& query, Record& record, std::vector<Rgb>& spare,
                 BandwidthScratch& scratch);
    // In m, of p from the record's photon, by its bandwidth's norm.
    float distance(const Record& record, Vec3 p) const;
    // Whether the record's irradiance is known, and says something of p.
    bool tells(const Record& record, Vec3 p) const;
    // False: none of the query's surface is near p.
    bool nearest(const DensityQuery& query, Vec3 p, Record& record, BandwidthScratch& scratch);
    struct Place {
        uint32_t photon = 0;
        size_t slot = 0;
    };
    bool sameSurface(const DensityQuery& query, Level& level, const Place& place) const;
    // In m, from the place's photon to the nearest crease.
    float clearanceOf(Level& level, const Place& place) const;
    // Where the run has its record for that side; nowhere, if none of its photons landed there.
    std::optional<Place> placeOf(Level& level, size_t run, Vec3 sideNormal) const;
    // Into `spare` where another thread is just making it.
    void recordOf(Level& level, size_t slot, Record& record, std::vector<Rgb>& spare, BandwidthScratch& scratch);
    // Fills the record of its photon, all but the span: what that refers to is `irradiance`.
    void make(Record& record, const BandwidthRule& rule, std::span<Rgb> irradiance, BandwidthScratch& scratch) const;

    PhotonSource source_;
    PhotonTreeView photons_;
    uint32_t smoothCount_;
    std::vector<Level> levels_;  // the longest runs first, one block last
};

}  // namespace lsde
