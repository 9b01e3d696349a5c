#include "sampling/warp.h"

namespace lsde {

Vec2 squareToDisk(Vec2 u) {
    const float a = 2 * u.x - 1, b = 2 * u.y - 1;
    if (a == 0 && b == 0) return {0, 0};
    const bool horizontal = std::fabs(a) > std::fabs(b);
    const float r = horizontal ? a : b;
    const float phi = horizontal ? (kPi / 4) * (b / a) : kPi / 2 - (kPi / 4) * (a / b);
    return r * Vec2(std::cos(phi), std::sin(phi));
}

Vec3 squareToCosineHemisphere(Vec2 u) {
    const Vec2 d = squareToDisk(u);  // Malley's method
    return {d, safeSqrt(1 - glm::dot(d, d))};
}

Vec3 squareToCone(Vec2 u, float oneMinusCosMax) {
    const float oneMinusCos = u.x * oneMinusCosMax;
    const float sine = safeSqrt(oneMinusCos * (2 - oneMinusCos));
    const float phi = 2 * kPi * u.y;
    return {sine * std::cos(phi), sine * std::sin(phi), 1 - oneMinusCos};
}

float conePdf(float oneMinusCosMax) { return 1 / (2 * kPi * oneMinusCosMax); }

Vec2 diskToSquare(Vec2 p) {
    const float length = glm::length(p);
    if (!(length > 0)) return {0.5F, 0.5F};
    const bool horizontal = std::fabs(p.x) > std::fabs(p.y);
    const float r = std::copysign(length, horizontal ? p.x : p.y);
    const float other = r * (4 / kPi) * std::atan(horizontal ? p.y / p.x : p.x / p.y);
    const Vec2 square = 0.5F * (horizontal ? Vec2(r, other) : Vec2(other, r)) + Vec2(0.5F);
    return glm::clamp(square, 0.0F, kOneMinusEpsilon);
}

Vec2 cosineHemisphereToSquare(Vec3 direction) { return diskToSquare(direction); }

Vec2 coneToSquare(Vec3 direction, float oneMinusCosMax) {
    // |direction - z|^2 / 2 = 1 - cos, exact for narrow cones as well.
    const float oneMinusCos = 0.5F * (square(direction.x) + square(direction.y) + square(direction.z - 1));
    const float turn = std::atan2(direction.y, direction.x) / (2 * kPi);
    return glm::clamp(Vec2(oneMinusCos / oneMinusCosMax, turn < 0 ? turn + 1 : turn), 0.0F, kOneMinusEpsilon);
}

Vec2 squareToTriangle(Vec2 u) {
    if (u.y > u.x) return {0.5F * u.x, u.y - 0.5F * u.x};
    return {u.x - 0.5F * u.y, 0.5F * u.y};
}

Vec3 sampleGgxVisibleNormal(Vec3 wo, float alphaX, float alphaY, Vec2 u) {
    // Stretched, so that the surface becomes one of roughness 1: a hemisphere of normals seen from `view`.
    const Vec3 view = glm::normalize(Vec3(alphaX * wo.x, alphaY * wo.y, wo.z));
    const float sine2 = square(view.x) + square(view.y);
    // A square root of denormals would not give a unit vector; at the pole any tangent will do.
    const Vec3 t1 =
        sine2 > std::numeric_limits<float>::min() ? Vec3(-view.y, view.x, 0) / std::sqrt(sine2) : Vec3(1, 0, 0);
    const Vec3 t2 = glm::cross(view, t1);
    // The projected hemisphere: a half disc, and a half ellipse of height view.z.
    const Vec2 p = squareToDisk(u);
    const float s = 0.5F * (1 + view.z);
    const float y = (1 - s) * safeSqrt(1 - square(p.x)) + s * p.y;
    const Vec3 n = p.x * t1 + y * t2 + safeSqrt(1 - square(p.x) - square(y)) * view;
    return glm::normalize(Vec3(alphaX * n.x, alphaY * n.y, std::max(0.0F, n.z)));
}

}  // namespace lsde
