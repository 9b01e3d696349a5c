// Which solids a path is inside of (Schmidt & Budge 2002, "Simple Nested Dielectrics in Ray Traced Images").
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "base/math.h"

namespace lsde {

using MediumId = uint16_t;
inline constexpr MediumId kOutside = 0;  // no solid: air, ior 1, no absorption

struct Medium {
    float ior = 1;         // at 587.6 nm, helium's d line, if it disperses
    Rgb absorption{0};     // 1/m (Beer-Lambert): -ln(attenuationColor) / attenuationDistance
    int priority = 0;      // larger wins where solids overlap; ties: the one entered first
    float dispersion = 0;  // 20 / Abbe number V_d (KHR_materials_dispersion); 0: none
};

// The solids around a point, in the order in which they were entered.
class MediaStack {
  public:
    static constexpr int kMaxDepth = 8;

    bool contains(MediumId m) const;
    // Beyond kMaxDepth the solid is not counted (returns false): a scene that nests deeper is refused on loading.
    bool enter(MediumId m);
    void leave(MediumId m);  // nothing if it is not there
    // The medium present: of the solids entered, the one with the highest priority, the first entered among equals.
    MediumId dominant(std::span<const Medium> media) const;
    int size() const { return size_; }

    friend bool operator==(const MediaStack&, const MediaStack&) = default;

  private:
    std::array<MediumId, kMaxDepth> entries_{};
    uint8_t size_ = 0;
};

// Crossing the surface of solid m, by the facing of the surface: what lies before and behind it, whatever the stack
// said (an open mesh is entered and left by facing alone).
struct Crossing {
    MediaStack before, after;
};
void cross(Crossing& crossing, MediumId m, bool entering);

}  // namespace lsde
