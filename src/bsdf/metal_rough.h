// glTF's metallic-roughness material (glTF 2.0 appendix B, with KHR_materials_specular, _ior, _anisotropy and
// _iridescence).
#pragma once

#include "bsdf/bsdf_types.h"
#include "bsdf/microfacet.h"
#include "bsdf/thin_film.h"

namespace lsde {

// Diffuse lobe  (1 - metallic) (1 - specular max(F(h))) baseColor / pi,  glossy lobe  GGX (alpha = roughness^2,
// separable Smith G as in the oracle: see microfacet.h) times  metallic Schlick(baseColor, 1) + (1 - metallic) specular
// Schlick(f0Dielectric, 1), one-sided about the side of wo. roughness 0: the glossy lobe is a delta reflection.
//
// The specification's mix is reciprocal, but near the horizon it gives back more light than it gets: 1 - F(h) hardly
// falls where the coat's reflection rises. A white base under a smooth coat reflects 1.00 up to 45 degrees, 1.2 at
// 75, 1.6 at 85, and 1.04 of Lambertian light; of roughness 0.5 1.05 at 75 degrees and 1.01 of Lambertian light.
struct MetalRoughBsdf {
    Rgb baseColor{1};
    Rgb dielectricF0{0.04F};  // min(((ior - 1)/(ior + 1))^2 specularColor, 1), without the factor `specular`
    float specular = 1;       // KHR_materials_specular.specularFactor
    float metallic = 1;
    float roughness = 1;  // glTF's; alpha = roughness^2
    // KHR_materials_anisotropy: along `direction` (unit, in the plane of the local frame) alpha rises by strength^2 of
    // what is missing to 1. (Its text has the height-correlated G; here it is separable, as everywhere.)
    float anisotropy = 0;
    Vec2 direction{1, 0};
    ThinFilm film;  // replaces both Schlick terms by those of the surface under a film

    bool glossyIsDelta() const { return roughness == 0 && anisotropy == 0; }
    // The larger of the two that an anisotropic lobe has.
    float widestRoughness() const { return anisotropy > 0 ? std::sqrt(alphaAlong()) : roughness; }
    bool hasDiffuse() const { return metallic < 1 && maxComponent(baseColor) > 0; }
    bool hasGlossy() const { return metallic > 0 || specular > 0; }

    BsdfEval eval(Vec3 wo, Vec3 wi, Asked asked = Asked::All) const;
    bool sample(Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const;
    bool sampleNonDelta(Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) const;
    BsdfSample reflect(Vec3 wo) const;  // the delta lobe of roughness 0, pdfW = 1
    Rgb albedo() const;                 // diffuse and glossy reflectance at normal incidence

  private:
    float glossyProbability(Vec3 wo) const;  // of choosing the glossy lobe, from either side
    float alphaAlong() const { return square(roughness) + (1 - square(roughness)) * square(anisotropy); }
    Ggx ggx() const { return anisotropy > 0 ? Ggx(alphaAlong(), square(roughness)) : Ggx(roughness); }
    Vec3 toLobe(Vec3 w) const;    // to the upper side, x along the direction
    Vec3 fromLobe(Vec3 w) const;  // back to the local frame, still above
    bool sampleAbove(Vec3 wo, bool glossy, Vec2 u, BsdfSample& sample) const;
};

}  // namespace lsde
