// Radiance from all directions, as an equirectangular picture.
#pragma once

#include "image/image.h"
#include "sampling/distribution.h"

namespace lsde {

// Y is up. The picture's top row looks along +Y, its centre along +Z; from there its right half turns towards -X, as
// for a viewer who stands inside and looks along +Z.
class EnvironmentMap {
  public:
    // image: radiance, finite and >= 0, in W/(m2 sr). turn: rad about +Y; a quarter moves the centre from +Z to +X.
    // Throws Error if all of it is black.
    EnvironmentMap(RgbImage image, float turn);

    Rgb radiance(Vec3 direction) const;         // bilinear; direction: unit, from the scene to the map
    Rgb integral() const { return integral_; }  // of the radiance over all directions, W/m2: exact
    // One constant density per texel and solid angle: by the mean luminance of the bilinear radiance over the texel.
    Vec3 sample(Vec2 u, float& pdfW) const;
    float pdfW(Vec3 direction) const;  // 1/sr

  private:
    Vec2 toPicture(Vec3 direction) const;
    Rgb texel(int x, int y) const;
    float densityPerArea(size_t row) const;  // turns a density over the unit square into one per solid angle

    RgbImage image_;
    float turn_;
    Rgb integral_{0};
    Distribution2D texels_;
    std::vector<double> cosines_;  // of the angle from +Y at the rows' borders
};

}  // namespace lsde
