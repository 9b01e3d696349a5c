#include "bsdf/metal_rough.h"

#include "bsdf/fresnel.h"
#include "sampling/warp.h"

namespace lsde {

namespace {

Rgb fresnel(const MetalRoughBsdf& b, Rgb f0, float cosH) {
    const Rgb bare = fresnelSchlick(f0, cosH);
    if (b.film.factor == 0) return bare;
    return bare + b.film.factor * (thinFilmReflectance(b.film, f0, cosH) - bare);
}

// Of the coat alone, without the factor `specular`.
Rgb coatFresnel(const MetalRoughBsdf& b, float cosH) { return fresnel(b, b.dielectricF0, cosH); }

Rgb glossyFresnel(const MetalRoughBsdf& b, float cosH) {
    return b.metallic * fresnel(b, b.baseColor, cosH) + (1 - b.metallic) * b.specular * coatFresnel(b, cosH);
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

bool sampleGlossy(const MetalRoughBsdf& b, const Ggx& ggx, Vec3 wo, Vec2 u, BsdfSample& sample) {
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

// The lobes are the same on both sides: they are evaluated and sampled on the upper one.
Vec3 MetalRoughBsdf::toLobe(Vec3 w) const {
    if (anisotropy == 0) return {w.x, w.y, std::fabs(w.z)};
    return {direction.x * w.x + direction.y * w.y, direction.x * w.y - direction.y * w.x, std::fabs(w.z)};
}

Vec3 MetalRoughBsdf::fromLobe(Vec3 w) const {
    if (anisotropy == 0) return w;
    return {direction.x * w.x - direction.y * w.y, direction.x * w.y + direction.y * w.x, w.z};
}

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

BsdfEval MetalRoughBsdf::eval(Vec3 woSide, Vec3 wiSide, Asked asked) const {
    BsdfEval e;
    if (!(woSide.z * wiSide.z > 0)) return e;
    const Vec3 wo = toLobe(woSide), wi = toLobe(wiSide);
    const Vec3 h = glm::normalize(wo + wi);
    const float cosH = glm::dot(wo, h);
    const bool densities = asked == Asked::All;
    const float p = densities ? glossyProbability(wo) : 0, pReverse = densities ? glossyProbability(wi) : 0;
    if (hasDiffuse()) {
        e.diffuse.f = diffuseReflectance(*this, cosH) * kInvPi;
        if (densities) {
            e.diffuse.pdfW = (1 - p) * cosineHemispherePdf(wi.z);
            e.diffuse.reversePdfW = (1 - pReverse) * cosineHemispherePdf(wo.z);
        }
    }
    if (hasGlossy() && !glossyIsDelta() && asked != Asked::DiffuseF) {
        const Ggx lobe = ggx();
        e.glossy.f = glossyFresnel(*this, cosH) * (lobe.d(h) * lobe.visibility(wo, wi));
        if (densities) {
            e.glossy.pdfW = p * lobe.reflectionPdf(wo, h);
            e.glossy.reversePdfW = pReverse * lobe.reflectionPdf(wi, h);
        }
    }
    return e;
}

BsdfSample MetalRoughBsdf::reflect(Vec3 wo) const { return deltaReflection(wo, glossyFresnel(*this, std::fabs(wo.z))); }

Rgb MetalRoughBsdf::albedo() const { return diffuseReflectance(*this, 1) + glossyFresnel(*this, 1); }

bool MetalRoughBsdf::sampleAbove(Vec3 wo, bool glossy, Vec2 u, BsdfSample& sample) const {
    const Vec3 above = toLobe(wo);
    if (!(glossy ? sampleGlossy(*this, ggx(), above, u, sample) : sampleDiffuse(*this, above, u, sample))) return false;
    sample.wi = fromLobe(sample.wi);
    return true;
}

bool MetalRoughBsdf::sample(Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const {
    const float p = glossyProbability(wo);
    if (uLobe < p && glossyIsDelta()) {
        sample = reflect(wo);
        choose(sample, p, p);
        return true;
    }
    const bool glossy = uLobe < p;
    if (!sampleAbove(wo, glossy, u, sample)) return false;
    const float pReverse = glossyProbability(sample.wi);
    choose(sample, glossy ? p : 1 - p, glossy ? pReverse : 1 - pReverse);
    sample.wi.z = std::copysign(sample.wi.z, wo.z);
    return true;
}

bool MetalRoughBsdf::sampleNonDelta(Vec3 wo, float uLobe, Vec2 u, BsdfSample& out) const {
    if (!glossyIsDelta()) return sample(wo, uLobe, u, out);
    if (!hasDiffuse() || !sampleAbove(wo, false, u, out)) return false;
    out.wi.z = std::copysign(out.wi.z, wo.z);
    return true;
}

}  // namespace lsde
