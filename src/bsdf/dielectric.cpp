#include "bsdf/dielectric.h"

#include "bsdf/fresnel.h"

namespace lsde {

int DielectricBsdf::lobes(Vec3 wo, BsdfSample* out) const {
    const float etaT = wo.z > 0 ? eta : 1 / eta;
    const FresnelSplit split = fresnelDielectric(std::fabs(wo.z), etaT);
    out[0] = deltaReflection(wo, Rgb(split.reflectance));
    if (split.cosT == 0) return 1;
    const Vec3 wi(-wo.x / etaT, -wo.y / etaT, -std::copysign(split.cosT, wo.z));
    out[1] = deltaTransmission(wi, (1 - split.reflectance) * tint, etaT);
    return 2;
}

Rgb ThinDielectricBsdf::transmittance(float cosTheta) const {
    return (1 - fresnelDielectric(cosTheta, ior).reflectance) * tint;
}

int ThinDielectricBsdf::lobes(Vec3 wo, BsdfSample* out) const {
    const float cosTheta = std::fabs(wo.z);
    out[0] = deltaReflection(wo, Rgb(fresnelDielectric(cosTheta, ior).reflectance));
    out[1] = deltaTransmission(-wo, transmittance(cosTheta), 1);
    out[1].straight = true;
    return 2;
}

}  // namespace lsde
