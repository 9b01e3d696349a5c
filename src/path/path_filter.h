// A set of path expressions evaluated together: one light-side state and one eye-side mask for each.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "path/path_code.h"
#include "path/path_expr.h"

namespace lsde {

inline constexpr int kMaxPathLayers = 16;

struct PathLayer {
    std::string name;  // of the EXR layer
    PathExpr expression;
};

// State of the light side and of the eye side for every layer of a PathFilter.
struct LightPathState {
    std::array<uint8_t, kMaxPathLayers> state{};
};
struct EyePathState {
    std::array<uint64_t, kMaxPathLayers> mask{};
};

class PathFilter {
  public:
    PathFilter() = default;
    // Throws Error beyond kMaxPathLayers layers, or if two layers have one name.
    explicit PathFilter(std::vector<PathLayer> layers);

    const std::vector<PathLayer>& layers() const { return layers_; }
    int size() const { return static_cast<int>(layers_.size()); }

    static LightPathState light() { return {}; }  // after L
    EyePathState eye() const;                     // before E
    void append(LightPathState& s, Event e) const {
        for (size_t i = 0; i < layers_.size(); ++i) s.state[i] = layers_[i].expression.next(s.state[i], e);
    }
    void prepend(EyePathState& s, Event e) const {
        for (size_t i = 0; i < layers_.size(); ++i) s.mask[i] = layers_[i].expression.before(s.mask[i], e);
    }
    // Bit i: layer i takes the path whose light side and eye side join here (both sides' events already counted).
    uint32_t accepted(const LightPathState& light, const EyePathState& eye) const {
        return bits([&](size_t i) { return PathExpr::accepts(light.state[i], eye.mask[i]); });
    }
    // Bit i: layer i could still take a continuation of this path.
    uint32_t alive(const LightPathState& light) const {
        return bits([&](size_t i) { return layers_[i].expression.alive(light.state[i]); });
    }
    uint32_t alive(const EyePathState& eye) const {
        return bits([&](size_t i) { return PathExpr::aliveMask(eye.mask[i]); });
    }
    // The state after all events of a stored path. An overflowed code has no state: ask overflowed() first.
    LightPathState stateOf(PathCode code) const;

  private:
    template <typename Takes>
    uint32_t bits(Takes takes) const {
        uint32_t out = 0;
        for (size_t i = 0; i < layers_.size(); ++i) out |= static_cast<uint32_t>(takes(i)) << i;
        return out;
    }

    std::vector<PathLayer> layers_;
};

}  // namespace lsde
