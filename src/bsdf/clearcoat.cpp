#include "bsdf/clearcoat.h"

#include "bsdf/fresnel.h"

namespace lsde {

namespace {

constexpr float kF0 = 0.04F;  // of ior 1.5

}  // namespace

float Clearcoat::reflectance(float cosTheta) const { return factor * fresnelSchlick(Rgb(kF0), std::fabs(cosTheta)).x; }

float Clearcoat::transmittance(Vec3 wo, Vec3 wi) const {
    return 1 - std::max(reflectance(glm::dot(normal, wo)), reflectance(glm::dot(normal, wi)));
}

LobeEval Clearcoat::eval(Vec3 wo, Vec3 wi) const {
    const Frame frame(normal);
    const Vec3 o = frame.toLocal(wo), i = frame.toLocal(wi);
    if (!(o.z > 0 && i.z > 0)) return {};
    const Ggx ggx(roughness);
    const Vec3 h = glm::normalize(o + i);
    return {Rgb(reflectance(glm::dot(o, h)) * (ggx.d(h) * ggx.visibility(o, i))), ggx.reflectionPdf(o, h),
            ggx.reflectionPdf(i, h)};
}

bool Clearcoat::sample(Vec3 wo, Vec2 u, Vec3& wi) const {
    const Frame frame(normal);
    const Vec3 o = frame.toLocal(wo);
    if (!(o.z > 0)) return false;
    const Vec3 h = Ggx(roughness).sampleHalf(o, u);
    const Vec3 i = 2 * glm::dot(o, h) * h - o;
    wi = frame.toWorld(i);
    return i.z > 0 && wi.z > 0;
}

BsdfSample Clearcoat::reflect(Vec3 wo) const {
    const float cosO = glm::dot(normal, wo);
    BsdfSample s = deltaReflection(wo, Rgb(reflectance(cosO)));
    s.wi = 2 * cosO * normal - wo;
    if (!(cosO > 0 && s.wi.z > 0)) s.weight = Rgb(0);
    return s;
}

}  // namespace lsde
