// Steps along a path of which a test knows what should happen.
#pragma once

#include <doctest/doctest.h>

#include <optional>

#include "bsdf/bsdf.h"
#include "support/random.h"
#include "transport/walk.h"

namespace lsde::test {

// A path that starts at `origin`, within whatever solids are there.
inline PathState startAt(const Scene& scene, Vec3 origin, Vec3 direction) {
    return {{origin, glm::normalize(direction), kInfinity}, scene.mediaAt(origin), Rgb(1)};
}

// The delta lobe that reflects, or the one that lets light through; none under total reflection.
inline std::optional<BsdfSample> deltaLobe(const Vertex& v, bool transmitted) {
    const DeltaLobes lobes = deltaLobes(v.bsdf, v.wo);
    for (int i = 0; i < lobes.count; ++i)
        if (lobes.lobe[static_cast<size_t>(i)].transmitted == transmitted) return lobes.lobe[static_cast<size_t>(i)];
    return std::nullopt;
}

// On to the next surface and through it.
inline Vertex pass(const Scene& scene, PathState& path, Quantity quantity = Quantity::Radiance) {
    WalkScratch scratch;
    Vertex v;
    REQUIRE(advance(scene, path, v, scratch));
    const auto lobe = deltaLobe(v, true);
    REQUIRE(lobe.has_value());
    REQUIRE(scatter(v, *lobe, quantity, path));
    return v;
}

inline bool escapes(const Scene& scene, PathState path) {
    WalkScratch scratch;
    Vertex v;
    return !advance(scene, path, v, scratch);
}

inline Vec3 onSphere(Random& random) {
    const float z = 2 * random.uniform() - 1, r = safeSqrt(1 - z * z), phi = 2 * kPi * random.uniform();
    return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace lsde::test
