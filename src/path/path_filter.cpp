#include "path/path_filter.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace lsde {

PathFilter::PathFilter(std::vector<PathLayer> layers) : layers_(std::move(layers)) {
    if (layers_.size() > kMaxPathLayers)
        throw Error(std::to_string(layers_.size()) + " path layers, expected at most " +
                    std::to_string(kMaxPathLayers));
    for (auto layer = layers_.begin(); layer != layers_.end(); ++layer)
        if (std::any_of(layers_.begin(), layer, [&](const PathLayer& earlier) { return earlier.name == layer->name; }))
            throw Error("path layer \"" + layer->name + "\": named twice, expected one layer of a name");
}

EyePathState PathFilter::eye() const {
    EyePathState s;
    for (size_t i = 0; i < layers_.size(); ++i) s.mask[i] = layers_[i].expression.accepting();
    return s;
}

LightPathState PathFilter::stateOf(PathCode code) const {
    LSDE_ASSERT(!code.overflowed());
    LightPathState s = light();
    for (int i = 0; i < code.size(); ++i) append(s, code.at(i));
    return s;
}

}  // namespace lsde
