// GGX microfacets, isotropic or not, with Smith's masking, single scattering (Walter et al. 2007; Heitz 2014).
#pragma once

#include "base/math.h"

namespace lsde {

// Distribution of normals and the masking that belongs to it. Directions in a frame whose z is the surface's normal, on
// the upper side.
class Ggx {
  public:
    // alpha = roughness^2 (glTF). Lobes narrower than what a unit vector of floats resolves are drawn at that width.
    explicit Ggx(float roughness) : Ggx(square(roughness), square(roughness)) {}
    Ggx(float alphaX, float alphaY) : alphaX_(std::max(alphaX, kMinAlpha)), alphaY_(std::max(alphaY, kMinAlpha)) {}

    float d(Vec3 h) const;   // per area and 1/sr; integrates to 1 over the projected hemisphere
    float g1(Vec3 w) const;  // share of the microfacets that is seen from w, in [0,1]
    // G1(wo) G1(wi) / (4 cos(wo) cos(wi)): masking and shadowing taken as independent (separable), as in the glTF
    // viewers and renderers that pictures are compared with.
    float visibility(Vec3 wo, Vec3 wi) const;

    // Half vector from the normals visible from wo (Heitz 2018).
    Vec3 sampleHalf(Vec3 wo, Vec2 u) const;
    // 1/sr of such an h, where cosO = wo.h > 0: G1(wo) D(h) cosO / cos(wo).
    float visibleNormalPdf(Vec3 wo, Vec3 h, float cosO) const;
    // 1/sr of the reflection of wo about such an h: G1(wo) D(h) / (4 cos(wo)).
    float reflectionPdf(Vec3 wo, Vec3 h) const;

  private:
    static constexpr float kMinAlpha = 1e-7F;  // a float's step below 1 is 6e-8

    // (1 + sqrt(1 + alpha^2 tan^2)) cos: 2 cos / G1, finite at grazing angles.
    float stretch(Vec3 w) const;

    float alphaX_, alphaY_;
};

}  // namespace lsde
