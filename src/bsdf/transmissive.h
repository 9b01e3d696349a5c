// glTF's transmissive materials beyond smooth clear glass: rough, partly diffuse, partly metal, of another reflectance.
#pragma once

#include "bsdf/bsdf_types.h"
#include "bsdf/fresnel.h"
#include "bsdf/microfacet.h"

namespace lsde {

// KHR_materials_transmission with or without KHR_materials_volume, as its text mixes them, with exact dielectric
// Fresnel F of the microfacets in place of Schlick's:
//   metal (metallic):           F' = Schlick(baseColor), reflection
//   dielectric (1 - metallic):  F' reflection over a base of  (1 - transmission) baseColor diffuse,
//                               transmission baseColor through the interface, each times 1 - max(F')
// Reflection is GGX, as in metal_rough.h. A solid refracts (Walter et al. 2007, eq. 21); a thin wall's transmission is
// its reflection mirrored at the plane. roughness 0: both are delta events, a thin wall's an unbent one.
// KHR_materials_specular: F' = specular (f + (1 - f) (F - F0) / (1 - F0)) with f = min(F0 specularColor, 1), which is F
// where the extension is not used. What of total reflection it takes away is absorbed.
//
// Single scattering: light that meets a second microfacet is lost. The mix of a diffuse base under 1 - F(h) has the
// flaw told in metal_rough.h: near the horizon it gives back more than it gets. From within a solid, of which the text
// says nothing and where total reflection would make that 1.2 of the light at 60 degrees, the base is under 1 - F of
// the flatter of the two directions instead.
struct TransmissiveBsdf {
    Rgb baseColor{1};
    Rgb specularColor{1};    // KHR_materials_specular.specularColorFactor
    float specular = 1;      // KHR_materials_specular.specularFactor
    float eta = 1.5F;        // solid: refractive index behind the front side over that before it; thin wall: its own
    float roughness = 0;     // glTF's; alpha = roughness^2
    float transmission = 1;  // KHR_materials_transmission.transmissionFactor
    float metallic = 0;
    bool thin = false;

    bool isDelta() const { return roughness == 0; }  // of what is neither diffuse nor absorbed
    bool hasDiffuse() const { return metallic < 1 && transmission < 1 && maxComponent(baseColor) > 0; }

    // f is that of power, as in BsdfEval.
    BsdfEval eval(Vec3 wo, Vec3 wi) const;
    bool sample(Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const;
    bool sampleNonDelta(Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const;
    int lobes(Vec3 wo, BsdfSample* out) const;        // of roughness 0: reflection and transmission, as DielectricBsdf
    Rgb straightTransmittance(float cosTheta) const;  // of a thin wall of roughness 0; else 0
    Rgb albedo() const;                               // at normal incidence, transmitted light included

  private:
    // How the microfacets divide light that meets them at an angle, and where it goes.
    struct Split {
        Rgb reflected{1}, transmitted{0}, diffuse{0};
        float cosT = 0;         // of the refracted direction; 0: there is none
        float pReflection = 1;  // with which reflection is chosen from the two
    };
    float etaFrom(float z) const { return thin || z > 0 ? eta : 1 / eta; }  // of the far side over that of z
    Split split(float cosI, float etaT) const;
    float pReflectionBack(const Split& s, float cosT, float etaT) const;
    float interfaceProbability(Vec3 wo) const;  // of choosing reflection or transmission, not the diffuse base
    Rgb diffuseReflectance(Vec3 wo, Vec3 wi, float etaT) const;  // both above
    LobeEval evalReflection(const Ggx& ggx, Vec3 wo, Vec3 wi, const Split& s, Vec3 h) const;
    LobeEval evalThrough(const Ggx& ggx, Vec3 wo, Vec3 wi, float etaT) const;
    bool sampleInterface(Vec3 wo, float etaT, float uLobe, Vec2 u, BsdfSample& sample) const;
    bool sampleDiffuse(Vec3 wo, float etaT, Vec2 u, BsdfSample& sample) const;
};

}  // namespace lsde
