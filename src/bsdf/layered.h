// Sheen and clearcoat over glTF's metallic-roughness material.
#pragma once

#include "bsdf/clearcoat.h"
#include "bsdf/metal_rough.h"
#include "bsdf/sheen.h"

namespace lsde {

// From the top: coat, sheen, base. Each gets what those above leave it (KHR_materials_clearcoat, KHR_materials_sheen).
//
// Lobes by class: where one of the coat and the base's glossy lobe is narrow and the other wide (kGlossyRoughness), the
// wide one is evaluated, sampled and lettered with the diffuse lobes, which have its class. So is the sheen.
struct LayeredBsdf {
    MetalRoughBsdf base;
    Sheen sheen;
    Clearcoat coat;

    bool hasDelta() const { return coatIsDelta() || baseIsDelta(); }
    bool hasDiffuse() const { return base.hasDiffuse() || !sheen.empty() || (anyNarrow() && anyWide()); }
    bool hasGlossy() const { return anyNarrow() || anyWide(); }
    // Of the lobes that are evaluated as glossy; 0: there are none.
    float glossyRoughness() const;

    BsdfEval eval(Vec3 wo, Vec3 wi, Asked asked = Asked::All) const;
    bool sample(Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const;
    bool sampleNonDelta(Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const;
    int lobes(Vec3 wo, BsdfSample* out) const;  // delta ones, at most two
    Rgb albedo() const;

  private:
    // With which each layer is chosen.
    struct Choice {
        float base = 1, sheen = 0, coat = 0;
    };
    bool coatIsDelta() const { return !coat.empty() && coat.isDelta(); }
    bool baseIsDelta() const { return base.hasGlossy() && base.glossyIsDelta(); }
    bool coatIsWide() const;
    bool baseIsWide() const;
    bool anyWide() const;    // of the non-delta lobes of coat and base
    bool anyNarrow() const;  // likewise
    float under(Vec3 wo, Vec3 wi) const { return sheen.transmittance(wo, wi) * coat.transmittance(wo, wi); }
    Choice choiceAt(Vec3 wo) const;
    BsdfEval evalAbove(Vec3 wo, Vec3 wi, Asked asked = Asked::All) const;
    BsdfSample baseReflection(Vec3 wo) const;
    // Draws from one layer; wi and event alone, or a delta lobe with its weight.
    bool sampleLayer(const Choice& choice, Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const;
};

}  // namespace lsde
