#include "bsdf/microfacet.h"

#include "sampling/warp.h"

namespace lsde {

float Ggx::d(Vec3 h) const {
    // By sines over alpha: cosines near 1 would lose all digits of a narrow lobe.
    const float e = square(h.x / alphaX_) + square(h.y / alphaY_) + square(h.z);
    return kInvPi / ((alphaX_ * e) * (alphaY_ * e));
}

float Ggx::stretch(Vec3 w) const {
    return w.z + std::sqrt(square(w.z) + square(alphaX_ * w.x) + square(alphaY_ * w.y));
}

float Ggx::g1(Vec3 w) const { return 2 * w.z / stretch(w); }

float Ggx::visibility(Vec3 wo, Vec3 wi) const { return 1 / (stretch(wo) * stretch(wi)); }

Vec3 Ggx::sampleHalf(Vec3 wo, Vec2 u) const { return sampleGgxVisibleNormal(wo, alphaX_, alphaY_, u); }

float Ggx::visibleNormalPdf(Vec3 wo, Vec3 h, float cosO) const { return 2 * d(h) * cosO / stretch(wo); }

float Ggx::reflectionPdf(Vec3 wo, Vec3 h) const { return d(h) / (2 * stretch(wo)); }

}  // namespace lsde
