// How far to smooth: for each place the radius at which a density estimate's noise has become as small as its bias.
#pragma once

#include <span>
#include <vector>

#include "photon/density.h"
#include "photon/surface_extent.h"

namespace lsde {

// What estimates at photons are made from. All that it refers to outlives its users.
struct PhotonSource {
    const AnyIndex& index;
    const SurfaceExtent& extent;
    std::span<const uint16_t> groups;  // of each photon (path/path_groups.h)
    size_t groupCount = 0;             // photons of higher groups do not take part
    double perPath = 0;                // 1 / emitted paths
    float maxRadius = 0;               // m, of an estimate
    bool dispersed = false;            // some photons have a wavelength: colours are to be kept apart

    const PhotonTreeView& photons() const {
        return std::visit([](const auto& i) -> const PhotonTreeView& { return i.tree(); }, index);
    }
};

struct BandwidthRule {
    uint32_t leastCount = 20;   // photons in the smallest radius tried
    uint32_t mostCount = 1000;  // photons in the largest, roughly
    float tolerance = 1;        // standard errors by which estimates of two radii may differ
};

// The query at a photon's place, on the side on which it landed, with the source's largest radius.
DensityQuery queryAt(const PhotonSource& source, uint32_t photon);

struct BandwidthScratch {
    DensityScratch density;  // accepted: afterwards all that lie within the bandwidth, and some more
    SurfaceAround surface;   // about the photon
    // Records that another thread is just making: that of a place, and one of its neighbours.
    std::vector<Rgb> irradiance, neighbour;
};

struct Bandwidth {
    float radius = 0;    // m
    uint32_t count = 0;  // photons within it
};

// The largest of the radii r0, sqrt(2) r0, 2 r0, ... (r0: distance to photon number leastCount) whose estimate is
// consistent with those of all smaller ones: |E_i - E_j| <= tolerance * standard error of E_i (Lepski 1991), before
// which it ends where the power in the outer ring is plainly another, a few photons there lie far denser, or the power
// within lies to one side. Where
// light is smooth the radius grows as long as it pays, at edges it stays small. The photon itself is left out: it is
// there for certain. Power is the channels' sum; of dispersed light all must hold for each channel, since a rainbow may
// be as bright throughout.
Bandwidth consistentBandwidth(const PhotonSource& source, uint32_t photon, const BandwidthRule& rule,
                              BandwidthScratch& scratch);

}  // namespace lsde
