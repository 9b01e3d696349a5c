#include "scene/sky.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/color.h"
#include "base/error.h"
#include "sampling/cie.h"

namespace lsde {

namespace {

constexpr double kPiD = std::numbers::pi;
constexpr double kDegreeD = kPiD / 180;
constexpr float kSunRadius = 0.265F * kPi / 180;
// The sky is smooth: interpolation between texels of a third of a degree is within 1e-3 of it, but for the horizon.
constexpr int kRows = 512;

// Linear Rec. 709; beyond its border the least channel is 0.
Rgb fromXyz(glm::dvec3 xyz) { return Rgb(glm::max(rec709FromXyz(xyz), 0.0)); }

// ------------------------------------------------------------------------------------------------------------ the sky

// Perez' distribution of one of luminance and chromaticities, relative (Preetham et al., appendix A.2).
struct Perez {
    double a, b, c, d, e;

    double operator()(double cosTheta, double gamma) const {
        return (1 + a * std::exp(b / cosTheta)) * (1 + c * std::exp(d * gamma) + e * square(std::cos(gamma)));
    }
};

struct SkyModel {
    Perez luminance, x, y;
    glm::dvec3 zenith;  // luminance in nits, chromaticities x and y
    glm::dvec3 toSun;
    double sunTheta;

    explicit SkyModel(const SkySettings& s)
        : luminance(perezLuminance(s.turbidity)),
          x(perezX(s.turbidity)),
          y(perezY(s.turbidity)),
          toSun(sunDirection(s)),
          sunTheta((90 - static_cast<double>(s.sunElevationDeg)) * kDegreeD) {
        zenith = zenithOf(s.turbidity, sunTheta);
    }

    static Perez perezLuminance(double t) {
        return {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                -0.0670 * t + 0.3703};
    }
    static Perez perezX(double t) {
        return {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
                -0.0033 * t + 0.0452};
    }
    static Perez perezY(double t) {
        return {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
                -0.0109 * t + 0.0529};
    }

    static glm::dvec3 zenithOf(double t, double theta) {
        const double chi = (4.0 / 9 - t / 120) * (kPiD - 2 * theta);
        const double kilonits = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
        const auto cubic = [&](double c3, double c2, double c1, double c0) {
            return ((c3 * theta + c2) * theta + c1) * theta + c0;
        };
        const double x = (cubic(0.00166, -0.00375, 0.00209, 0) * t + cubic(-0.02903, 0.06377, -0.03202, 0.00394)) * t +
                         cubic(0.11693, -0.21196, 0.06052, 0.25886);
        const double y = (cubic(0.00275, -0.00610, 0.00317, 0) * t + cubic(-0.04214, 0.08970, -0.04153, 0.00516)) * t +
                         cubic(0.15346, -0.26756, 0.06670, 0.26688);
        return {1000 * kilonits, x, y};
    }

    Rgb radiance(Vec3 direction) const {
        const double cosTheta = std::max(static_cast<double>(direction.y), 1e-6);
        const double gamma = std::acos(std::clamp(glm::dot(glm::dvec3(direction), toSun), -1.0, 1.0));
        const auto relative = [&](const Perez& p) { return p(cosTheta, gamma) / p(1, sunTheta); };
        const double nits = zenith.x * relative(luminance);
        const double cx = zenith.y * relative(x), cy = zenith.z * relative(y);
        return fromXyz({nits * cx / cy, nits, nits * (1 - cx - cy) / cy});
    }
};

// Lux on a horizontal surface, by the midpoint rule.
Rgb skyIrradiance(const SkyModel& model) {
    constexpr int kHeights = 64, kAzimuths = 128;
    glm::dvec3 sum(0);
    for (int i = 0; i < kHeights; ++i)
        for (int k = 0; k < kAzimuths; ++k) {
            // Even in the square of the sine of the elevation: each direction counts by its cosine.
            const double y = std::sqrt((i + 0.5) / kHeights), r = std::sqrt(1 - y * y);
            const double azimuth = 2 * kPiD * (k + 0.5) / kAzimuths;
            sum += model.radiance(Vec3(glm::dvec3(r * std::sin(azimuth), y, r * std::cos(azimuth))));
        }
    return Rgb(sum * (kPiD / (kHeights * kAzimuths)));
}

// ------------------------------------------------------------------------------------------------------------ the sun

// From 380 to 750 nm: the disc's mean radiance before the air in 100 W/(m2 nm sr), and the absorption of ozone in 1/cm
// (Preetham et al., table 2). Water vapour and mixed gases absorb beyond 690 nm, where hardly anything is seen.
constexpr int kFirstNm = 380, kStepNm = 10;
constexpr std::array<double, 38> kSunSpectrum{165.5, 162.3, 211.2, 258.8, 258.2, 242.3, 267.6, 296.6, 305.4, 300.6,
                                              306.6, 288.3, 287.1, 278.2, 271.0, 272.3, 263.6, 255.0, 250.6, 253.1,
                                              253.5, 251.3, 246.3, 241.7, 236.8, 232.1, 228.2, 223.4, 219.7, 215.3,
                                              211.0, 207.3, 202.4, 198.7, 194.3, 190.7, 186.3, 182.6};
constexpr std::array<double, 38> kOzone{0.001, 0.001, 0.002, 0.002, 0.002, 0.003, 0.003, 0.003, 0.006, 0.009,
                                        0.014, 0.021, 0.030, 0.040, 0.048, 0.063, 0.075, 0.085, 0.103, 0.120,
                                        0.120, 0.115, 0.125, 0.120, 0.105, 0.090, 0.079, 0.067, 0.057, 0.048,
                                        0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009};

// Share of light that comes through the air (Preetham et al., appendix A.1).
double transmittance(double nm, double ozone, double turbidity, double airMass) {
    constexpr double kOzoneCm = 0.35, kAerosolExponent = 1.3;
    const double um = nm / 1000, aerosols = 0.04608 * turbidity - 0.04586;
    return std::exp(-airMass *
                    (0.008735 * std::pow(um, -4.08) + aerosols * std::pow(um, -kAerosolExponent) + ozone * kOzoneCm));
}

// ----------------------------------------------------------------------------------------------------- what is made

void check(const char* what, float value, float least, float most) {
    if (!(value >= least && value <= most))
        throw Error(fmt::format("sky: {} {}, expected {} to {}", what, value, least, most));
}

void check(const SkySettings& s) {
    check("sun elevation", s.sunElevationDeg, 0, 90);
    check("sun azimuth", s.sunAzimuthDeg, -360, 360);
    check("turbidity", s.turbidity, 2, 10);
    check("ground albedo", s.groundAlbedo, 0, 1);
}

}  // namespace

Vec3 sunDirection(const SkySettings& s) {
    const double elevation = s.sunElevationDeg * kDegreeD, azimuth = s.sunAzimuthDeg * kDegreeD;
    return glm::normalize(glm::dvec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                     std::cos(elevation) * std::cos(azimuth)));
}

Rgb skyRadiance(const SkySettings& settings, Vec3 direction) { return SkyModel(settings).radiance(direction); }

Rgb sunRadiance(const SkySettings& s) {
    constexpr double kLumensPerWatt = 683;
    const double elevation = s.sunElevationDeg;
    // Kasten's optical air mass (1966).
    const double airMass = 1 / (std::sin(elevation * kDegreeD) + 0.15 * std::pow(3.885 + elevation, -1.253));
    glm::dvec3 xyz(0);
    for (size_t i = 0; i < kSunSpectrum.size(); ++i) {
        const double nm = kFirstNm + kStepNm * static_cast<double>(i);
        xyz += cieObserver(nm) * (100 * kSunSpectrum[i] * transmittance(nm, kOzone[i], s.turbidity, airMass));
    }
    return fromXyz(xyz * (kLumensPerWatt * kStepNm));
}

Rgb openIrradiance(const SkySettings& settings) {
    const float solidAngle = 4 * kPi * square(std::sin(0.5F * kSunRadius));
    return skyIrradiance(SkyModel(settings)) + sunRadiance(settings) * (solidAngle * sunDirection(settings).y);
}

Sky makeSky(const SkySettings& settings) {
    check(settings);
    const SkyModel model(settings);
    Sky out;
    out.sun = {"sun", sunDirection(settings), kSunRadius, sunRadiance(settings)};
    out.sky.name = "sky";
    out.sky.image = RgbImage(2 * kRows, kRows, openIrradiance(settings) * (settings.groundAlbedo * kInvPi));
    // The picture's centre is +Z (scene/environment_map.h).
    for (int y = 0; y < kRows / 2; ++y)
        for (int x = 0; x < 2 * kRows; ++x) {
            const double theta = kPiD * (y + 0.5) / kRows, azimuth = 2 * kPiD * (0.5 - (x + 0.5) / (2 * kRows));
            out.sky.image.at(x, y) = model.radiance(Vec3(
                glm::dvec3(std::sin(theta) * std::sin(azimuth), std::cos(theta), std::sin(theta) * std::cos(azimuth))));
        }
    return out;
}

}  // namespace lsde
