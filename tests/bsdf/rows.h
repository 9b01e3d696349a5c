// The table of Bsdfs that every test of the common interface runs over. A new material is a row here.
#pragma once

#include <string>
#include <vector>

#include "bsdf/bsdf.h"

namespace lsde::test {

struct BsdfRow {
    std::string name;
    Bsdf bsdf;
};

inline const std::vector<BsdfRow>& bsdfRows() {
    static const Rgb kTint(0.9F, 0.5F, 0.1F), kWhite(1), kF0(0.04F), kTintedF0(0.08F, 0.04F, 0.02F);
    static const std::vector<BsdfRow> rows = {
        {"black", BlackBsdf{}},
        {"Lambert", DiffuseBsdf{kTint}},
        {"mirror", MirrorBsdf{}},
        {"tinted mirror", MirrorBsdf{kTint}},
        {"glass", DielectricBsdf{1.5F, kWhite}},
        {"glass from within", DielectricBsdf{1 / 1.5F, kWhite}},
        {"tinted glass", DielectricBsdf{1.5F, kTint}},
        {"no interface", DielectricBsdf{1.0F, kWhite}},
        {"pane", ThinDielectricBsdf{1.5F, kWhite}},
        {"tinted pane", ThinDielectricBsdf{1.5F, kTint}},
        {"fine metal", MetalRoughBsdf{kTint, kF0, 1, 1, 0.2F}},
        {"rough white metal", MetalRoughBsdf{kWhite, kF0, 1, 1, 0.5F}},
        {"roughest metal", MetalRoughBsdf{kWhite, kF0, 1, 1, 1}},
        {"smooth metal", MetalRoughBsdf{kTint, kF0, 1, 1, 0}},
        {"glossy plastic", MetalRoughBsdf{kTint, kF0, 1, 0, 0.3F}},
        {"rough plastic", MetalRoughBsdf{0.8F * kWhite, kF0, 1, 0, 0.7F}},
        {"plastic of tinted, weak coat", MetalRoughBsdf{kTint, kTintedF0, 0.5F, 0, 0.4F}},
        {"half metal", MetalRoughBsdf{kTint, kF0, 1, 0.5F, 0.5F}},
        {"coat on black", MetalRoughBsdf{Rgb(0), kF0, 1, 0, 0.5F}},
        {"no coat", MetalRoughBsdf{kTint, kF0, 0, 0, 0.5F}},
        {"smooth plastic", MetalRoughBsdf{kTint, kF0, 1, 0, 0}},
        {"smooth half metal", MetalRoughBsdf{kTint, kF0, 1, 0.5F, 0}},
        {"brushed metal",
         MetalRoughBsdf{.baseColor = kTint, .roughness = 0.4F, .anisotropy = 0.7F, .direction = {0.6F, 0.8F}}},
        {"brushed smooth plastic",
         MetalRoughBsdf{.baseColor = kTint, .metallic = 0, .roughness = 0.3F, .anisotropy = 1}},
        {"soap on metal",
         MetalRoughBsdf{.baseColor = Rgb(0.7F, 0.6F, 0.5F), .roughness = 0.4F, .film = {1, 1.33F, 5e-7F}}},
        {"oil on smooth plastic",
         MetalRoughBsdf{.baseColor = kTint, .metallic = 0, .roughness = 0, .film = {0.7F, 1.8F, 3e-7F}}},
        {"velvet", LayeredBsdf{.base = MetalRoughBsdf{kTint, kF0, 0, 0, 1}, .sheen = {Rgb(0.8F, 0.4F, 0.2F), 0.5F}}},
        {"fine cloth on plastic",
         LayeredBsdf{.base = MetalRoughBsdf{kTint, kF0, 1, 0, 0.4F}, .sheen = {Rgb(0.5F), 0.3F}}},
        {"varnished wood", LayeredBsdf{.base = MetalRoughBsdf{kTint, kF0, 1, 0, 0.6F}, .coat = {1, 0}}},
        {"car paint", LayeredBsdf{.base = MetalRoughBsdf{kTint, kF0, 1, 0.5F, 0.5F}, .coat = {1, 0.2F}}},
        {"worn varnish, bent",
         LayeredBsdf{.base = MetalRoughBsdf{kTint, kF0, 1, 0.5F, 0.4F}, .coat = {0.7F, 0.5F, {0.28F, 0, 0.96F}}}},
        {"coated mirror", LayeredBsdf{.base = MetalRoughBsdf{kTint, kF0, 1, 1, 0}, .coat = {1, 0}}},
        {"rough coat on a mirror and cloth",
         LayeredBsdf{.base = MetalRoughBsdf{kTint, kF0, 1, 1, 0}, .sheen = {Rgb(0.3F), 0.8F}, .coat = {1, 0.3F}}},
        {"ground glass", TransmissiveBsdf{.roughness = 0.35F}},
        {"rough glass", TransmissiveBsdf{.roughness = 0.5F}},
        {"rough glass from within", TransmissiveBsdf{.eta = 1 / 1.5F, .roughness = 0.5F}},
        {"roughest tinted diamond", TransmissiveBsdf{.baseColor = kTint, .eta = 2.4F, .roughness = 1}},
        {"rough pane", TransmissiveBsdf{.roughness = 0.4F, .thin = true}},
        {"rough tinted pane", TransmissiveBsdf{.baseColor = kTint, .roughness = 0.8F, .thin = true}},
        {"milky glass", TransmissiveBsdf{.baseColor = kTint, .roughness = 0.4F, .transmission = 0.6F}},
        {"smooth milky glass", TransmissiveBsdf{.baseColor = kTint, .transmission = 0.6F}},
        {"milky pane", TransmissiveBsdf{.baseColor = kTint, .roughness = 0.3F, .transmission = 0.5F, .thin = true}},
        {"smooth milky pane", TransmissiveBsdf{.baseColor = kTint, .transmission = 0.5F, .thin = true}},
        {"half metal glass",
         TransmissiveBsdf{.baseColor = kTint, .roughness = 0.4F, .transmission = 0.7F, .metallic = 0.5F}},
        {"glass of tinted, weak reflection",
         TransmissiveBsdf{.specularColor = kTint, .specular = 0.5F, .eta = 1.8F, .roughness = 0.4F}},
    };
    return rows;
}

inline Vec3 directionAt(float angleDeg, float azimuthDeg) {
    const float t = angleDeg * kPi / 180, p = azimuthDeg * kPi / 180;
    return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
}

// From above, slanted, near the horizon, and from below.
inline std::vector<Vec3> bsdfDirections() {
    return {{0, 0, 1}, directionAt(40, 20), directionAt(75, 200), directionAt(120, 130)};
}

}  // namespace lsde::test
