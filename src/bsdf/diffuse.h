// Surfaces without lobes, and Lambert's.
#pragma once

#include "bsdf/bsdf_types.h"

namespace lsde {

// Absorbs everything (a lamp's body).
struct BlackBsdf {};

// f = albedo / pi on both sides (Lambert); wo and wi on the same side.
struct DiffuseBsdf {
    Rgb albedo{0};

    BsdfEval eval(Vec3 wo, Vec3 wi) const;
    bool sample(Vec3 wo, Vec2 u, BsdfSample& sample) const;
};

}  // namespace lsde
