// A perfect mirror.
#pragma once

#include "bsdf/bsdf_types.h"

namespace lsde {

// Delta reflection with Schlick's Fresnel, F0 = f0, F90 = 1 (glTF metal of roughness 0).
struct MirrorBsdf {
    Rgb f0{1};

    BsdfSample reflect(Vec3 wo) const;  // the one delta lobe, pdfW = 1
};

}  // namespace lsde
