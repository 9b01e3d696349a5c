// Light that stands on cloth at grazing angles.
#pragma once

#include "base/math.h"

namespace lsde {

// KHR_materials_sheen: Charlie (Conty Estevez & Kulla 2017, "Production Friendly Microfacet Sheen BRDF"), no Fresnel.
struct Sheen {
    Rgb color{0};
    float roughness = 0;  // the extension's; alpha = roughness^2

    bool empty() const { return color == Rgb(0); }
    // Without the colour (1/sr); both directions above the surface. Reciprocal.
    float lobe(Vec3 wo, Vec3 wi) const;
    // Integral of lobe() times cosine over the upper hemisphere, from a table of itself (tests/bsdf/layered_test.cpp).
    //
    // Near the horizon the lobe gives back more light than it gets, up to 2.9 times of it at roughness below 0.1
    // and 1.6 at 0.13; of Lambertian light less than all. So says the text.
    float albedo(float cosTheta) const;
    // What is left for the layers below, by the text's albedo scaling: the smaller of both directions' shares, which is
    // reciprocal; not below 0.
    float transmittance(Vec3 wo, Vec3 wi) const;
};

}  // namespace lsde
