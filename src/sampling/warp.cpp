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

Vec3 squareToSphere(Vec2 u) { return squareToCone(u, 2); }

Vec3 squareToCone(Vec2 u, float oneMinusCosMax) {
    const float oneMinusCos = u.x * oneMinusCosMax;
    const float sine = safeSqrt(oneMinusCos * (2 - oneMinusCos));
    const float phi = 2 * kPi * u.y;
    return {sine * std::cos(phi), sine * std::sin(phi), 1 - oneMinusCos};
}

float conePdf(float oneMinusCosMax) { return 1 / (2 * kPi * oneMinusCosMax); }

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
