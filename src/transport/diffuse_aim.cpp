#include "transport/diffuse_aim.h"

#include <algorithm>

#include "sampling/warp.h"

namespace lsde {

// From beside a small caster most paths would go there, and few anywhere else: at most so many for one of the lobe's.
constexpr float kMostAimedPaths = 32;

DiffuseAim::DiffuseAim(const Scene& scene, float boost) : boost_(boost) {
    for (const Caster& caster : scene.casters()) casters_.push_back(caster.bounds);
}

DiffuseAim::At DiffuseAim::at(const Vertex& v, const DiffuseBsdf& bsdf) const {
    At at(v, bsdf, boost_);
    const Vec3 normal = v.wo.z < 0 ? -v.surface.ns : v.surface.ns;
    for (const Sphere& caster : casters_) {
        const Cone cone = coneTo(caster, v.surface.position);
        // What a sphere around the point is aimed at by the lobe.
        const float share = cone.everything ? 0 : cosineShare(cone, normal);
        if (!(share > 0)) continue;
        at.cones_[at.count_] = cone;
        at.shares_[at.count_++] = share;
        at.share_ += share;
    }
    if (at.share_ > 0) at.boost_ = std::min(boost_, kMostAimedPaths / at.share_);
    return at;
}

float DiffuseAim::At::pathDensity(float lobePdf, Vec3 direction, size_t drawn) const {
    float density = 0;
    for (size_t i = 0; i < count_; ++i)
        if (i == drawn || within(cones_[i], direction)) density += shares_[i] * conePdf(cones_[i].oneMinusCos);
    return lobePdf + boost_ * density;
}

bool DiffuseAim::At::sample(float uChoice, Vec2 u, Direction& out) const {
    float left = uChoice * effort() - 1;  // below 0: the lobe
    out.aimed = left >= 0 && count_ > 0;
    if (!bsdf_.sample(v_.wo, u, out.sample)) return false;
    size_t chosen = kLobe;
    if (out.aimed) {
        chosen = 0;
        while (chosen + 1 < count_ && left >= boost_ * shares_[chosen]) left -= boost_ * shares_[chosen++];
        const Cone& cone = cones_[chosen];
        out.sample.wi = v_.frame.toLocal(Frame(cone.axis).toWorld(squareToCone(u, cone.oneMinusCos)));
        if (out.sample.wi.z * v_.wo.z <= 0) return false;
        out.sample.pdfW = bsdf_.eval(v_.wo, out.sample.wi).diffuse.pdfW;
    }
    out.weight = out.sample.pdfW / pathDensity(out.sample.pdfW, v_.frame.toWorld(out.sample.wi), chosen);
    return true;
}

float DiffuseAim::At::pdf(Vec3 direction) const {
    return pathDensity(bsdf_.eval(v_.wo, v_.frame.toLocal(direction)).diffuse.pdfW, direction, kLobe) / effort();
}

}  // namespace lsde
