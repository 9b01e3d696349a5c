// Sums over the power of photons, and the density estimates that they make.
#pragma once

#include <array>

#include "photon/photon.h"

namespace lsde {

// Moments of the power of photons.
struct Moments {
    double p = 0, pd2 = 0;              // sums of power, times distance^2
    double pp = 0, ppd2 = 0, ppd4 = 0;  // of power^2, times distance^2 and ^4
    Vec3 moment{0};                     // sum of power times offset from the middle

    // squares: of the power of each photon, if there are several.
    void add(double power, double squares, Vec3 offset, double d2) {
        moment += static_cast<float>(power) * offset;
        p += power;
        pd2 += power * d2;
        pp += squares;
        ppd2 += squares * d2;
        ppd4 += squares * d2 * d2;
    }
    void add(const Moments& r) {
        p += r.p;
        pd2 += r.pd2;
        pp += r.pp;
        ppd2 += r.ppd2;
        ppd4 += r.ppd4;
        moment += r.moment;
    }
};

// What the power of a photon is judged by: the sum of its channels, or each of them.
template <size_t kSignals>
std::array<float, kSignals> signalsOf(const PhotonPayload& p) {
    if constexpr (kSignals == 1) {
        const Rgb power = unpackPower(p.power);
        return {power.x + power.y + power.z};
    } else {
        const Rgb power = rgbPower(p);
        return {power.x, power.y, power.z};
    }
}

struct Estimate {
    double value = 0, variance = 0;
};

// By Epanechnikov's kernel, up to a factor that all radii share.
inline Estimate estimateOf(const Moments& within, double r2, double share) {
    const double scale = 1 / (r2 * share);
    return {scale * (within.p - within.pd2 / r2),
            scale * scale * (within.pp - 2 * within.ppd2 / r2 + within.ppd4 / (r2 * r2))};
}

}  // namespace lsde
