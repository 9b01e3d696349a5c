#include "compare/flip.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numeric>
#include <vector>

#include "base/math.h"

namespace lsde {

namespace {

using Color = glm::dvec3;
using Kernel = std::vector<double>;

constexpr double kDoublePi = 3.14159265358979323846;

// Parameters of the 2020 paper, with its symbols.
constexpr double kColorExponent = 0.7;      // q_c
constexpr double kColorKnee = 0.4;          // p_c, share of the largest colour difference
constexpr double kErrorAtKnee = 0.95;       // p_t
constexpr double kFeatureWidthDeg = 0.082;  // w

// One term a sqrt(pi/b) exp(-pi^2 x^2 / b), x in degrees, of a contrast sensitivity function (2020, table 1).
struct SensitivityTerm {
    double a, b;
};
constexpr SensitivityTerm kAchromatic{1, 0.0047};
constexpr SensitivityTerm kRedGreen{1, 0.0053};
constexpr SensitivityTerm kBlueYellow[2] = {{34.1, 0.04}, {13.5, 0.025}};

// ---- colour spaces -------------------------------------------------------------------------------------------------

// Linear Rec. 709 to CIE XYZ, white D65; columns R, G, B. To the digits that FLIP's authors use, so that figures agree.
const glm::dmat3 kXyzFromRgb(10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382,  //
                             8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382,   //
                             4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382);
const glm::dmat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const Color kWhite = kXyzFromRgb * Color(1);

// The linear opponent space in which the eye's contrast sensitivity is known (achromatic, red-green, blue-yellow).
Color yCxCzFromRgb(Color rgb) {
    const Color xyz = kXyzFromRgb * rgb / kWhite;
    return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

Color rgbFromYCxCz(Color c) {
    const double y = (c.x + 16) / 116;
    return kRgbFromXyz * (Color(y + c.y / 500, y, y - c.z / 200) * kWhite);
}

double labCurve(double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

// CIE L*a*b* with the Hunt effect: chroma loses colourfulness with lightness (2020, section 4.1.2).
Color huntLabFromRgb(Color rgb) {
    const Color xyz = kXyzFromRgb * rgb / kWhite;
    const Color f(labCurve(xyz.x), labCurve(xyz.y), labCurve(xyz.z));
    const double lightness = 116 * f.y - 16;
    return {lightness, 0.01 * lightness * 500 * (f.x - f.y), 0.01 * lightness * 200 * (f.y - f.z)};
}

// HyAB (Abasi et al. 2020): city block in lightness, Euclidean in chroma.
double hyab(Color a, Color b) { return std::abs(a.x - b.x) + std::sqrt(square(a.y - b.y) + square(a.z - b.z)); }

// ---- kernels -------------------------------------------------------------------------------------------------------

Kernel sampled(const SensitivityTerm& term, double pixelsPerDegree, int radius) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x)
        kernel.push_back(std::exp(-square(kDoublePi * x / pixelsPerDegree) / term.b));
    return kernel;
}

double sum(const Kernel& kernel) { return std::accumulate(kernel.begin(), kernel.end(), 0.0); }

void scale(Kernel& kernel, double factor) {
    for (double& weight : kernel) weight *= factor;
}

// What the eye resolves, as filters: one for each of the first two channels, and two whose results add for the third,
// as a sum of two Gaussians is not separable by itself.
struct SensitivityKernels {
    Kernel achromatic, redGreen;
    Kernel blueYellow[2];

    explicit SensitivityKernels(double pixelsPerDegree) {
        // Three standard deviations of the widest term.
        const double widest = std::sqrt(kBlueYellow[0].b / 2) / kDoublePi;
        const int radius = static_cast<int>(std::ceil(3 * widest * pixelsPerDegree));
        achromatic = sampled(kAchromatic, pixelsPerDegree, radius);
        redGreen = sampled(kRedGreen, pixelsPerDegree, radius);
        scale(achromatic, 1 / sum(achromatic));
        scale(redGreen, 1 / sum(redGreen));
        double total = 0;  // of both two-dimensional filters, each the square of a row
        for (int i = 0; i < 2; ++i) {
            const SensitivityTerm& term = kBlueYellow[i];
            blueYellow[i] = sampled(term, pixelsPerDegree, radius);
            scale(blueYellow[i], std::sqrt(term.a * std::sqrt(kDoublePi / term.b)));
            total += square(sum(blueYellow[i]));
        }
        for (Kernel& kernel : blueYellow) scale(kernel, 1 / std::sqrt(total));
    }
};

// Scaled so that the positive weights sum to 1 and the negative ones to -1.
void normalizeSigned(Kernel& kernel) {
    double positive = 0;
    double negative = 0;
    for (const double weight : kernel) (weight > 0 ? positive : negative) += weight;
    for (double& weight : kernel) weight /= weight > 0 ? positive : -negative;
}

// A Gaussian and its derivatives: detectors of edges and points (2020, section 4.2).
struct FeatureKernels {
    Kernel gaussian, first, second;

    explicit FeatureKernels(double pixelsPerDegree) {
        const double sigma = kFeatureWidthDeg * pixelsPerDegree / 2;
        const int radius = static_cast<int>(std::ceil(3 * sigma));
        gaussian = gaussianKernel(sigma, radius);
        for (size_t i = 0; i < gaussian.size(); ++i) {
            const double x = static_cast<double>(i) - radius;
            first.push_back(-x * gaussian[i]);
            second.push_back((x * x / (sigma * sigma) - 1) * gaussian[i]);
        }
        normalizeSigned(first);
        normalizeSigned(second);
    }
};

struct Kernels {
    SensitivityKernels sensitivity;
    FeatureKernels features;
    explicit Kernels(double pixelsPerDegree) : sensitivity(pixelsPerDegree), features(pixelsPerDegree) {}
};

// ---- appearance ----------------------------------------------------------------------------------------------------

struct Planes3 {
    Plane x, y, z;
    Planes3(int width, int height) : x(width, height), y(width, height), z(width, height) {}
};

// A picture as seen from a distance.
struct Appearance {
    Planes3 huntLab;
    Plane edges, points;
};

// The opponent colours of the picture as the screen shows it; toScreen gives linear RGB in [0,1].
template <typename ToScreen>
Planes3 opponentColors(const RgbImage& image, const ToScreen& toScreen, ThreadPool& pool) {
    Planes3 out(image.width, image.height);
    forEachRow(image.height, pool, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            const Color c = yCxCzFromRgb(toScreen(Color(image.at(x, y))));
            const auto i = static_cast<size_t>(x);
            out.x.row(y)[i] = c.x;
            out.y.row(y)[i] = c.y;
            out.z.row(y)[i] = c.z;
        }
    });
    return out;
}

Plane blur(const Plane& plane, const Kernel& kernel, ThreadPool& pool) {
    return filterColumns(filterRows(plane, kernel, pool), kernel, pool);
}

Planes3 perceivedColors(const Planes3& opponent, const SensitivityKernels& kernels, ThreadPool& pool) {
    const Plane achromatic = blur(opponent.x, kernels.achromatic, pool);
    const Plane redGreen = blur(opponent.y, kernels.redGreen, pool);
    const Plane blueYellow1 = blur(opponent.z, kernels.blueYellow[0], pool);
    const Plane blueYellow2 = blur(opponent.z, kernels.blueYellow[1], pool);
    Planes3 out(achromatic.width, achromatic.height);
    forEachRow(achromatic.height, pool, [&](int y) {
        for (size_t x = 0; x < static_cast<size_t>(achromatic.width); ++x) {
            const Color filtered(achromatic.row(y)[x], redGreen.row(y)[x],
                                 blueYellow1.row(y)[x] + blueYellow2.row(y)[x]);
            const Color lab = huntLabFromRgb(glm::clamp(rgbFromYCxCz(filtered), 0.0, 1.0));
            out.x.row(y)[x] = lab.x;
            out.y.row(y)[x] = lab.y;
            out.z.row(y)[x] = lab.z;
        }
    });
    return out;
}

// Length of the vector of the derivatives along x and y, where `derivative` is a kernel.
Plane derivativeNorm(const Plane& plane, const Plane& blurredRows, const Kernel& gaussian, const Kernel& derivative,
                     ThreadPool& pool) {
    Plane out = filterColumns(filterRows(plane, derivative, pool), gaussian, pool);
    const Plane alongY = filterColumns(blurredRows, derivative, pool);
    for (size_t i = 0; i < out.values.size(); ++i)
        out.values[i] = std::sqrt(square(out.values[i]) + square(alongY.values[i]));
    return out;
}

template <typename ToScreen>
Appearance perceive(const RgbImage& image, const ToScreen& toScreen, const Kernels& kernels, ThreadPool& pool) {
    const Planes3 opponent = opponentColors(image, toScreen, pool);
    Plane gray = opponent.x;
    for (double& value : gray.values) value = (value + 16) / 116;
    const FeatureKernels& f = kernels.features;
    const Plane blurredRows = filterRows(gray, f.gaussian, pool);
    return {perceivedColors(opponent, kernels.sensitivity, pool),
            derivativeNorm(gray, blurredRows, f.gaussian, f.first, pool),
            derivativeNorm(gray, blurredRows, f.gaussian, f.second, pool)};
}

// ---- difference ----------------------------------------------------------------------------------------------------

// Of the colours furthest apart in HyAB within the gamut: green and blue.
const double kLargestColorDifference =
    std::pow(hyab(huntLabFromRgb(Color(0, 1, 0)), huntLabFromRgb(Color(0, 0, 1))), kColorExponent);

// Maps [0, knee] to [0, kErrorAtKnee] and the few larger differences to the rest (2020, section 4.1.3).
double colorError(Color a, Color b) {
    const double difference = std::pow(hyab(a, b), kColorExponent);
    const double knee = kColorKnee * kLargestColorDifference;
    if (difference < knee) return difference * kErrorAtKnee / knee;
    return kErrorAtKnee + (difference - knee) / (kLargestColorDifference - knee) * (1 - kErrorAtKnee);
}

Plane difference(const Appearance& a, const Appearance& b, ThreadPool& pool) {
    Plane out(a.edges.width, a.edges.height);
    const auto colorAt = [](const Appearance& p, int y, size_t x) {
        return Color(p.huntLab.x.row(y)[x], p.huntLab.y.row(y)[x], p.huntLab.z.row(y)[x]);
    };
    forEachRow(out.height, pool, [&](int y) {
        for (size_t x = 0; x < static_cast<size_t>(out.width); ++x) {
            const double edge = std::abs(a.edges.row(y)[x] - b.edges.row(y)[x]);
            const double point = std::abs(a.points.row(y)[x] - b.points.row(y)[x]);
            const double feature = std::sqrt(std::max(edge, point) / std::sqrt(2.0));  // q_f = 1/2
            out.row(y)[x] = std::pow(colorError(colorAt(a, y, x), colorAt(b, y, x)), 1 - feature);
        }
    });
    return out;
}

template <typename ToScreen>
Plane flip(const RgbImage& image, const RgbImage& reference, const ToScreen& toScreen, const Kernels& kernels,
           ThreadPool& pool) {
    return difference(perceive(image, toScreen, kernels, pool), perceive(reference, toScreen, kernels, pool), pool);
}

// ---- exposures -----------------------------------------------------------------------------------------------------

// Narkowicz' fit of the ACES curve, x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), without its pre-exposure of 0.6.
constexpr double kPreExposure = 0.6;

double acesCurve(double value) {
    const double x = kPreExposure * value;
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

// Where the curve reaches 0.85, the value that counts as the beginning of saturation.
double saturationStart() {
    constexpr double t = 0.85;
    constexpr double a = 2.51 - t * 2.43;
    constexpr double b = 0.03 - t * 0.59;
    constexpr double c = -t * 0.14;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / kPreExposure;
}

float upperMedian(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

Plane ldrFlip(const RgbImage& image, const RgbImage& reference, ThreadPool& pool, double pixelsPerDegree) {
    const auto clamped = [](Color c) { return glm::clamp(c, 0.0, 1.0); };
    return flip(image, reference, clamped, Kernels(pixelsPerDegree), pool);
}

ExposureRange flipExposures(const RgbImage& reference) {
    std::vector<float> luminances(reference.pixels.size());
    std::transform(reference.pixels.begin(), reference.pixels.end(), luminances.begin(),
                   [](const Rgb& pixel) { return luminance(glm::max(pixel, Rgb(0))); });
    float median = upperMedian(luminances);
    if (median == 0) {
        std::erase(luminances, 0.0F);
        if (luminances.empty()) return {};
        median = upperMedian(luminances);
    }
    const float maximum = *std::max_element(luminances.begin(), luminances.end());
    ExposureRange range;
    range.start = std::log2(saturationStart() / maximum);
    range.stop = std::log2(saturationStart() / median);
    range.count = std::max(2, static_cast<int>(std::ceil(range.stop - range.start)));
    return range;
}

Plane hdrFlip(const RgbImage& image, const RgbImage& reference, const ExposureRange& exposures, ThreadPool& pool,
              double pixelsPerDegree) {
    const Kernels kernels(pixelsPerDegree);
    Plane largest(image.width, image.height);
    for (int i = 0; i < exposures.count; ++i) {
        const double stops = std::lerp(exposures.start, exposures.stop, static_cast<double>(i) / (exposures.count - 1));
        const double factor = std::exp2(stops);
        const auto toneMapped = [factor](Color c) {
            c = glm::max(c, 0.0) * factor;
            return glm::clamp(Color(acesCurve(c.x), acesCurve(c.y), acesCurve(c.z)), 0.0, 1.0);
        };
        const Plane errors = flip(image, reference, toneMapped, kernels, pool);
        for (size_t p = 0; p < largest.values.size(); ++p)
            largest.values[p] = std::max(largest.values[p], errors.values[p]);
    }
    return largest;
}

}  // namespace lsde
