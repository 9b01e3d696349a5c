// Photons for tests.
#pragma once

#include <vector>

#include "photon/kd_index.h"
#include "support/random.h"

namespace lsde::test {

// On the plane z = 0, lit from above.
inline Photon photonAt(Vec3 position, uint64_t key = 0) {
    Photon p;
    p.position = position;
    p.power = Rgb(1, 2, 3);
    p.direction = p.ng = {0, 0, 1};
    p.path.append(Event::Specular);
    p.key = key;
    return p;
}

inline PhotonTree treeOf(const std::vector<Photon>& photons) {
    std::vector<PackedPhoton> packed;
    packed.reserve(photons.size());
    for (const Photon& p : photons) packed.push_back(pack(p));
    ThreadPool pool(1);
    return buildPhotonTree(std::move(packed), pool);
}

inline PhotonTree treeOf(const std::vector<Vec3>& positions) {
    std::vector<Photon> photons;
    photons.reserve(positions.size());
    for (const Vec3 p : positions) photons.push_back(photonAt(p, photons.size()));
    return treeOf(photons);
}

// All fields random, all of them valid.
inline Photon randomPhoton(Random& random, uint64_t key) {
    Photon p;
    p.position = random.inCube() - 0.5F;
    p.power = 100.0F * random.inCube();
    p.direction = random.onSphere();
    p.ng = random.onSphere();
    p.light = static_cast<uint16_t>(random.bits() % 2);
    p.medium = static_cast<uint16_t>(random.bits() % 3);
    p.flags = static_cast<uint16_t>(random.bits() % 4);
    p.wavelength = static_cast<WavelengthId>(random.bits() % (kWavelengths + 1));
    for (uint32_t n = random.bits() % 5; n-- > 0;) p.path.append(static_cast<Event>(random.bits() % kEventCount));
    p.key = key;
    return p;
}

}  // namespace lsde::test
