// Vectors, constants and small geometry. Metres, radians; colours are linear Rec. 709.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace lsde {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using Mat4 = glm::mat4;
using Rgb = glm::vec3;  // one value a channel: radiance, power, reflectance

inline constexpr float kPi = 3.14159265358979323846F;
inline constexpr float kInvPi = 0.31830988618379067154F;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1F;  // largest float below 1

template <typename T>
constexpr T square(T x) {
    return x * x;
}

inline float lengthSquared(Vec3 v) { return glm::dot(v, v); }
inline float maxComponent(Vec3 v) { return std::max({v.x, v.y, v.z}); }
inline float mean(Rgb c) { return (c.x + c.y + c.z) / 3; }
inline bool isBlack(Rgb c) { return c.x == 0 && c.y == 0 && c.z == 0; }
inline bool isFinite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
// 0 below 1; l from 2^(l-1) up to 2^l. x: not negative.
inline int octaveOf(float x) { return x < 1 ? 0 : static_cast<int>(std::bit_cast<uint32_t>(x) >> 23) - 126; }
inline float safeSqrt(float x) { return std::sqrt(std::max(0.0F, x)); }

// Luminance of linear Rec. 709 (ITU-R BT.709, white D65).
inline float luminance(Rgb c) { return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z; }

// Orthonormal frame with z = n (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
struct Frame {
    Vec3 x, y, z;

    Frame() = default;
    explicit Frame(Vec3 n) : z(n) {
        const float sign = std::copysign(1.0F, n.z);
        const float a = -1.0F / (sign + n.z);
        const float b = n.x * n.y * a;
        x = Vec3(1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x);
        y = Vec3(b, sign + n.y * n.y * a, -n.y);
    }
    Vec3 toLocal(Vec3 v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
    Vec3 toWorld(Vec3 v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace lsde
