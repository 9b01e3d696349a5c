// Where light goes on from a diffuse surface: towards what bends light, and anywhere.
#pragma once

#include <array>
#include <vector>

#include "scene/casters.h"
#include "transport/cone.h"
#include "transport/vertex.h"

namespace lsde {

// Light that lit a floor and then finds a glass is as much a caustic as the lamp's own, but few of a floor's directions
// lead there. Beside the paths by the surface's own lobe, towards the cones of the casters' bounding spheres go `boost`
// times as many as the lobe sends there: nearly the same power for each, wherever it comes from (a defensive mixture,
// Hesterberg 1995, whose parts are counted in paths).
class DiffuseAim {
  public:
    // boost >= 0; 0: everything is drawn from the lobe.
    DiffuseAim(const Scene& scene, float boost);

    struct Direction {
        BsdfSample sample;   // weight, pdfs and event as of the lobe alone
        float weight = 1;    // lobe density / that of all paths: 1 where no cone is, about 1 / (1 + boost) in one
        bool aimed = false;  // which part drew it
    };

    // The cones as a point sees them.
    class At {
      public:
        // What part of the lobe the cones take, roughly: sums over overlapping cones.
        float share() const { return share_; }
        // Paths for each path of the lobe alone: 1 + boost * share, at most 33.
        float effort() const { return 1 + boost_ * share_; }
        // uChoice chooses the part. False: no light goes on.
        bool sample(float uChoice, Vec2 u, Direction& out) const;
        // Density of a direction (1/sr, world) by all parts together; for tests.
        float pdf(Vec3 direction) const;

      private:
        friend class DiffuseAim;
        At(const Vertex& v, const DiffuseBsdf& bsdf, float boost) : v_(v), bsdf_(bsdf), boost_(boost) {}
        static constexpr size_t kLobe = kMaxCasters;
        // Sum over the parts of their density, in paths for each path of the lobe. The cone that drew the direction
        // counts even if rounding put it just beyond its edge.
        float pathDensity(float lobePdf, Vec3 direction, size_t drawn) const;

        const Vertex& v_;
        const DiffuseBsdf& bsdf_;
        float boost_, share_ = 0;
        size_t count_ = 0;
        std::array<Cone, kMaxCasters> cones_;
        std::array<float, kMaxCasters> shares_;
    };
    // At a Lambertian surface; refers to both arguments.
    At at(const Vertex& v, const DiffuseBsdf& bsdf) const;

  private:
    float boost_;
    std::vector<Sphere> casters_;
};

}  // namespace lsde
