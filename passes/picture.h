// The finished picture: the mean of passes, by layer, and what its file says of it.
#pragma once

#include <string>
#include <vector>

#include "image/exr.h"
#include "image/image.h"
#include "passes/layers.h"
#include "passes/picture_error.h"
#include "scene/scene.h"

namespace lsde {

// Weighted mean of pictures that have the film layers of one RenderLayers.
class PictureMean {
  public:
    // layers[i]: the picture of film layer i.
    void add(const std::vector<RgbImage>& layers, double weight);
    // Of the same pictures, which are independent of each other: once for each, or never.
    void addError(const PictureError& error, double weight);
    bool hasError() const { return errorWeight_ > 0; }
    PictureError error() const;  // of the mean
    // Channels by name, as in the file: error.R where it is known, the layer unclassified only where it holds anything.
    ImageFile file(const std::vector<std::string>& names) const;
    const RgbImage& full() const { return sums_[0]; }

  private:
    std::vector<RgbImage> sums_;
    double weight_ = 0;
    PictureError errorSums_;  // of weight^2 times variance
    double errorWeight_ = 0;
};

struct PictureFacts {
    std::string integrator;
    std::string only;  // empty: all paths
    uint64_t seed = 0;
    uint64_t photons = 0;  // light paths emitted
    double samples = 0;    // a pixel, on average
};

ExrMetadata describePicture(const Scene& scene, const Camera& camera, const RenderLayers& layers,
                            const PictureFacts& facts);

}  // namespace lsde
