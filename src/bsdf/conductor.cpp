#include "bsdf/conductor.h"

#include "bsdf/fresnel.h"

namespace lsde {

BsdfSample MirrorBsdf::reflect(Vec3 wo) const { return deltaReflection(wo, fresnelSchlick(f0, std::fabs(wo.z))); }

}  // namespace lsde
