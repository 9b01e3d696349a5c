// Density estimates: which photons count around a point of a surface, in what radius, and with what weight.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/surface_point.h"
#include "photon/index.h"
#include "photon/kernel.h"

namespace lsde {

struct DensityQuery {
    SurfacePoint point;
    Vec3 sideNormal{0};          // the point's ng, on the side from which the light must have come
    uint16_t medium = 0;         // in which the photons must have landed
    uint16_t requiredFlags = 0;  // PhotonFlag; all of them
    uint32_t minCount = 0;       // photons that the radius grows to hold; not 1, of which no estimate has a mean
    float minRadius = 0, maxRadius = 0;  // m, finite; equal: fixed
    // Whether a grown radius must not reach light that lies to one side, beyond an edge: it shrinks until it does not.
    // For surfaces that go on in all directions.
    bool balanced = false;
    Vec3 along{0};       // the least radius is the half width of an ellipse (photon/bandwidth.h); 0: a disc
    float expected = 0;  // photons within the least radius, roughly; 0: not known
};

// An ellipse is where |offset|^2 - (along.offset)^2 is less than the square of its half width. m2, and the ratio of its
// length to its width.
inline float elongatedSquared(Vec3 along, Vec3 offset, float lengthSquared) {
    return lengthSquared - square(glm::dot(along, offset));
}
inline float stretchOf(Vec3 along) { return 1 / std::sqrt(1 - lengthSquared(along)); }

// Of an estimate at the position, in m: at a focus many photons may lie there together, to rounding.
float leastRadius(Vec3 position);

struct GatheredDisc {
    float radius = 0;       // m, of an ellipse its half width
    uint32_t accepted = 0;  // photons in it that count
    float stretch = 1;      // length over width
};

// Memory that queries use again and again; one for each thread.
struct DensityScratch {
    struct Candidate {
        uint32_t index;
        float distanceSquared;
        float planeSquared;  // of the radius from which on the disc is as thick as the photon is off its plane

        // Of the smallest radius at which it counts.
        float entrySquared() const { return std::max(distanceSquared, planeSquared); }
    };
    NeighbourList found;
    ScratchList<Candidate> accepted;  // in the order found
    ScratchList<float> entries;

    // The last query's disc, for the guess of the next one's: neighbouring pixels query neighbouring points, which need
    // about the same radius. A matter of speed alone: whatever radius a search starts with, the disc found is the same.
    Vec3 lastPosition{0};
    float lastRadius = 0;  // m; 0: none yet
    size_t lastFound = 0;  // photons that its search went through
};

// A radius for the first search that holds, if all is well, query.minCount photons and few more.
float firstRadius(const PhotonTreeView& tree, const DensityQuery& query, const DensityScratch& scratch);

// found -> accepted: the photons that count at the query's point in a disc of the given radius (m).
//
// Left out are those of another medium, without the flags, on a surface turned away by more than 45 degrees (so the
// other side of a sheet too), or lit from the other side; and those beyond the plane's thickness, a share of the
// radius: then photons on a step or a ledge below never count, however small the radius. They enter when the radius
// grows.
void acceptPhotons(const PhotonTreeView& tree, const DensityQuery& query, float radius, const NeighbourList& found,
                   ScratchList<DensityScratch::Candidate>& accepted);

// Square of the smallest radius that holds `count` of the accepted (the last one on its rim), all closer than `radius`.
float radiusSquaredHolding(uint32_t count, float radius, DensityScratch& scratch);

// Whether what lies around a middle lies to one side: `moment` is the sum of weight times offset from it, `squares`
// that of (weight times distance)^2, and `tolerance` the standard errors that chance may reach.
inline bool liesToOneSide(Vec3 moment, double squares, double tolerance) {
    return glm::dot(moment, moment) > square(tolerance) * squares;
}

// Square of the radius, halved until the photons in it do not lie to one side, or it is the least (m).
float balancedRadiusSquared(const PhotonTreeView& tree, const DensityQuery& query, float radiusSquared,
                            const DensityScratch& scratch);

// Of the photons found, those that count in the query's ellipse, or disc, of the least radius; their distances are by
// its norm.
void acceptInLeast(const PhotonTreeView& tree, const DensityQuery& query, DensityScratch& scratch);

// The photons of the query's ellipse, as gatherPhotons has those of a disc; none and false, if they are fewer than it
// wants.
template <PhotonIndex Index, typename Take>
bool gatherEllipse(const Index& index, const DensityQuery& query, DensityScratch& scratch, Take&& take,
                   GatheredDisc& ellipse) {
    ellipse = {query.minRadius, 0, stretchOf(query.along)};
    index.within(query.point.position, query.minRadius * ellipse.stretch, scratch.found);
    acceptInLeast(index.tree(), query, scratch);
    ellipse.accepted = static_cast<uint32_t>(scratch.accepted.size());
    if (ellipse.accepted < query.minCount) return false;
    for (const DensityScratch::Candidate& c : scratch.accepted)
        take(c.index, epanechnikov(c.distanceSquared, square(query.minRadius)) / ellipse.stretch);
    return true;
}

// Every n-th photon of the query's disc or ellipse of the least radius, with n times its weight: for discs of so many
// that each sample of a pixel may do with some of them. Without bias if `every` is drawn evenly.
template <typename Take>
GatheredDisc gatherSome(const PhotonTreeView& tree, const DensityQuery& query, EveryNth every, DensityScratch& scratch,
                        Take&& take) {
    const float stretch = stretchOf(query.along);
    KdIndex(tree).someWithin(query.point.position, query.minRadius * stretch, every, scratch.found);
    acceptInLeast(tree, query, scratch);
    const float scale = static_cast<float>(every.stride) / stretch;
    for (const DensityScratch::Candidate& c : scratch.accepted)
        take(c.index, scale * epanechnikov(c.distanceSquared, square(query.minRadius)));
    return {query.minRadius, static_cast<uint32_t>(scratch.accepted.size()), stretch};
}

// Calls take(index, weight) for each photon that counts in the disc around the query's point: the sum of
// weight * power estimates the power that lands there per area (W/m2, times the paths emitted).
//
// The radius is max(minRadius, min(maxRadius, distance to the photon number minCount)). Its estimate of a uniform
// density has no bias, in the least radius, in a grown one, and in any mixture of them. Let the disc shrink from
// maxRadius until it is the one chosen: whether to stop is known from what it holds and what it has passed, so it is a
// stopping time, and photons per area in a shrinking disc of a Poisson process are a martingale. At the time of
// stopping the photons inside are uniform, and the one on the rim weighs 0 with this kernel: the usual k / (k - 1) does
// not arise. (What `balanced` takes away depends on the photons inside, of which an even density loses one radius in
// fifty: no bias is seen in it.)
//
// An ellipse, if the query has one that holds minCount photons, is taken as it is: it does not grow.
//
// Distances are chords, not their projections to the plane: the area of a sphere within a chord r is pi r^2 exactly.
template <PhotonIndex Index, typename Take>
GatheredDisc gatherPhotons(const Index& index, const DensityQuery& query, DensityScratch& scratch, Take&& take) {
    GatheredDisc ellipse;
    if (query.along != Vec3(0) && gatherEllipse(index, query, scratch, take, ellipse)) return ellipse;
    const float least = query.minRadius, most = std::max(query.minRadius, query.maxRadius);
    float radius = least;
    if (query.minCount > 0 && least < most) radius = std::clamp(firstRadius(index.tree(), query, scratch), least, most);
    for (;;) {
        index.within(query.point.position, radius, scratch.found);
        acceptPhotons(index.tree(), query, radius, scratch.found, scratch.accepted);
        if (scratch.accepted.size() >= query.minCount || !(radius < most)) break;
        radius = std::min(most, grownRadius(radius, query.minCount, scratch.accepted.size()));
    }
    float radiusSquared = radius * radius;
    if (radius > least && scratch.accepted.size() >= query.minCount) {
        radiusSquared = std::max(least * least, radiusSquaredHolding(query.minCount, radius, scratch));
        radius = std::sqrt(radiusSquared);
    }
    scratch.lastPosition = query.point.position;
    scratch.lastRadius = radius;
    scratch.lastFound = scratch.found.size();
    if (query.balanced && radiusSquared > least * least) {
        radiusSquared = balancedRadiusSquared(index.tree(), query, radiusSquared, scratch);
        radius = std::sqrt(radiusSquared);
    }
    GatheredDisc disc{radius, 0};
    for (const DensityScratch::Candidate& c : scratch.accepted) {
        if (!(c.entrySquared() < radiusSquared)) continue;
        ++disc.accepted;
        take(c.index, epanechnikov(c.distanceSquared, radiusSquared));
    }
    return disc;
}

// To the k-th photon of any kind, in m; maxRadius if there are fewer within it.
float distanceToKth(const AnyIndex& index, Vec3 position, uint32_t k, float maxRadius, DensityScratch& scratch);

}  // namespace lsde
