#include "photon/photon.h"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include "base/error.h"
#include "base/hash.h"

namespace lsde {

namespace {

void checkDirection(Vec3 v, const char* what) {
    if (!(isFinite(v) && lengthSquared(v) > 0))
        throw Error(fmt::format("{} ({}, {}, {}) of a photon: expected a unit vector", what, v.x, v.y, v.z));
}

}  // namespace

bool operator<(const PackedPhoton& a, const PackedPhoton& b) {
    const auto key = [](const PackedPhoton& p) {
        // By value: nothing refers to a part of 16 bits.
        return std::make_tuple(p.position.x, p.position.y, p.position.z, p.payload.path, p.payload.power,
                               p.payload.direction, p.payload.normal, p.payload.light, p.payload.medium,
                               p.payload.flags, p.payload.wavelength);
    };
    return key(a) < key(b);
}

PackedPhoton pack(const Photon& photon) {
    checkDirection(photon.direction, "direction");
    checkDirection(photon.ng, "normal");
    PackedPhoton packed;
    packed.position = photon.position;
    packed.payload.path = photon.path.bits();
    packed.payload.power = packPower(photon.power, photon.key);
    packed.payload.direction = packDirection(photon.direction);
    packed.payload.normal = packNormal(photon.ng);
    packed.payload.light = photon.light;
    packed.payload.medium = photon.medium;
    const bool front = glm::dot(photon.direction, photon.ng) > 0;
    packed.payload.flags = (photon.flags & ~kLandedOnFront & kAllPhotonFlags) | (front ? kLandedOnFront : 0);
    packed.payload.wavelength = photon.wavelength & 0xfff;
    return packed;
}

uint32_t packPower(Rgb power, uint64_t key) {
    if (!isFinite(power) || power.x < 0 || power.y < 0 || power.z < 0)
        throw Error(
            fmt::format("power ({}, {}, {}) of a photon: expected finite numbers >= 0", power.x, power.y, power.z));
    const float most = maxComponent(power);
    if (most == 0) return 0;
    int exponent = 0;
    // The largest mantissa is at most 255: adding less than 1 to it never carries into a ninth bit.
    if (std::frexp(most, &exponent) > 255.0F / 256.0F) ++exponent;
    // Less than the least unit is rounded to none or one of it, without bias too.
    const int stored = std::max(exponent - 8 + kPowerExponentBias, kLeastPowerExponent);
    uint64_t random = mix64(key);
    uint32_t bits = static_cast<uint32_t>(stored) << 24;
    const auto perUnit = std::bit_cast<double>(static_cast<uint64_t>(1023 + kPowerExponentBias - stored) << 52);
    for (int c = 0; c < 3; ++c, random >>= 21) {
        // floor(x + u) has the mean x.
        const double u = (static_cast<double>(random & 0x1fffff) + 0.5) * 0x1p-21;
        bits |= static_cast<uint32_t>(static_cast<double>(power[c]) * perUnit + u) << (8 * c);
    }
    return bits;
}

}  // namespace lsde
