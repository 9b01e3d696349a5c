// Interference in thin films against its sum over wavelengths, and against the limits that it must have.
#include "bsdf/thin_film.h"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "bsdf/fresnel.h"
#include "bsdf/metal_rough.h"

using namespace lsde;
using doctest::Approx;

namespace {

// A film on grey f0, wave by wave: Airy's sum of all reflections, with Schlick's reflectances.
struct Waves {
    double top, bottom, opd, shift;

    Waves(const ThinFilm& film, double f0, double cosI) {
        const double cosT = std::sqrt(1 - (1 - square(cosI)) / square(double{film.ior}));
        const double base = (1 + std::sqrt(f0)) / (1 - std::sqrt(f0));
        const auto schlick = [](double f, double c) { return f + (1 - f) * std::pow(1 - c, 5); };
        top = schlick(square((film.ior - 1) / (film.ior + 1)), cosI);
        bottom = schlick(square((base - film.ior) / (base + film.ior)), cosT);
        opd = 2 * double{film.ior} * double{film.thickness} * cosT;
        shift = std::numbers::pi * (base < film.ior ? 2 : 1);
    }
    double reflectance(double waveNumber) const {
        const double q = std::sqrt(top * bottom), c = std::cos(2 * std::numbers::pi * waveNumber * opd + shift);
        return (top + bottom - 2 * q * c) / (1 + top * bottom - 2 * q * c);
    }
};

struct Gaussian {
    double weight, position, variance;  // of wave numbers (1/m), as Belcour & Barla fit the CIE's observer
};

double seenBy(const Waves& waves, std::initializer_list<Gaussian> observer) {
    double sum = 0, norm = 0;
    constexpr int kSteps = 4000;
    for (int i = 0; i < kSteps; ++i) {
        const double k = 4e6 * (i + 0.5) / kSteps;
        double weight = 0;
        for (const Gaussian& g : observer) weight += g.weight * std::exp(-square(k - g.position) / (4 * g.variance));
        sum += weight * waves.reflectance(k);
        norm += weight;
    }
    return sum / norm;
}

// Of equal energy in all waves, whose white is not that of Rec. 709: the matrix is applied to what differs from the
// mean, as the text applies it to the terms of interference alone.
glm::dvec3 byWaves(const ThinFilm& film, double f0, double cosI) {
    const Waves waves(film, f0, cosI);
    const double mean = waves.top + square(1 - waves.top) * waves.bottom / (1 - waves.top * waves.bottom);
    const double x = seenBy(waves, {{5.4856, 1.6810e6, 4.3278e9}, {0.97470, 2.2399e6, 4.5282e9}}) - mean;
    const double y = seenBy(waves, {{1, 1.7953e6, 9.3046e9}}) - mean;
    const double z = seenBy(waves, {{1, 2.2084e6, 6.6121e9}}) - mean;
    return {mean + 3.2404542 * x - 1.5371385 * y - 0.4985314 * z, mean - 0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            mean + 0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

}  // namespace

TEST_CASE("a film's colour is the sum over wavelengths of all that its two faces send back") {
    for (const double f0 : {0.04, 0.3})
        for (const float ior : {1.33F, 1.8F})
            for (const float thickness : {1.5e-7F, 3e-7F, 5.5e-7F})
                for (const float cosI : {1.0F, 0.7F, 0.3F}) {
                    const ThinFilm film{1, ior, thickness};
                    const Rgb found = thinFilmReflectance(film, Rgb(static_cast<float>(f0)), cosI);
                    const glm::dvec3 expected = glm::clamp(byWaves(film, f0, cosI), 0.0, 1.0);
                    CAPTURE(f0);
                    CAPTURE(ior);
                    CAPTURE(thickness);
                    CAPTURE(cosI);
                    // The third order is left out.
                    const Waves waves(film, f0, cosI);
                    const double third = 2 * std::pow(waves.top * waves.bottom, 1.5);
                    for (int c = 0; c < 3; ++c) CHECK(std::fabs(found[c] - expected[c]) < third + 2e-3);
                }
}

TEST_CASE("a film of no thickness is not there, and a thick one has no colour") {
    // Towards the horizon the text's two Schlick terms add, though one of them is of no interface.
    CHECK(thinFilmReflectance({1, 1.5F, 0}, Rgb(0.04F), 1).x == Approx(0.04).epsilon(1e-2));
    for (const float cosI : {1.0F, 0.5F, 0.1F}) {
        const Rgb thick = thinFilmReflectance({1, 1.5F, 1e-4F}, Rgb(0.2F), cosI);
        CHECK(thick.x == Approx(thick.z).epsilon(1e-4));
    }
}

TEST_CASE("films reflect between nothing and all, whatever they are of and on") {
    for (const float ior : {1.0F, 1.3F, 2.5F, 0.8F})
        for (const float f0 : {0.0F, 0.04F, 0.9F, 1.0F})
            for (const float thickness : {0.0F, 1e-8F, 2e-7F, 9e-7F, 1.0F})
                for (const float cosI : {0.0F, 1e-4F, 0.5F, 1.0F}) {
                    const Rgb r = thinFilmReflectance({1, ior, thickness}, Rgb(f0, f0, 0.5F), cosI);
                    REQUIRE(isFinite(r));
                    CHECK(std::min({r.x, r.y, r.z}) >= 0);
                    CHECK(maxComponent(r) <= 1);
                }
}

TEST_CASE("the factor mixes the film's reflectance with that of the bare surface, for metal and coat alike") {
    const ThinFilm film{1, 1.4F, 4e-7F};
    const Rgb gold(1, 0.77F, 0.34F);
    MetalRoughBsdf metal{.baseColor = gold, .roughness = 0, .film = film};
    const Vec3 wo(0.6F, 0, 0.8F);
    const Rgb whole = metal.reflect(wo).weight;
    CHECK(whole == thinFilmReflectance(film, gold, 0.8F));
    metal.film.factor = 0.25F;
    const Rgb bare = fresnelSchlick(gold, 0.8F);
    for (int c = 0; c < 3; ++c) CHECK(metal.reflect(wo).weight[c] == Approx(0.75 * bare[c] + 0.25 * whole[c]));
    const MetalRoughBsdf plastic{.metallic = 0, .roughness = 0, .film = film};
    CHECK(plastic.reflect(wo).weight.x == Approx(thinFilmReflectance(film, Rgb(0.04F), 0.8F).x));
}
