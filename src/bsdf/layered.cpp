#include "bsdf/layered.h"

#include "path/event.h"
#include "sampling/warp.h"

namespace lsde {

namespace {

Vec3 upper(Vec3 w) { return {w.x, w.y, std::fabs(w.z)}; }

void addTo(LobeEval& lobe, const LobeEval& part, float scale, float p, float pReverse) {
    lobe.f += part.f * scale;
    lobe.pdfW += part.pdfW * p;
    lobe.reversePdfW += part.reversePdfW * pReverse;
}

}  // namespace

bool LayeredBsdf::coatIsWide() const { return !coat.empty() && coat.roughness >= kGlossyRoughness; }

bool LayeredBsdf::baseIsWide() const { return base.hasGlossy() && base.widestRoughness() >= kGlossyRoughness; }

bool LayeredBsdf::anyWide() const { return coatIsWide() || baseIsWide(); }

bool LayeredBsdf::anyNarrow() const {
    return (!coat.empty() && !coat.isDelta() && !coatIsWide()) ||
           (base.hasGlossy() && !base.glossyIsDelta() && !baseIsWide());
}

float LayeredBsdf::glossyRoughness() const {
    if (!hasGlossy()) return 0;
    return anyNarrow() ? 0.5F * kGlossyRoughness : 1;  // of the class alone
}

// By what a smooth stack of layers would send back. None is left below a tenth, so that weights stay bounded.
LayeredBsdf::Choice LayeredBsdf::choiceAt(Vec3 wo) const {
    constexpr float kLeast = 0.1F;
    const float byCoat = coat.reflectance(glm::dot(coat.normal, wo));
    const float bySheen = (1 - byCoat) * std::min(1.0F, maxComponent(sheen.color) * sheen.albedo(wo.z));
    const float byBase = (1 - byCoat - bySheen) * maxComponent(base.albedo());
    Choice c{std::max(byBase, kLeast), sheen.empty() ? 0 : std::max(bySheen, kLeast),
             coat.empty() ? 0 : std::max(byCoat, kLeast)};
    const float all = c.base + c.sheen + c.coat;
    return {c.base / all, c.sheen / all, c.coat / all};
}

BsdfEval LayeredBsdf::evalAbove(Vec3 wo, Vec3 wi, Asked asked) const {
    const bool narrow = anyNarrow();
    // A wide lobe beside a narrow one is of the diffuse ones.
    if (asked == Asked::DiffuseF && narrow && anyWide()) asked = Asked::F;
    Choice p, pReverse;
    if (asked == Asked::All) {
        p = choiceAt(wo);
        pReverse = choiceAt(wi);
    }
    const BsdfEval below = base.eval(wo, wi, asked);
    const float scale = under(wo, wi);
    BsdfEval e;
    addTo(e.diffuse, below.diffuse, scale, p.base, pReverse.base);
    addTo(narrow && baseIsWide() ? e.diffuse : e.glossy, below.glossy, scale, p.base, pReverse.base);
    if (!sheen.empty()) {
        const LobeEval cloth{sheen.color * sheen.lobe(wo, wi), cosineHemispherePdf(wi.z), cosineHemispherePdf(wo.z)};
        addTo(e.diffuse, cloth, coat.transmittance(wo, wi), p.sheen, pReverse.sheen);
    }
    if (!coat.empty() && !coat.isDelta() && asked != Asked::DiffuseF)
        addTo(narrow && coatIsWide() ? e.diffuse : e.glossy, coat.eval(wo, wi), 1, p.coat, pReverse.coat);
    return e;
}

BsdfEval LayeredBsdf::eval(Vec3 wo, Vec3 wi, Asked asked) const {
    return wo.z * wi.z > 0 ? evalAbove(upper(wo), upper(wi), asked) : BsdfEval{};
}

BsdfSample LayeredBsdf::baseReflection(Vec3 wo) const {
    BsdfSample s = base.reflect(wo);
    s.weight *= under(wo, s.wi);
    return s;
}

bool LayeredBsdf::sampleLayer(const Choice& choice, Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const {
    if (uLobe < choice.coat) {
        if (coat.isDelta()) {
            sample = coat.reflect(wo);
            choose(sample, choice.coat, choiceAt(sample.wi).coat);
            return sample.weight != Rgb(0);
        }
        sample.event = anyNarrow() && coatIsWide() ? Event::Diffuse : Event::Glossy;
        return coat.sample(wo, u, sample.wi);
    }
    if (uLobe < choice.coat + choice.sheen) {
        sample.wi = squareToCosineHemisphere(u);
        sample.event = Event::Diffuse;
        return sample.wi.z > 0;
    }
    const float rest = std::min((uLobe - choice.coat - choice.sheen) / choice.base, kOneMinusEpsilon);
    if (!base.sample(wo, rest, u, sample)) return false;
    if (sample.delta) {
        sample.weight *= under(wo, sample.wi);
        choose(sample, choice.base, choiceAt(sample.wi).base);
    } else if (sample.event == Event::Glossy && anyNarrow() && baseIsWide()) {
        sample.event = Event::Diffuse;
    }
    return true;
}

bool LayeredBsdf::sample(Vec3 woSide, float uLobe, Vec2 u, BsdfSample& sample) const {
    const Vec3 wo = upper(woSide);
    sample = {};
    if (!sampleLayer(choiceAt(wo), wo, uLobe, u, sample)) return false;
    if (!sample.delta) {
        const BsdfEval e = evalAbove(wo, sample.wi);
        const LobeEval& lobe = sample.event == Event::Diffuse ? e.diffuse : e.glossy;
        if (!(lobe.pdfW > 0)) return false;
        sample.weight = lobe.f * (sample.wi.z / lobe.pdfW);
        sample.pdfW = lobe.pdfW;
        sample.reversePdfW = lobe.reversePdfW;
    }
    sample.wi.z = std::copysign(sample.wi.z, woSide.z);
    return true;
}

// What would be a delta event is no light at all here: the weights of the others need no change.
bool LayeredBsdf::sampleNonDelta(Vec3 wo, float uLobe, Vec2 u, BsdfSample& out) const {
    return sample(wo, uLobe, u, out) && !out.delta;
}

int LayeredBsdf::lobes(Vec3 woSide, BsdfSample* out) const {
    const Vec3 wo = upper(woSide);
    int count = 0;
    if (baseIsDelta()) out[count++] = baseReflection(wo);
    if (coatIsDelta()) {
        out[count] = coat.reflect(wo);
        if (!isBlack(out[count].weight)) ++count;
    }
    for (int i = 0; i < count; ++i) out[i].wi.z = std::copysign(out[i].wi.z, woSide.z);
    return count;
}

Rgb LayeredBsdf::albedo() const {
    const Vec3 up(0, 0, 1);
    const Rgb belowCoat = sheen.color * sheen.albedo(1) + sheen.transmittance(up, up) * base.albedo();
    const float reflected = coat.reflectance(coat.normal.z);
    return glm::min(Rgb(reflected) + (1 - reflected) * belowCoat, Rgb(1));
}

}  // namespace lsde
