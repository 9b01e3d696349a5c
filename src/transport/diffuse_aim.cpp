#include "transport/diffuse_aim.h"

#include <array>

#include "sampling/warp.h"
#include "scene/casters.h"
#include "transport/cone.h"

namespace lsde {

// The cones as a point sees them, and the probability of each. What a sphere around the point is aimed at by the lobe.
struct DiffuseAim::Parts {
    std::array<Cone, kMaxCasters> cone;
    std::array<float, kMaxCasters> probability{};
    float aimed = 0;  // sum of the probabilities
};

DiffuseAim::DiffuseAim(const Scene& scene, float aimedShare) : aimedShare_(aimedShare) {
    if (!(aimedShare > 0)) return;
    for (const Caster& caster : scene.casters()) casters_.push_back(caster.bounds);
}

DiffuseAim::Parts DiffuseAim::partsAt(const Vertex& v) const {
    Parts parts;
    const Vec3 normal = v.wo.z < 0 ? -v.surface.ns : v.surface.ns;
    float total = 0;
    for (size_t i = 0; i < casters_.size(); ++i) {
        parts.cone[i] = coneTo(casters_[i], v.surface.position);
        parts.probability[i] = cosineShare(parts.cone[i], normal);
        total += parts.probability[i];
    }
    if (!(total > 0)) return parts;
    for (size_t i = 0; i < casters_.size(); ++i) {
        float& p = parts.probability[i];
        p = parts.cone[i].everything ? 0 : p * (aimedShare_ / total);
        parts.aimed += p;
    }
    return parts;
}

float DiffuseAim::mixturePdf(const Parts& parts, float lobePdf, Vec3 direction) const {
    float pdf = (1 - parts.aimed) * lobePdf;
    for (size_t i = 0; i < casters_.size(); ++i)
        if (parts.probability[i] > 0 && within(parts.cone[i], direction))
            pdf += parts.probability[i] * conePdf(parts.cone[i].oneMinusCos);
    return pdf;
}

bool DiffuseAim::sample(const Vertex& v, const DiffuseBsdf& bsdf, float uChoice, Vec2 u, Direction& out) const {
    const Parts parts = partsAt(v);
    size_t chosen = 0;
    for (; chosen < casters_.size(); ++chosen) {
        if (uChoice < parts.probability[chosen]) break;
        uChoice -= parts.probability[chosen];
    }
    out.aimed = chosen < casters_.size();
    if (!bsdf.sample(v.wo, u, out.sample)) return false;
    if (out.aimed) {
        const Cone& cone = parts.cone[chosen];
        out.sample.wi = v.frame.toLocal(Frame(cone.axis).toWorld(squareToCone(u, cone.oneMinusCos)));
        if (out.sample.wi.z * v.wo.z <= 0) return false;
        out.sample.pdfW = bsdf.eval(v.wo, out.sample.wi).diffuse.pdfW;
    }
    out.weight = out.sample.pdfW / mixturePdf(parts, out.sample.pdfW, v.frame.toWorld(out.sample.wi));
    return true;
}

float DiffuseAim::pdf(const Vertex& v, const DiffuseBsdf& bsdf, Vec3 direction) const {
    return mixturePdf(partsAt(v), bsdf.eval(v.wo, v.frame.toLocal(direction)).diffuse.pdfW, direction);
}

}  // namespace lsde
