#include "sampling/spherical_triangle.h"

#include <algorithm>
#include <cmath>

namespace lsde {

namespace {

// Below, points spread evenly by area are as good: directions and distances differ by less than a hundredth. Above, the
// point nearly lies on the triangle.
constexpr float kLeastSolidAngle = 3e-4F, kMostSolidAngle = 6;

// The unit vector at right angles to `axis` on the way from it to v (both unit).
Vec3 across(Vec3 v, Vec3 axis) {
    const Vec3 away = v - axis, d = away - glm::dot(away, axis) * axis;
    return d / std::sqrt(std::max(lengthSquared(d), 1e-30F));
}

// 1 - cos of the angle between unit vectors.
float oneMinusCos(Vec3 v, Vec3 w) { return 0.5F * lengthSquared(v - w); }

// The point of the arc from `axis` in the direction `towards`, by 1 - cos of its length.
Vec3 onArc(Vec3 axis, Vec3 towards, float oneMinusCos) {
    return (1 - oneMinusCos) * axis + std::sqrt(std::max(0.0F, oneMinusCos * (2 - oneMinusCos))) * towards;
}

}  // namespace

std::optional<SphericalTriangle> SphericalTriangle::seen(Vec3 a, Vec3 b, Vec3 c) {
    const float a2 = lengthSquared(a), b2 = lengthSquared(b), c2 = lengthSquared(c);
    if (!(a2 > 0 && b2 > 0 && c2 > 0)) return {};
    a /= std::sqrt(a2);
    b /= std::sqrt(b2);
    c /= std::sqrt(c2);
    // tan of half the solid angle (Van Oosterom & Strackee 1983); the volume is taken from the sides.
    const float volume = std::fabs(glm::dot(a, glm::cross(b - a, c - a)));
    const float solidAngle = 2 * std::atan2(volume, 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
    if (!(solidAngle >= kLeastSolidAngle && solidAngle <= kMostSolidAngle)) return {};
    return SphericalTriangle(a, b, c, solidAngle);
}

// Arvo's steps, with 1 - cos in place of cos throughout: in float a small triangle would lose its digits to the ones.
Vec3 SphericalTriangle::sample(Vec2 u) const {
    // The angle at a, between the planes of its sides.
    const Vec3 toB = across(b_, a_), toC = across(c_, a_);
    const float cosA = glm::dot(toB, toC), sinA = glm::length(glm::cross(toB, toC));
    // A point of the side from a to c whose triangle with a and b has this area.
    const float area = u.x * solidAngle_, sine = std::sin(area), less = 2 * square(std::sin(0.5F * area));
    const float p = sine * sinA - less * cosA;
    const float q = sine * cosA + less * sinA - sinA * oneMinusCos(a_, b_);
    const float s = sine * cosA - (1 - less) * sinA, t = (1 - less) * cosA + sine * sinA;
    const float scale = (q * s + p * t) * sinA;
    const float along = scale != 0 ? std::clamp((q * less + p * sine) / scale, 0.0F, 2.0F) : 0;
    const Vec3 side = onArc(a_, toC, along);
    // And a point of the arc from b to there.
    return onArc(b_, across(side, b_), u.y * oneMinusCos(side, b_));
}

}  // namespace lsde
