// Where light paths start: a light, a point on it, a direction; aimed at what bends light.
//
// Each light samples a mixture of its whole emission and of parts aimed at spheres, the casters' bounds and larger ones
// around all casters: cones for point, spot and area lights, discs for directional and infinite ones (Jensen 1996,
// projection maps; as a defensive mixture after Hesterberg 1995). Where within a part paths are worth most can be
// learnt from trials. Every path's weight is whole density / mixture density.
#pragma once

#include <vector>

#include "sampling/primary_density.h"
#include "sampling/sampler.h"
#include "transport/direction_map.h"
#include "transport/walk.h"

namespace lsde {

// Shares of a light's paths that are not aimed at casters.
struct AimShares {
    float whole = 1;   // not aimed at all: bounds the weights
    float around = 0;  // at the surroundings of the casters, where these are small in their scene; else not aimed
};
inline constexpr AimShares kNotAimed{1, 0};
inline constexpr AimShares kAimedAtCasters{0.2F, 0};       // only photons are wanted that bent
inline constexpr AimShares kAimedGoingOn{0.125F, 0.125F};  // also those that go on from a diffuse surface to casters
inline constexpr AimShares kAimedSeen{0.8F, 0};            // all that is lit is seen

struct LightPathStart {
    Ray ray;
    MediaStack media;
    Rgb power{0};                             // W of this path: the light's emission over the density of all choices
    WavelengthId reserved = kAllWavelengths;  // see PathState
    size_t light = 0;
    float aimWeight = 1;  // whole / mixture density
    size_t part = 0;      // of the mixture; 0: the whole emission
    PrimaryPoint u{};     // as used: position (where it is chosen), then direction; infinite lights: the other way

    PathState path() const { return {ray, media, power, reserved}; }
};

// A path that was tried, to learn from.
struct AimTrial {
    size_t light = 0, part = 0;
    PrimaryDensity::Trial trial;
};

class EmissionSampler {
  public:
    // selected[i]: light i takes part. Throws Error if none does.
    EmissionSampler(const Scene& scene, const std::vector<bool>& selected, AimShares shares);

    // Aims within each part at what its trials say. They were drawn by this sampler before it had learnt anything, all
    // of them, in any order that is always the same.
    void learn(std::span<const AimTrial> trials);

    // Takes the sampler's first dimensions: position 0-1, direction 2-3 (0-1 where a light has no choice of position),
    // choice of light and part 4, side 5; and the number of the wavelength. False: this start carries no light (below
    // an emitter's horizon, outside a spot's cone).
    bool sample(Sampler& sampler, LightPathStart& start) const;
    // The first of the two dimensions that say where within their part most paths go.
    int aimingDimension() const;

    Rgb totalPower() const { return totalPower_; }  // W, of the lights that take part
    // W: largest component of an unaimed path's power, on average over the lights.
    float fairPower() const { return fairPower_; }
    // Density of a direction (1/sr; directional: of a point on the disc's plane, 1/m2) from `position` on light i by
    // the whole emission and by the mixture; for tests. uPosition: the numbers that chose the position.
    struct Densities {
        float whole = 0, mixture = 0;
    };
    Densities directionDensities(size_t light, Vec3 position, Vec3 normal, Vec3 direction,
                                 Vec2 uPosition = Vec2(0)) const;
    // Of an infinite light in the direction that uDirection chose; a directional light has its own.
    Densities discDensities(size_t light, Vec3 position, Vec3 direction = Vec3(0), Vec2 uDirection = Vec2(0)) const;

  private:
    // Part 0 is the whole emission, part 1 + i is aimed at target i.
    struct Aim {
        DiscreteDistribution parts;
        std::vector<PrimaryDensity> learnt;  // of each part's numbers; empty: even
        bool firstShared = false;            // the first two of them choose what all parts start from: the position on
                                             // an area light, the direction of an infinite one
        MediaStack media;                    // point and spot lights: the solids around them
        bool mayStartInside = false;  // area lights: paths may start within a solid, its media are looked up for each
    };

    void findTargets();
    DiscreteDistribution partsOf(const Light& light) const;
    Aim aimOf(const Light& light, const std::vector<Bounds>& solids) const;
    // What was drawn, and what is known of its density.
    struct Draw {
        size_t part;
        float learnt;  // density of its part's numbers; even: 1
    };
    // Maps even numbers to those of a part.
    static Draw draw(const Aim& aim, size_t part, PrimaryPoint& u);
    // Of a part's numbers, which are found only where they are needed.
    template <typename Numbers>
    static float learntDensity(const Aim& aim, size_t part, Draw drawn, Numbers&& numbers);
    bool sampleArea(const AreaLight& light, const Aim& aim, Sampler& sampler, LightPathStart& start) const;
    bool samplePoint(const PointLight& light, const Aim& aim, Sampler& sampler, LightPathStart& start) const;
    void sampleDirectional(const DirectionalLight& light, const Aim& aim, Sampler& sampler,
                           LightPathStart& start) const;
    void sampleInfinite(const InfiniteLight& light, const Aim& aim, Sampler& sampler, LightPathStart& start) const;
    // On a disc before the whole scene, facing the direction, which is the frame's z; returns the mixture's density
    // there (1/m2).
    float startOnDisc(const Sphere& scene, const Frame& frame, const Aim& aim, Draw drawn, LightPathStart& start) const;
    Densities discDensities(const Sphere& scene, const Frame& frame, Vec3 position, const Aim& aim,
                            const PrimaryPoint& u, Draw drawn) const;
    // Sum over the aimed parts of choice probability times density. The part that drew the direction counts even if
    // rounding put it just beyond the cone's edge: it would weigh as what is hardly ever drawn. `all`: the whole
    // emission, which is what a part inside its target aims at.
    float aimedConePdf(const Aim& aim, Vec3 position, Vec3 direction, const DirectionMap& all, const PrimaryPoint& u,
                       Draw drawn) const;
    float aimedDiscPdf(const Aim& aim, const Frame& frame, Vec3 position, const PrimaryPoint& u, Draw drawn) const;

    const Scene& scene_;
    DiscreteDistribution choice_;
    std::vector<Aim> aims_;
    AimShares shares_;
    std::vector<Sphere> targets_;  // casters, then spheres around all of them, each larger than the one before
    size_t casters_ = 0;           // of the targets
    Rgb totalPower_{0};
    float fairPower_ = 0;
};

}  // namespace lsde
