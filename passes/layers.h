// The layers of a picture: the full one, one for each path expression, and what the first surface looks like.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "image/film.h"
#include "path/path_filter.h"

namespace lsde {

// Name of the layer that holds the paths of --only: it decides what counts and is not shown itself.
inline constexpr const char* kOnlyLayer = "(only)";

struct LayerRequest {
    std::string name;  // [A-Za-z0-9_-]+
    std::string expression;
};
// "EXPR=NAME" (split at the last '='), or "EXPR", which gets the name pathI. Throws UsageError.
LayerRequest parseLayerRequest(const std::string& text, int number);

// Film layers: 0 the full picture, 1 + i expression i, then albedo, normal, depth and unclassified.
class RenderLayers {
  public:
    static constexpr int kMaxFilmLayers = kMaxPathLayers + 5;

    // The built-in layers caustic, direct and indirect unless a request takes their name, then the requests. With
    // `only`, no other path counts in any layer.
    RenderLayers(const std::vector<LayerRequest>& requests, const std::optional<std::string>& only);

    const PathFilter& filter() const { return filter_; }
    std::vector<std::string> filmLayers() const;  // names; the last expression may be `only`, which is not shown
    int paths() const { return filter_.size(); }
    int albedo() const { return 1 + paths(); }
    int normal() const { return 2 + paths(); }
    int depth() const { return 3 + paths(); }
    int unclassified() const { return 4 + paths(); }

    bool hasOnly() const { return only_ >= 0; }
    const PathExpr& only() const { return filter_.layers()[static_cast<size_t>(only_)].expression; }
    bool counts(uint32_t accepted) const { return only_ < 0 || ((accepted >> only_) & 1) != 0; }
    // Whether a picture of these paths can use photons of the class at all.
    bool wantsCaustic() const { return wants(causticStates_); }
    bool wantsIndirect() const { return wants(indirectStates_); }
    // Whether such photons arriving at a lobe with this eye side can count.
    bool causticCounts(const EyePathState& eye) const { return counts(causticStates_, eye); }
    bool indirectCounts(const EyePathState& eye) const { return counts(indirectStates_, eye); }
    bool alive(const EyePathState& eye) const { return counts(filter_.alive(eye)); }

  private:
    bool wants(uint64_t photonStates) const;
    bool counts(uint64_t photonStates, const EyePathState& eye) const {
        return only_ < 0 || (eye.mask[static_cast<size_t>(only_)] & photonStates) != 0;
    }

    PathFilter filter_;
    int only_ = -1;
    uint64_t causticStates_ = 0;   // states of `only` after one or more S or G
    uint64_t indirectStates_ = 0;  // after events of which one is D or G
};

// One sample's light by film layer.
struct SampleSums {
    std::array<Rgb, RenderLayers::kMaxFilmLayers> layer{};
    float photonVariance = 0;  // of the full picture's, by the photons gathered; mean over the channels
    uint64_t notFinite = 0;

    void contribute(const RenderLayers& layers, Rgb value, const LightPathState& light, const EyePathState& eye);
    // The same without the full picture, unless `only` decides what that is.
    void contributeToLayers(const RenderLayers& layers, Rgb value, const LightPathState& light,
                            const EyePathState& eye);
    void addFull(Rgb value);
    void addTo(Film& film, int x, int y);  // and clears
};

}  // namespace lsde
