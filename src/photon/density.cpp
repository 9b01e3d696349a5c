#include "photon/density.h"

#include <cmath>

#include "base/ray.h"

namespace lsde {

namespace {

// Cosine of 45 degrees, less the error of a normal stored in 16 bits.
constexpr float kSameSurface = 0.69F;

class PhotonFilter {
  public:
    explicit PhotonFilter(const DensityQuery& query) : query_(query), slack_(surfaceEpsilon(query.point.position, 0)) {}

    bool accepts(const PhotonPayload& p) {
        return p.medium == query_.medium && (p.flags & query_.requiredFlags) == query_.requiredFlags &&
               facesSameWay(p.normal) &&
               glm::dot(Octahedral<16>::unpackUnnormalised(p.direction), query_.sideNormal) > 0;
    }

    float entrySquared(Vec3 position, float distanceSquared) const {
        const float fromPlane = std::fabs(glm::dot(position - query_.point.position, query_.point.ng));
        // The rounding of positions makes no photon of this plane enter late.
        return std::max(distanceSquared, square(std::max(0.0F, fromPlane - slack_) / kPlaneThickness));
    }

  private:
    // Photons of one triangle have the same normal, so the last answer mostly holds.
    bool facesSameWay(uint16_t normal) {
        if (normal != lastNormal_) {
            lastNormal_ = normal;
            lastFacesSameWay_ = glm::dot(unpackNormal(normal), query_.point.ng) > kSameSurface;
        }
        return lastFacesSameWay_;
    }

    const DensityQuery& query_;
    float slack_;                // m
    uint32_t lastNormal_ = ~0U;  // none
    bool lastFacesSameWay_ = false;
};

}  // namespace

void acceptPhotons(const PhotonTreeView& tree, const DensityQuery& query, float radius, DensityScratch& scratch) {
    scratch.accepted.clear();
    DensityScratch::Candidate* const begin = scratch.accepted.room(scratch.found.size());
    DensityScratch::Candidate* end = begin;
    PhotonFilter filter(query);
    for (const Neighbour& n : scratch.found) {
        if (!filter.accepts(tree.payload[n.index])) continue;
        *end = {n.index, n.distanceSquared, filter.entrySquared(tree.position(n.index), n.distanceSquared)};
        if (end->entrySquared < radius * radius) ++end;
    }
    scratch.accepted.resizeWithin(static_cast<size_t>(end - begin));
}

float radiusSquaredHolding(uint32_t count, float radius, DensityScratch& scratch) {
    scratch.entries.clear();
    float* const entries = scratch.entries.room(scratch.accepted.size());
    std::transform(scratch.accepted.begin(), scratch.accepted.end(), entries,
                   [](const DensityScratch::Candidate& c) { return c.entrySquared; });
    return kthSmallest({entries, scratch.accepted.size()}, count, radius * radius);
}

float distanceToKth(const AnyIndex& index, Vec3 position, uint32_t k, float maxRadius, DensityScratch& scratch) {
    std::visit([&](const auto& any) { any.nearest(position, k, maxRadius, scratch.found); }, index);
    return scratch.found.size() < k || k == 0 ? maxRadius : std::sqrt(scratch.found[k - 1].distanceSquared);
}

}  // namespace lsde
