#include "transport/diffuse_aim.h"

#include <algorithm>

namespace lsde {

// From beside a small caster most paths would go there, and few anywhere else: at most so many for one of the lobe's.
constexpr float kMostAimedPaths = 32;

DiffuseAim::DiffuseAim(const Scene& scene, float boost) : boost_(boost) {
    for (const Caster& caster : scene.casters()) casters_.push_back(caster.bounds);
}

void DiffuseAim::learn(std::span<const Trial> trials) {
    constexpr int kDimensions = 3;
    std::vector<std::vector<PrimaryDensity::Trial>> of(casters_.size());
    for (const Trial& t : trials) of[t.caster].push_back(t.trial);
    learnt_.clear();
    for (auto& ofCaster : of) learnt_.emplace_back(std::move(ofCaster), kDimensions);
}

DiffuseAim::At::At(const DiffuseAim& aim, const Vertex& v, const DiffuseBsdf& bsdf) : aim_(aim), v_(v), bsdf_(bsdf) {
    const Vec3 normal = v.shadingNormal();
    for (size_t i = 0; i < aim.casters_.size(); ++i) {
        const Cone cone = coneTo(aim.casters_[i], v.surface.position);
        // What a sphere around the point is aimed at by the lobe.
        const float share = cone.everything ? 0 : cosineShare(cone, normal);
        if (!(share > 0)) continue;
        targets_[count_++] = {i, cone, share};
        share_ += share;
    }
    boost_ = share_ > 0 ? std::min(aim.boost_, kMostAimedPaths / share_) : aim.boost_;
}

// What is learnt at one point is meant for all: the cone's square stands upright on the surface.
DirectionMap DiffuseAim::At::directionsOf(const Cone& cone) const {
    DirectionMap map = DirectionMap::within(cone.axis, cone.oneMinusCos);
    const Vec3 normal = v_.shadingNormal();
    const Vec3 up = normal - glm::dot(normal, cone.axis) * cone.axis;
    const float length = glm::length(up);
    // Straight above there is no upright.
    if (length > 1e-3F) {
        map.frame.y = up / length;
        map.frame.x = glm::cross(map.frame.y, map.frame.z);
    }
    return map;
}

float DiffuseAim::At::learntDensity(const Target& target, Vec3 direction, float uEvent) const {
    if (aim_.learnt_.empty() || aim_.learnt_[target.caster].even()) return 1;
    const Vec2 square = directionsOf(target.cone).square(direction);
    return aim_.learnt_[target.caster].pdf({square.x, square.y, uEvent, 0});
}

float DiffuseAim::At::pathDensity(float lobePdf, Vec3 direction, float uEvent, Draw drawn) const {
    float density = 0;
    for (size_t i = 0; i < count_; ++i) {
        const Target& t = targets_[i];
        const bool drew = t.caster == drawn.caster;
        if (!drew && !within(t.cone, direction)) continue;
        const float learnt = drew ? drawn.learnt : learntDensity(t, direction, uEvent);
        density += t.share * conePdf(t.cone.oneMinusCos) * learnt;
    }
    return lobePdf + boost_ * density;
}

bool DiffuseAim::At::sample(float uChoice, Vec2 u, float uEvent, Direction& out) const {
    float left = uChoice * effort() - 1;  // below 0: the lobe
    out.caster = kLobe;
    out.uEvent = uEvent;
    if (!bsdf_.sample(v_.wo, u, out.sample)) return false;
    Draw drawn;
    if (left >= 0 && count_ > 0) {
        size_t chosen = 0;
        while (chosen + 1 < count_ && left >= boost_ * targets_[chosen].share)
            left -= boost_ * targets_[chosen++].share;
        const Target& target = targets_[chosen];
        out.caster = drawn.caster = target.caster;
        out.u = {u.x, u.y, uEvent, 0};
        if (!aim_.learnt_.empty()) out.u = aim_.learnt_[target.caster].sample(out.u, drawn.learnt);
        out.uEvent = out.u[2];
        out.sample.wi = v_.frame.toLocal(directionsOf(target.cone).direction({out.u[0], out.u[1]}));
        if (out.sample.wi.z * v_.wo.z <= 0) return false;
        out.sample.pdfW = bsdf_.eval(v_.wo, out.sample.wi).diffuse.pdfW;
    }
    out.weight = out.sample.pdfW / pathDensity(out.sample.pdfW, v_.frame.toWorld(out.sample.wi), out.uEvent, drawn);
    return true;
}

float DiffuseAim::At::pdf(Vec3 direction, float uEvent) const {
    const float lobePdf = bsdf_.eval(v_.wo, v_.frame.toLocal(direction)).diffuse.pdfW;
    return pathDensity(lobePdf, direction, uEvent, {}) / effort();
}

}  // namespace lsde
