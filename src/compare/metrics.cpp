#include "compare/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/json.h"
#include "compare/pixel_error.h"
#include "compare/ssim.h"
#include "image/png.h"

namespace lsde {

namespace {

// The formulas' numbers are those of pixel_error.h, ssim.h and flip.h; a test compares them.
constexpr Metric kMetrics[] = {
    {"mse", "MSE", "mean of (I-R)^2 over pixels and channels", false, &Figures::mse},
    {"relmse", "relMSE", "mean of (I-R)^2/(R^2+0.01) over pixels and channels", false, &Figures::relMse},
    {"trimmed", "trimmed relMSE", "relMSE without the worst 0.1% of the pixels", false, &Figures::trimmedRelMse},
    {"smape", "SMAPE", "mean of |I-R|/(|I|+|R|+0.01) over pixels and channels", false, &Figures::smape},
    {"psnr", "PSNR", "10 log10(1/MSE) dB as displayed (sRGB curve, clamped to [0,1]); the peak is 1", true,
     &Figures::psnr},
    {"ssim", "SSIM",
     "Wang et al. 2004 on luminance as displayed (sRGB curve, clamped to [0,1]); Gaussian window 11x11, sigma 1.5",
     true, &Figures::ssim},
    {"flip", "FLIP", "mean LDR-FLIP (Andersson et al. 2020), clamped to [0,1], 67 pixels per degree", false,
     &Figures::flip},
    {"hdrflip", "HDR-FLIP", "mean HDR-FLIP (Andersson et al. 2021), ACES curve, 67 pixels per degree", false,
     &Figures::hdrFlip},
};

struct FinitePicture {
    RgbImage image;
    PictureFigures figures;
};

FinitePicture withoutNotFinite(const RgbImage& image) {
    FinitePicture out{image, {}};
    for (Rgb& pixel : out.image.pixels) {
        if (!isFinite(pixel)) ++out.figures.notFinite;
        for (int c = 0; c < 3; ++c) {
            if (!std::isfinite(pixel[c])) pixel[c] = 0;
            out.figures.mean[static_cast<size_t>(c)] += pixel[c];
        }
    }
    for (double& sum : out.figures.mean) sum /= static_cast<double>(image.pixels.size());
    return out;
}

float displayed(float linear) { return srgbFromLinear(std::clamp(linear, 0.0F, 1.0F)); }

RgbImage displayedPicture(RgbImage image) {
    for (Rgb& pixel : image.pixels) pixel = Rgb(displayed(pixel.x), displayed(pixel.y), displayed(pixel.z));
    return image;
}

Plane displayedLuminance(const RgbImage& image) {
    Plane out(image.width, image.height);
    std::transform(image.pixels.begin(), image.pixels.end(), out.values.begin(),
                   [](const Rgb& pixel) { return displayed(luminance(pixel)); });
    return out;
}

void checkSizes(const RgbImage& image, const RgbImage& reference) {
    if (image.pixels.empty()) throw Error("compare: a picture without pixels");
    if (image.width != reference.width || image.height != reference.height)
        throw Error(fmt::format("compare: picture of {}x{} pixels, reference of {}x{}: expected equal sizes",
                                image.width, image.height, reference.width, reference.height));
}

}  // namespace

std::span<const Metric> metrics() { return kMetrics; }

const Metric* findMetric(std::string_view id) {
    const auto sameLetter = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
    for (const Metric& metric : kMetrics)
        if (std::equal(id.begin(), id.end(), metric.id.begin(), metric.id.end(), sameLetter)) return &metric;
    return nullptr;
}

nlohmann::json toJson(const Figures& figures) {
    const auto orNull = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); };
    nlohmann::json j;
    for (const Metric& metric : kMetrics) j["metrics"][std::string(metric.id)] = orNull(figures.*metric.value);
    j["mean"] = {
        {"image", figures.image.mean}, {"reference", figures.reference.mean}, {"ratio", orNull(figures.meanRatio())}};
    j["notFinite"] = {{"image", figures.image.notFinite}, {"reference", figures.reference.notFinite}};
    const ExposureRange& range = figures.hdrFlipExposures;
    j["hdrFlipExposures"] = {{"start", range.start}, {"stop", range.stop}, {"count", range.count}};
    return j;
}

Comparison comparePictures(const RgbImage& image, const RgbImage& reference, ThreadPool& pool) {
    checkSizes(image, reference);
    const FinitePicture i = withoutNotFinite(image);
    const FinitePicture r = withoutNotFinite(reference);
    Comparison out;
    Figures& f = out.figures;
    f.image = i.figures;
    f.reference = r.figures;
    f.mse = meanSquaredError(i.image, r.image);
    const std::vector<double> errors = relativeSquaredErrors(i.image, r.image);
    f.relMse = std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
    f.trimmedRelMse = trimmedMean(errors);
    f.smape = smape(i.image, r.image);
    f.psnr = peakSignalToNoiseRatio(displayedPicture(i.image), displayedPicture(r.image), 1);
    f.ssim = structuralSimilarity(displayedLuminance(i.image), displayedLuminance(r.image), pool);
    out.flip = ldrFlip(i.image, r.image, pool);
    f.flip = mean(out.flip);
    f.hdrFlipExposures = flipExposures(r.image);
    out.hdrFlip = hdrFlip(i.image, r.image, f.hdrFlipExposures, pool);
    f.hdrFlip = mean(out.hdrFlip);
    return out;
}

}  // namespace lsde
