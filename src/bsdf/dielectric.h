// Smooth interfaces of clear solids and smooth thin walls.
#pragma once

#include "bsdf/bsdf_types.h"

namespace lsde {

// Interface between two media with exact dielectric Fresnel (unpolarised).
struct DielectricBsdf {
    float eta = 1.5F;  // refractive index behind the front side (z < 0) over that before it (z > 0)
    Rgb tint{1};       // of transmitted light (glTF baseColor)

    // Delta lobes with absolute weights F and (1 - F) tint; the second is absent under total reflection (count 1).
    // pdfW = 1 each. Weights are for power: radiance is the walk's business.
    int lobes(Vec3 wo, BsdfSample* out) const;
};

// A wall without thickness: R = F of one interface, T = (1 - F) tint, unbent (glTF KHR_materials_transmission).
struct ThinDielectricBsdf {
    float ior = 1.5F;
    Rgb tint{1};

    int lobes(Vec3 wo, BsdfSample* out) const;  // reflection, then straight passage
    Rgb transmittance(float cosTheta) const;    // (1 - F) tint
};

}  // namespace lsde
