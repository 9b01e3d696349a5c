#include "bsdf/transmissive.h"

#include <array>

#include "sampling/warp.h"

namespace lsde {

namespace {

// Both directions turned over together, so that wo is above: a side is told by the refractive index alone.
Vec3 upright(Vec3 w, float woZ) { return {w.x, w.y, std::copysign(1.0F, woZ) * w.z}; }

Vec3 mirrored(Vec3 w) { return {w.x, w.y, -w.z}; }

}  // namespace

TransmissiveBsdf::Split TransmissiveBsdf::split(float cosI, float etaT) const {
    const FresnelSplit exact = fresnelDielectric(cosI, etaT);
    Rgb reflectance(exact.reflectance);
    if (specular != 1 || specularColor != Rgb(1)) {
        const float f0 = square((etaT - 1) / (etaT + 1));
        const float rise = f0 < 1 ? (exact.reflectance - f0) / (1 - f0) : 1;
        const Rgb f = glm::min(f0 * specularColor, Rgb(1));
        reflectance = specular * (f + (Rgb(1) - f) * rise);
    }
    const Rgb base = (1 - metallic) * (1 - maxComponent(reflectance)) * baseColor;
    Split s;
    s.cosT = exact.cosT;
    s.reflected = (1 - metallic) * reflectance;
    if (metallic > 0) s.reflected += metallic * fresnelSchlick(baseColor, cosI);
    s.diffuse = (1 - transmission) * base;
    if (exact.cosT > 0) s.transmitted = transmission * base;
    const float r = maxComponent(s.reflected), both = r + maxComponent(s.transmitted);
    if (both > 0) s.pReflection = r / both;
    return s;
}

// With which reflection is chosen by what comes the way of refracted light back, at cosT from the far side.
float TransmissiveBsdf::pReflectionBack(const Split& s, float cosT, float etaT) const {
    // A dielectric reflects as much from there, by Fresnel's equations; Schlick's metal does not.
    return metallic > 0 ? split(cosT, 1 / etaT).pReflection : s.pReflection;
}

// By the reflectances that a smooth surface would have, as in metal_rough.cpp, and for the same reason within bounds.
float TransmissiveBsdf::interfaceProbability(Vec3 wo) const {
    if (!hasDiffuse()) return 1;
    constexpr float kLeast = 0.1F;
    const Split s = split(std::fabs(wo.z), etaFrom(wo.z));
    const float through = maxComponent(s.reflected) + maxComponent(s.transmitted);
    const float all = through + maxComponent(s.diffuse);
    return std::clamp(all > 0 ? through / all : 0.5F, kLeast, 1 - kLeast);
}

Rgb TransmissiveBsdf::diffuseReflectance(Vec3 wo, Vec3 wi, float etaT) const {
    const bool within = !thin && etaT < 1;
    return split(within ? std::min(wo.z, wi.z) : glm::dot(wo, glm::normalize(wo + wi)), etaT).diffuse;
}

LobeEval TransmissiveBsdf::evalReflection(const Ggx& ggx, Vec3 wo, Vec3 wi, const Split& s, Vec3 h) const {
    return {s.reflected * (ggx.d(h) * ggx.visibility(wo, wi)), s.pReflection * ggx.reflectionPdf(wo, h),
            s.pReflection * ggx.reflectionPdf(wi, h)};
}

// wo above, wi below.
LobeEval TransmissiveBsdf::evalThrough(const Ggx& ggx, Vec3 wo, Vec3 wi, float etaT) const {
    const Vec3 far = mirrored(wi);
    if (thin) {
        const Vec3 h = glm::normalize(wo + far);
        const Split s = split(glm::dot(wo, h), etaT);
        return {s.transmitted * (ggx.d(h) * ggx.visibility(wo, far)), (1 - s.pReflection) * ggx.reflectionPdf(wo, h),
                (1 - s.pReflection) * ggx.reflectionPdf(far, h)};
    }
    Vec3 h = glm::normalize(wo + etaT * wi);
    if (h.z < 0) h = -h;
    const float cosO = glm::dot(wo, h), cosI = -glm::dot(wi, h);
    if (!(cosO > 0 && cosI > 0)) return {};
    const Split s = split(cosO, etaT);
    // Solid angle of half vectors for that of wi is etaT^2 cosI / scale, for that of wo cosO / scale (eq. 17).
    const float scale = square(cosO - etaT * cosI);
    if (!(scale > 0)) return {};
    const float d = ggx.d(h), toWi = square(etaT) * cosI / scale, toWo = cosO / scale;
    return {s.transmitted * (4 * d * ggx.visibility(wo, far) * cosO * toWi),
            (1 - s.pReflection) * ggx.visibleNormalPdf(wo, h, cosO) * toWi,
            (1 - pReflectionBack(s, cosI, etaT)) * ggx.visibleNormalPdf(far, h, cosI) * toWo};
}

BsdfEval TransmissiveBsdf::eval(Vec3 woSide, Vec3 wiSide) const {
    BsdfEval e;
    if (woSide.z == 0 || wiSide.z == 0) return e;
    const float etaT = etaFrom(woSide.z);
    const Vec3 wo = upright(woSide, woSide.z), wi = upright(wiSide, woSide.z);
    const float p = interfaceProbability(woSide), pReverse = interfaceProbability(wiSide);
    if (wi.z > 0) {
        const Vec3 h = glm::normalize(wo + wi);
        const Split s = split(glm::dot(wo, h), etaT);
        if (hasDiffuse())
            e.diffuse = {diffuseReflectance(wo, wi, etaT) * kInvPi, (1 - p) * cosineHemispherePdf(wi.z),
                         (1 - pReverse) * cosineHemispherePdf(wo.z)};
        if (!isDelta()) e.glossy = evalReflection(Ggx(roughness), wo, wi, s, h);
    } else if (!isDelta()) {
        e.glossy = evalThrough(Ggx(roughness), wo, wi, etaT);
        if (!thin) e.eta = etaT;
    }
    e.glossy.pdfW *= p;
    e.glossy.reversePdfW *= pReverse;
    return e;
}

bool TransmissiveBsdf::sampleInterface(Vec3 wo, float etaT, float uLobe, Vec2 u, BsdfSample& sample) const {
    const Ggx ggx(roughness);
    const Vec3 h = ggx.sampleHalf(wo, u);
    const float cosO = glm::dot(wo, h);
    if (!(cosO > 0)) return false;
    const Split s = split(cosO, etaT);
    sample = {};
    sample.event = Event::Glossy;
    sample.transmitted = !(uLobe < s.pReflection);
    if (!sample.transmitted || thin) {
        const Vec3 wi = 2 * cosO * h - wo;
        if (!(wi.z > 0)) return false;  // single scattering
        sample.weight = (sample.transmitted ? s.transmitted : s.reflected) * ggx.g1(wi);
        sample.pdfW = ggx.reflectionPdf(wo, h);
        sample.reversePdfW = ggx.reflectionPdf(wi, h);
        sample.wi = sample.transmitted ? mirrored(wi) : wi;
    } else {
        sample.wi = (cosO / etaT - s.cosT) * h - wo / etaT;
        if (!(sample.wi.z < 0)) return false;
        const Vec3 far = mirrored(sample.wi);
        const float scale = square(cosO - etaT * s.cosT);
        sample.weight = s.transmitted * ggx.g1(far);
        sample.pdfW = ggx.visibleNormalPdf(wo, h, cosO) * (square(etaT) * s.cosT / scale);
        sample.reversePdfW = ggx.visibleNormalPdf(far, h, s.cosT) * (cosO / scale);
        sample.eta = etaT;
    }
    const float p = sample.transmitted ? 1 - s.pReflection : s.pReflection;
    choose(sample, p, sample.eta != 1 ? 1 - pReflectionBack(s, s.cosT, etaT) : p);
    return true;
}

bool TransmissiveBsdf::sampleDiffuse(Vec3 wo, float etaT, Vec2 u, BsdfSample& sample) const {
    sample = {};
    sample.wi = squareToCosineHemisphere(u);
    if (!(sample.wi.z > 0)) return false;
    sample.weight = diffuseReflectance(wo, sample.wi, etaT);
    sample.pdfW = cosineHemispherePdf(sample.wi.z);
    sample.reversePdfW = cosineHemispherePdf(wo.z);
    return true;
}

bool TransmissiveBsdf::sample(Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const {
    const float p = interfaceProbability(wo), etaT = etaFrom(wo.z);
    const bool diffuse = !(uLobe < p);
    if (!diffuse && isDelta()) {
        std::array<BsdfSample, 2> both;
        const int count = lobes(wo, both.data());
        const float pReflection = split(std::fabs(wo.z), etaT).pReflection;
        const bool reflects = count == 1 || uLobe < p * pReflection;
        sample = both[reflects ? 0 : 1];
        const Split back = split(std::fabs(sample.wi.z), etaFrom(sample.wi.z));
        choose(sample, p * (reflects ? pReflection : 1 - pReflection),
               interfaceProbability(sample.wi) * (reflects ? back.pReflection : 1 - back.pReflection));
        return true;
    }
    const Vec3 up = upright(wo, wo.z);
    if (!(diffuse ? sampleDiffuse(up, etaT, u, sample) : sampleInterface(up, etaT, uLobe / p, u, sample))) return false;
    sample.wi = upright(sample.wi, wo.z);
    const float pReverse = interfaceProbability(sample.wi);
    choose(sample, diffuse ? 1 - p : p, diffuse ? 1 - pReverse : pReverse);
    return true;
}

bool TransmissiveBsdf::sampleNonDelta(Vec3 wo, float uLobe, Vec2 u, BsdfSample& out) const {
    if (!isDelta()) return sample(wo, uLobe, u, out);
    if (!hasDiffuse() || !sampleDiffuse(upright(wo, wo.z), etaFrom(wo.z), u, out)) return false;
    out.wi = upright(out.wi, wo.z);
    return true;
}

int TransmissiveBsdf::lobes(Vec3 wo, BsdfSample* out) const {
    const float etaT = etaFrom(wo.z);
    const Split s = split(std::fabs(wo.z), etaT);
    out[0] = deltaReflection(wo, s.reflected);
    if (isBlack(s.transmitted)) return 1;
    const Vec3 wi = thin ? -wo : Vec3(-wo.x / etaT, -wo.y / etaT, -std::copysign(s.cosT, wo.z));
    out[1] = deltaTransmission(wi, s.transmitted, thin ? 1 : etaT);
    out[1].straight = thin;
    return 2;
}

Rgb TransmissiveBsdf::straightTransmittance(float cosTheta) const {
    return thin && isDelta() ? split(cosTheta, eta).transmitted : Rgb(0);
}

Rgb TransmissiveBsdf::albedo() const {
    const Split s = split(1, eta);
    return s.reflected + s.transmitted + s.diffuse;
}

}  // namespace lsde
