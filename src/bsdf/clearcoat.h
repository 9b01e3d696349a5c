// A clear varnish over any surface.
#pragma once

#include "bsdf/bsdf_types.h"
#include "bsdf/microfacet.h"

namespace lsde {

// KHR_materials_clearcoat: GGX of ior 1.5 by Schlick over a base that gets what the coat does not reflect. The text
// takes the coat's Fresnel term from the view's angle with the normal alone, which light that comes the other way does
// not see: as photons and paths from the eye must agree, the lobe has that of its microfacets here, as all other lobes,
// and the base the smaller share of both directions. Looked at from anywhere under light no lower than the eye, a
// smooth coat is the text's. The emission of a surface is not dimmed by its coat, as the text would have it.
struct Clearcoat {
    float factor = 0;
    float roughness = 0;   // alpha = roughness^2
    Vec3 normal{0, 0, 1};  // its own, local frame, above the surface

    bool empty() const { return factor == 0; }
    bool isDelta() const { return roughness == 0; }
    float reflectance(float cosTheta) const;       // of a smooth one
    float transmittance(Vec3 wo, Vec3 wi) const;   // of the base's light, in and out
    LobeEval eval(Vec3 wo, Vec3 wi) const;         // of one that is not delta; directions above the surface
    bool sample(Vec3 wo, Vec2 u, Vec3& wi) const;  // false: below the surface
    BsdfSample reflect(Vec3 wo) const;             // of roughness 0; its weight is 0 if it ends below the surface
};

}  // namespace lsde
