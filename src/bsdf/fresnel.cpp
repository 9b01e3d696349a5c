#include "bsdf/fresnel.h"

namespace lsde {

FresnelSplit fresnelDielectric(float cosI, float eta) {
    // Snell: eta^2 cosT^2 = eta^2 - (1 - cosI^2), so written that it stays exact for eta near 1 and at grazing angles.
    const float scaled2 = (eta - 1) * (eta + 1) + square(cosI);
    if (!(scaled2 > 0)) return {};
    const float scaledCosT = std::sqrt(scaled2);  // eta cosT
    const float cosT = scaledCosT / eta;
    const float perpendicular = (cosI - scaledCosT) / (cosI + scaledCosT);
    const float parallel = (eta * cosI - cosT) / (eta * cosI + cosT);
    return {0.5F * (square(perpendicular) + square(parallel)), cosT};
}

}  // namespace lsde
