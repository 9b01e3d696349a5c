#include "passes/time_balance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/math.h"

namespace lsde {

namespace {

constexpr int kTiles = 6;  // along each side of the film
constexpr double kSamples = 4;

double filmPixels(const Camera& c) { return static_cast<double>(c.filmWidth()) * c.filmHeight(); }

// Pixels [first, second) of a film's side: the middle of its part number `tile`, at least one.
std::array<int, 2> middleOf(int begin, int size, int tile, double share) {
    const double part = static_cast<double>(size) / kTiles, middle = begin + (tile + 0.5) * part;
    const int lo = std::clamp(static_cast<int>(middle - 0.5 * share * part), begin, begin + size - 1);
    return {lo, std::clamp(static_cast<int>(middle + 0.5 * share * part), lo + 1, begin + size)};
}

}  // namespace

FirstLook lookAtTiles(const Camera& camera, double share, const MakeIntegrator& make, const Clock& clock,
                      RunContext& run) {
    FirstLook look{0, kSamples, {}};
    double pixels = 0;
    for (int tile = 0; tile < kTiles * kTiles; ++tile) {
        const auto [x0, x1] = middleOf(camera.filmX(), camera.filmWidth(), tile % kTiles, std::sqrt(share));
        const auto [y0, y1] = middleOf(camera.filmY(), camera.filmHeight(), tile / kTiles, std::sqrt(share));
        Camera part = camera;
        part.crop(x0, y0, x1, y1);
        const auto integrator = make(part);
        integrator->render(0, 1, run);  // finds out about the light
        const double start = clock.used();
        integrator->render(1, kSamples, run);
        look.sampleSeconds += (clock.used() - start) / (kSamples - 1);
        const auto error = integrator->error(kSamples).value().relativeTo(integrator->develop(0, kSamples));
        look.error.camera += error.camera * filmPixels(part);
        look.error.photons += error.photons * filmPixels(part);
        pixels += filmPixels(part);
    }
    look.sampleSeconds *= filmPixels(camera) / pixels;
    look.error.camera /= pixels;
    look.error.photons /= pixels;
    return look;
}

double photonSeconds(const FirstLook& look, double firstSeconds, double seconds) {
    constexpr double kLeast = 0.2, kMost = 0.75, kStep = 0.01;
    constexpr double kPhotonsWeigh = 5;
    double best = kLeast, least = kInfinity;
    for (double share = kLeast; share <= kMost; share += kStep) {
        const double photons = std::pow(firstSeconds / (share * seconds), 2.0 / 3);
        const double samples = (1 - share) * seconds / look.sampleSeconds;
        const double error =
            kPhotonsWeigh * look.error.photons * photons + look.error.camera * square(look.samples / samples);
        if (error < least) {
            least = error;
            best = share;
        }
    }
    return best * seconds;
}

}  // namespace lsde
