// Which light is asked for what arrives at a point.
#pragma once

#include <array>
#include <vector>

#include "sampling/distribution.h"
#include "scene/casters.h"
#include "transport/vertex.h"

namespace lsde {

class LightSampler;

// A point that light arrives at, and the normal (unit) of the side that it arrives on.
struct LitPlace {
    Vec3 position{0};
    Vec3 normal{0, 0, 1};
};
inline LitPlace litPlace(const Vertex& v) { return {v.surface.position, v.wo.z < 0 ? -v.surface.ns : v.surface.ns}; }

// The choice of a light at one place; refers to its sampler.
class LightChoice {
  public:
    size_t choose(float& u) const;  // u in [0,1) is rescaled within the choice
    float probability(size_t light) const;

  private:
    friend class LightSampler;
    explicit LightChoice(const LightSampler& lights) : lights_(lights) {}

    static constexpr size_t kMostGroups = 64;
    const LightSampler& lights_;
    std::array<float, kMostGroups> below_;  // sum of the probabilities of the groups up to each
};

// Lights that take part, in at most 64 groups by place. A group is chosen by what it may send to the place, shadows and
// textures left aside (intensity, distance, cosines bounded over its sphere: Conty Estevez & Kulla 2018, without their
// tree), a tenth by its power alone; within a group the choice is by power, with a floor for each: no light is starved.
class LightSampler {
  public:
    // selected[i]: light i takes part. Throws Error if none does.
    LightSampler(const Scene& scene, const std::vector<bool>& selected);

    LightChoice at(const LitPlace& place) const;
    bool selected(size_t light) const { return groupOf_[light] != kNone; }
    // A single point or direction: all samples at a vertex are the same.
    bool onePoint() const { return onePoint_; }
    // For walks that end at a Lambertian vertex: the probability with which to look for emitters in a sampled direction
    // all the same. 1 where they may be near and light sampling alone is noisy; 0 where there are none.
    float bsdfSamples(const LitPlace& place) const;

  private:
    friend class LightChoice;
    static constexpr uint32_t kNone = ~0U;
    struct Group {
        Sphere bounds;
        float intensity = 0;           // W/sr, luminance, of all its lights; directional, infinite: W/m2
        const Light* light = nullptr;  // of a group of one
        Vec3 axis{0};  // mean normal of a flat one-sided emitter; where a single directional light or sun is; else 0
        bool everywhere = false;  // directional or infinite: at no place
        std::vector<size_t> members;
        DiscreteDistribution choice;  // among the members
        float byPower = 0;            // probability that the place does not change
    };
    static float arriving(const Group& group, const LitPlace& place);
    void addGroup(const Scene& scene, std::vector<size_t> members, const std::vector<double>& weights);

    std::vector<Group> groups_;
    std::vector<uint32_t> groupOf_, memberOf_;  // of each light
    std::vector<Caster> emitters_;              // spheres that hold the lights with an area
    bool onePoint_ = false;
    bool surrounded_ = false;  // by a light that shines from all around
};

}  // namespace lsde
