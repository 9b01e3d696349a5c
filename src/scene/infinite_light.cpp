#include "scene/infinite_light.h"

#include "sampling/warp.h"

namespace lsde {

Rgb SunDisc::radiance(Vec3 towards) const {
    // |towards - direction|^2 / 2 = 1 - cos, exact for narrow cones as well.
    return 0.5F * lengthSquared(towards - direction) <= oneMinusCos ? radianceOfDisc : Rgb(0);
}

Vec3 SunDisc::sample(Vec2 u, float& pdfW) const {
    pdfW = conePdf(oneMinusCos);
    return Frame(direction).toWorld(squareToCone(u, oneMinusCos));
}

float SunDisc::pdfW(Vec3 towards) const { return isBlack(radiance(towards)) ? 0 : conePdf(oneMinusCos); }

Rgb InfiniteLight::radiance(Vec3 towards) const {
    return std::visit([&](const auto& s) { return s.radiance(towards); }, source);
}

Rgb InfiniteLight::integral() const {
    return std::visit([](const auto& s) { return s.integral(); }, source);
}

Vec3 InfiniteLight::sample(Vec2 u, float& pdfW) const {
    return std::visit([&](const auto& s) { return s.sample(u, pdfW); }, source);
}

float InfiniteLight::pdfW(Vec3 towards) const {
    return std::visit([&](const auto& s) { return s.pdfW(towards); }, source);
}

}  // namespace lsde
