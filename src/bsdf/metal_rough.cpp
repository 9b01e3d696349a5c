#include "bsdf/metal_rough.h"

#include "bsdf/fresnel.h"
#include "bsdf/microfacet.h"
#include "sampling/warp.h"

namespace lsde {

namespace {

// The lobes are the same on both sides: they are evaluated and sampled on the upper one.
Vec3 upper(Vec3 w) { return {w.x, w.y, std::fabs(w.z)}; }

// Of the coat alone, without the factor `specular`.
Rgb coatFresnel(const MetalRoughBsdf& b, float cosH) { return fresnelSchlick(b.dielectricF0, cosH); }

Rgb glossyFresnel(const MetalRoughBsdf& b, float cosH) {
    return b.metallic * fresnelSchlick(b.baseColor, cosH) + (1 - b.metallic) * b.specular * coatFresnel(b, cosH);
}

Rgb diffuseReflectance(const MetalRoughBsdf& b, float cosH) {
    return (1 - b.metallic) * (1 - b.specular * maxComponent(coatFresnel(b, cosH))) * b.baseColor;
}

bool sampleDiffuse(const MetalRoughBsdf& b, Vec3 wo, Vec2 u, BsdfSample& sample) {
    const Vec3 wi = squareToCosineHemisphere(u);
    if (!(wi.z > 0)) return false;
    sample = {};
    sample.wi = wi;
    sample.weight = diffuseReflectance(b, glm::dot(wo, glm::normalize(wo + wi)));
    sample.pdfW = cosineHemispherePdf(wi.z);
    sample.reversePdfW = cosineHemispherePdf(wo.z);
    sample.event = Event::Diffuse;
    return true;
}

bool sampleGlossy(const MetalRoughBsdf& b, Vec3 wo, Vec2 u, BsdfSample& sample) {
    const Ggx ggx(b.roughness);
    const Vec3 h = ggx.sampleHalf(wo, u);
    const float cosH = glm::dot(wo, h);
    const Vec3 wi = 2 * cosH * h - wo;
    if (!(wi.z > 0)) return false;  // single scattering: what would hit the surface again is lost
    sample = {};
    sample.wi = wi;
    sample.weight = glossyFresnel(b, cosH) * ggx.g1(wi);  // f cos / pdf; D and G1(wo) cancel
    sample.pdfW = ggx.reflectionPdf(wo, h);
    sample.reversePdfW = ggx.reflectionPdf(wi, h);
    sample.event = Event::Glossy;
    return true;
}

}  // namespace

// By the reflectances that a smooth surface would have. Neither lobe is left below a tenth: microfacets seen at a
// grazing angle reflect more than that, and the weights of their samples must stay bounded.
float MetalRoughBsdf::glossyProbability(Vec3 wo) const {
    if (!hasGlossy()) return 0;
    if (!hasDiffuse()) return 1;
    constexpr float kLeast = 0.1F;
    const float cosTheta = std::fabs(wo.z);
    const float glossy = maxComponent(glossyFresnel(*this, cosTheta));
    const float both = glossy + maxComponent(diffuseReflectance(*this, cosTheta));
    return std::clamp(both > 0 ? glossy / both : 0.5F, kLeast, 1 - kLeast);
}

BsdfEval MetalRoughBsdf::eval(Vec3 woSide, Vec3 wiSide) const {
    BsdfEval e;
    if (!(woSide.z * wiSide.z > 0)) return e;
    const Vec3 wo = upper(woSide), wi = upper(wiSide);
    const Vec3 h = glm::normalize(wo + wi);
    const float cosH = glm::dot(wo, h);
    const float p = glossyProbability(wo), pReverse = glossyProbability(wi);
    if (hasDiffuse())
        e.diffuse = {diffuseReflectance(*this, cosH) * kInvPi, (1 - p) * cosineHemispherePdf(wi.z),
                     (1 - pReverse) * cosineHemispherePdf(wo.z)};
    if (hasGlossy() && !glossyIsDelta()) {
        const Ggx ggx(roughness);
        e.glossy = {glossyFresnel(*this, cosH) * (ggx.d(h) * ggx.visibility(wo, wi)), p * ggx.reflectionPdf(wo, h),
                    pReverse * ggx.reflectionPdf(wi, h)};
    }
    return e;
}

BsdfSample MetalRoughBsdf::reflect(Vec3 wo) const { return deltaReflection(wo, glossyFresnel(*this, std::fabs(wo.z))); }

Rgb MetalRoughBsdf::albedo() const { return diffuseReflectance(*this, 1) + glossyFresnel(*this, 1); }

bool MetalRoughBsdf::sample(Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const {
    const float p = glossyProbability(wo);
    if (uLobe < p && glossyIsDelta()) {
        sample = reflect(wo);
        choose(sample, p, p);
        return true;
    }
    const bool glossy = uLobe < p;
    if (!(glossy ? sampleGlossy(*this, upper(wo), u, sample) : sampleDiffuse(*this, upper(wo), u, sample)))
        return false;
    const float pReverse = glossyProbability(sample.wi);
    choose(sample, glossy ? p : 1 - p, glossy ? pReverse : 1 - pReverse);
    sample.wi.z = std::copysign(sample.wi.z, wo.z);
    return true;
}

bool MetalRoughBsdf::sampleNonDelta(Vec3 wo, float uLobe, Vec2 u, BsdfSample& out) const {
    if (!glossyIsDelta()) return sample(wo, uLobe, u, out);
    if (!hasDiffuse() || !sampleDiffuse(*this, upper(wo), u, out)) return false;
    out.wi.z = std::copysign(out.wi.z, wo.z);
    return true;
}

}  // namespace lsde
