// Where light goes on from a diffuse surface: towards what bends light, and anywhere.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sampling/primary_density.h"
#include "scene/casters.h"
#include "transport/direction_map.h"
#include "transport/vertex.h"

namespace lsde {

// Light that lit a floor and then finds a glass is as much a caustic as the lamp's own, but few of a floor's directions
// lead there. Beside the paths by the surface's own lobe, towards the cones of the casters' bounding spheres go `boost`
// times as many as the lobe sends there: nearly the same power for each, wherever it comes from (a defensive mixture,
// Hesterberg 1995, whose parts are counted in paths). Where in a cone paths are worth most, and by which way they
// should leave what they meet, can be learnt from trials.
class DiffuseAim {
  public:
    static constexpr size_t kLobe = kMaxCasters;

    // A path that was aimed, to learn from. Its numbers: distance from the cone's middle, turn about it (the surface's
    // normal is at a fourth), and the first number that the next event draws (reflected or refracted).
    struct Trial {
        size_t caster = 0;
        PrimaryDensity::Trial trial;
    };

    // boost >= 0; 0: everything is drawn from the lobe.
    DiffuseAim(const Scene& scene, float boost);

    void setBoost(float boost) { boost_ = boost; }
    void learn(std::span<const Trial> trials);

    struct Direction {
        BsdfSample sample;      // weight, pdfs and event as of the lobe alone
        float weight = 1;       // lobe density / that of all paths, of direction and uEvent: 1 where no cone is
        float uEvent = 0;       // for the next event
        size_t caster = kLobe;  // whose cone drew it
        PrimaryPoint u{};       // in the cone, as used

        bool aimed() const { return caster != kLobe; }
    };

    // The cones as a point sees them.
    class At {
      public:
        // What part of the lobe the cones take, roughly: sums over overlapping cones.
        float share() const { return share_; }
        // Paths for each path of the lobe alone: 1 + boost * share, at most 33.
        float effort() const { return 1 + boost_ * share_; }
        // uChoice chooses the part; uEvent: even. False: no light goes on; `out` has the caster and its numbers alone.
        bool sample(float uChoice, Vec2 u, float uEvent, Direction& out) const;
        // Density of a direction (1/sr, world) and the next event's number by all parts together; for tests.
        float pdf(Vec3 direction, float uEvent) const;

      private:
        friend class DiffuseAim;
        At(const DiffuseAim& aim, const Vertex& v, const DiffuseBsdf& bsdf);

        // A caster in sight.
        struct Target {
            size_t caster = 0;
            Cone cone;
            float share = 0;  // of the lobe
        };
        // What was drawn, and what is known of its density.
        struct Draw {
            size_t caster = kLobe;
            float learnt = 1;  // density of its numbers; even: 1
        };
        DirectionMap directionsOf(const Cone& cone) const;
        float learntDensity(const Target& target, Vec3 direction, float uEvent) const;
        // Sum over the parts of their density, in paths for each path of the lobe. The cone that drew the direction
        // counts even if rounding put it just beyond its edge.
        float pathDensity(float lobePdf, Vec3 direction, float uEvent, Draw drawn) const;

        const DiffuseAim& aim_;
        const Vertex& v_;
        const DiffuseBsdf& bsdf_;
        float boost_ = 0, share_ = 0;
        size_t count_ = 0;
        std::array<Target, kMaxCasters> targets_;
    };
    // At a Lambertian surface; refers to both arguments and to this.
    At at(const Vertex& v, const DiffuseBsdf& bsdf) const { return At(*this, v, bsdf); }

  private:
    float boost_;
    std::vector<Sphere> casters_;
    std::vector<PrimaryDensity> learnt_;  // of each caster; empty: even
};

}  // namespace lsde
