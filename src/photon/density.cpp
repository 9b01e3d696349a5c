#include "photon/density.h"

#include <immintrin.h>

#include <array>
#include <cmath>

#include "base/ray.h"

namespace lsde {

namespace {

// Cosine of 45 degrees, less the error of a normal stored in 16 bits.
constexpr float kSameSurface = 0.69F;

class PhotonFilter {
  public:
    explicit PhotonFilter(const DensityQuery& query)
        : query_(query),
          slack_(surfaceEpsilon(query.point.position, 0)),
          mask_(static_cast<uint16_t>(query.requiredFlags | kLandedOnFront)) {}

    bool accepts(const PhotonPayload& p) {
        if (p.normal != lastNormal_) lookAt(p.normal);
        return (p.flags & mask_) == wanted_ && p.medium == query_.medium;
    }

    float planeSquared(Vec3 position) const {
        const float fromPlane = std::fabs(glm::dot(position - query_.point.position, query_.point.ng));
        // The rounding of positions makes no photon of this plane enter late.
        return square(std::max(0.0F, fromPlane - slack_) / kPlaneThickness);
    }

  private:
    // Photons of one triangle have the same normal, so the last answer mostly holds.
    void lookAt(uint16_t packed) {
        lastNormal_ = packed;
        const Vec3 normal = unpackNormal(packed);
        const bool front = glm::dot(normal, query_.sideNormal) > 0;
        wanted_ = static_cast<uint16_t>(query_.requiredFlags | (front ? kLandedOnFront : 0));
        if (!(glm::dot(normal, query_.point.ng) > kSameSurface)) wanted_ = kNever;
    }

    static constexpr uint16_t kNever = 0xffff;  // more than the mask lets through

    const DensityQuery& query_;
    float slack_;                // m
    uint16_t mask_;              // flags that matter
    uint16_t wanted_ = kNever;   // and their values, for the last normal
    uint32_t lastNormal_ = ~0U;  // none
};

// Above the last radius by this much, a search next to it rarely falls short (least time on caustics and walls, where
// 1.05 costs 5% more and 1.4 15%).
constexpr float kBeyondLast = 1.15F;
// A search that went through more photons per photon wanted was a bad one: its query wanted other photons or more, or
// the map grows dense here.
constexpr size_t kWasteful = 4;

// Standard errors by which photons in a disc may lie to one side by chance.
constexpr double kBalanceTolerance = 2;

constexpr size_t kLanes = 8;
// Up to about this many, comparing each with each is faster than buckets.
constexpr size_t kFew = 64;

// The k-th smallest (k from 1 to size): the largest of which fewer than k are smaller. The values are followed by
// kLanes - 1 infinite ones.
float kthOfFew(const float* values, size_t size, uint32_t k) {
    __m256 largest = _mm256_set1_ps(-kInfinity);
    for (size_t first = 0; first < size; first += kLanes) {
        const __m256 some = _mm256_loadu_ps(values + first);
        __m256i rank = _mm256_setzero_si256();  // how many are smaller
        for (size_t i = 0; i < size; ++i)
            rank = _mm256_sub_epi32(
                rank, _mm256_castps_si256(_mm256_cmp_ps(_mm256_broadcast_ss(values + i), some, _CMP_LT_OQ)));
        const __m256i low = _mm256_cmpgt_epi32(_mm256_set1_epi32(static_cast<int>(k)), rank);
        largest = _mm256_blendv_ps(largest, _mm256_max_ps(largest, some), _mm256_castsi256_ps(low));
    }
    alignas(32) std::array<float, kLanes> lanes;
    _mm256_store_ps(lanes.data(), largest);
    return *std::max_element(lanes.begin(), lanes.end());
}

}  // namespace

float leastRadius(Vec3 position) { return std::max(1e-12F, surfaceEpsilon(position, 0)); }

float firstRadius(const PhotonTreeView& tree, const DensityQuery& query, const DensityScratch& scratch) {
    const Vec3 moved = query.point.position - scratch.lastPosition;
    if (glm::dot(moved, moved) < square(scratch.lastRadius) && scratch.lastFound <= kWasteful * query.minCount)
        return scratch.lastRadius < kBeyondLast * query.minRadius ? query.minRadius : kBeyondLast * scratch.lastRadius;
    return guessRadius(tree, query.point.position, query.minCount);
}

void acceptPhotons(const PhotonTreeView& tree, const DensityQuery& query, float radius, const NeighbourList& found,
                   ScratchList<DensityScratch::Candidate>& accepted) {
    accepted.clear();
    DensityScratch::Candidate* const begin = accepted.room(found.size());
    DensityScratch::Candidate* end = begin;
    PhotonFilter filter(query);
    for (const Neighbour& n : found) {
        if (!filter.accepts(tree.payload[n.index])) continue;
        *end = {n.index, n.distanceSquared, filter.planeSquared(tree.position(n.index))};
        if (end->entrySquared() < radius * radius) ++end;
    }
    accepted.resizeWithin(static_cast<size_t>(end - begin));
}

void acceptInLeast(const PhotonTreeView& tree, const DensityQuery& query, DensityScratch& scratch) {
    const float radiusSquared = square(query.minRadius);
    acceptPhotons(tree, query, query.minRadius * stretchOf(query.along), scratch.found, scratch.accepted);
    DensityScratch::Candidate* end = scratch.accepted.begin();
    for (const DensityScratch::Candidate& c : scratch.accepted) {
        const Vec3 offset = tree.position(c.index) - query.point.position;
        const float elongated = elongatedSquared(query.along, offset, c.distanceSquared);
        if (std::max(elongated, c.planeSquared) < radiusSquared) *end++ = {c.index, elongated, c.planeSquared};
    }
    scratch.accepted.resizeWithin(static_cast<size_t>(end - scratch.accepted.begin()));
}

float radiusSquaredHolding(uint32_t count, float radius, DensityScratch& scratch) {
    const size_t size = scratch.accepted.size();
    scratch.entries.clear();
    float* const entries = scratch.entries.room(size + kLanes - 1);
    std::transform(scratch.accepted.begin(), scratch.accepted.end(), entries,
                   [](const DensityScratch::Candidate& c) { return c.entrySquared(); });
    if (size > kFew) return kthSmallest({entries, size}, count, radius * radius);
    std::fill_n(entries + size, kLanes - 1, kInfinity);
    return kthOfFew(entries, size, count);
}

float balancedRadiusSquared(const PhotonTreeView& tree, const DensityQuery& query, float radiusSquared,
                            const DensityScratch& scratch) {
    const float least = square(query.minRadius);
    for (; radiusSquared > least; radiusSquared = std::max(least, radiusSquared / 2)) {
        Vec3 moment(0);
        float squares = 0;
        for (const DensityScratch::Candidate& c : scratch.accepted) {
            if (!(c.entrySquared() < radiusSquared)) continue;
            moment += tree.position(c.index) - query.point.position;
            squares += c.distanceSquared;
        }
        if (!liesToOneSide(moment, squares, kBalanceTolerance)) break;
    }
    return radiusSquared;
}

float distanceToKth(const AnyIndex& index, Vec3 position, uint32_t k, float maxRadius, DensityScratch& scratch) {
    std::visit([&](const auto& any) { any.nearest(position, k, maxRadius, scratch.found); }, index);
    return scratch.found.size() < k || k == 0 ? maxRadius : std::sqrt(scratch.found[k - 1].distanceSquared);
}

}  // namespace lsde
