// One photon: what it is, and how it is packed for disk and memory.
#pragma once

#include <bit>
#include <cstdint>

#include "base/math.h"
#include "path/path_code.h"
#include "photon/octahedral.h"
#include "sampling/wavelength.h"

namespace lsde {

// A photon as emission makes it.
struct Photon {
    Vec3 position{0};     // m
    Rgb power{0};         // W of one path: divide by the number of paths emitted at the gather; before the weight of
                          // its wavelength, so that no channel is negative
    Vec3 direction{0};    // unit, points back to where the light came from (wi of the surface)
    Vec3 ng{0};           // geometric normal of the surface hit, unit, on the mesh's front side
    uint16_t light = 0;   // index of the source
    uint16_t medium = 0;  // medium in which it landed (0: none, the outside)
    uint16_t flags = 0;   // PhotonFlag
    WavelengthId wavelength = kAllWavelengths;  // if it was dispersed
    PathCode path;                              // events after L and before the surface it landed on
    uint64_t key = 0;  // a number of this photon alone (path index and bounce), for unbiased rounding; not stored
};

enum PhotonFlag : uint16_t {
    kFromDeltaLight = 1,  // point, spot or directional: a Glossy vertex may gather it (path/ownership.h)
    kGlossyGather = 2,    // L B+ only: causticAtGlossy
    kLandedOnFront = 4,   // direction is on the side of the normal; set by pack()
};
// Known to this version; a record with others was not made by it.
inline constexpr uint16_t kAllPhotonFlags = kFromDeltaLight | kGlossyGather | kLandedOnFront;

// Everything but the position: 24 bytes.
struct PhotonPayload {
    uint64_t path = 0;
    uint32_t power = 0;      // shared exponent and three mantissas, rounded without bias by a hash of the photon's key
    uint32_t direction = 0;  // octahedral, 16 + 16 bits
    uint16_t normal = 0;     // octahedral, 8 + 8 bits
    uint16_t light = 0;
    uint16_t medium = 0;
    uint16_t flags : 4 = 0;
    uint16_t wavelength : 12 = kAllWavelengths;
};
static_assert(sizeof(PhotonPayload) == 24);
static_assert(kAllPhotonFlags < 1 << 4 && kWavelengths < 1 << 12);

// A photon on its way into a tree. Totally ordered by value (operator<), so that a tree depends on the set alone.
struct PackedPhoton {
    Vec3 position{0};
    PhotonPayload payload;
};
static_assert(sizeof(PackedPhoton) == 40);
bool operator<(const PackedPhoton& a, const PackedPhoton& b);

// Throws Error if power, direction or normal is not finite, power negative, or direction or normal zero.
PackedPhoton pack(const Photon& photon);

// Power in 32 bits: mantissas of 8 bits under an exponent of 8 (Ward 1991, "Real Pixels"), each mantissa rounded up or
// down by a hash of key with such chances that the expected value is exact. A finer mantissa would leave 5 bits of
// exponent, too few: a photon carries the power of a whole path, from a candle's to that of the sun on a square
// kilometre.
uint32_t packPower(Rgb power, uint64_t key);

inline constexpr int kPowerExponentBias = 136;  // mantissas are in units of 2^(exponent - bias)
inline constexpr int kLeastPowerExponent = 10;  // units are normal floats

inline Rgb unpackPower(uint32_t rgbe) {
    const auto exponent = static_cast<int>(rgbe >> 24);
    if (exponent < kLeastPowerExponent) return Rgb(0);
    const auto unit = std::bit_cast<float>(static_cast<uint32_t>(exponent - kPowerExponentBias + 127) << 23);
    return unit * Rgb(rgbe & 255, rgbe >> 8 & 255, rgbe >> 16 & 255);
}

// Of a stored photon in the picture's channels, which of a single wavelength may be negative.
inline Rgb rgbPower(const PhotonPayload& p) { return weighed(unpackPower(p.power), p.wavelength); }

inline uint32_t packDirection(Vec3 unit) { return Octahedral<16>::pack(unit); }
inline Vec3 unpackDirection(uint32_t octahedral) { return Octahedral<16>::unpack(octahedral); }
inline uint16_t packNormal(Vec3 unit) { return static_cast<uint16_t>(Octahedral<8>::pack(unit)); }
inline Vec3 unpackNormal(uint16_t octahedral) { return Octahedral<8>::unpack(octahedral); }

// The geometric normal, to the side on which the photon landed.
inline Vec3 landedSide(const PhotonPayload& p) {
    const Vec3 ng = unpackNormal(p.normal);
    return (p.flags & kLandedOnFront) != 0 ? ng : -ng;
}

}  // namespace lsde
