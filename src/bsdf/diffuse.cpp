#include "bsdf/diffuse.h"

#include "sampling/warp.h"

namespace lsde {

BsdfEval DiffuseBsdf::eval(Vec3 wo, Vec3 wi) const {
    BsdfEval e;
    if (wo.z * wi.z > 0)
        e.diffuse = {albedo * kInvPi, cosineHemispherePdf(std::fabs(wi.z)), cosineHemispherePdf(std::fabs(wo.z))};
    return e;
}

bool DiffuseBsdf::sample(Vec3 wo, Vec2 u, BsdfSample& sample) const {
    Vec3 wi = squareToCosineHemisphere(u);
    if (wo.z == 0 || !(wi.z > 0)) return false;
    sample = {};
    sample.pdfW = cosineHemispherePdf(wi.z);
    sample.reversePdfW = cosineHemispherePdf(std::fabs(wo.z));
    sample.weight = albedo;
    wi.z = std::copysign(wi.z, wo.z);
    sample.wi = wi;
    return true;
}

}  // namespace lsde
