// How far a picture is from its reference: all metrics at once.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

#include "base/parallel.h"
#include "compare/flip.h"
#include "compare/plane.h"
#include "image/image.h"

namespace lsde {

struct PictureFigures {
    std::array<double, 3> mean{};  // R, G, B
    uint64_t notFinite = 0;        // pixels with a channel that is not a finite number
    double overallMean() const { return (mean[0] + mean[1] + mean[2]) / 3; }
};

struct Figures {
    double mse = 0;
    double relMse = 0;
    double trimmedRelMse = 0;
    double psnr = 0;  // dB; infinite for equal pictures
    double smape = 0;
    double ssim = 0;  // not a number for pictures smaller than its window
    double flip = 0;
    double hdrFlip = 0;
    ExposureRange hdrFlipExposures;
    PictureFigures image, reference;
    double meanRatio() const { return image.overallMean() / reference.overallMean(); }
};

// One row for each metric; whatever lists, checks or explains metrics goes over the rows.
struct Metric {
    std::string_view id;       // lower case: on the command line and in JSON
    std::string_view name;     // for people
    std::string_view formula;  // I: picture, R: reference
    bool largerIsBetter;
    double Figures::*value;
};
std::span<const Metric> metrics();

// The metric of this id, in any case; null if there is none.
const Metric* findMetric(std::string_view id);

struct Comparison {
    Figures figures;
    Plane flip, hdrFlip;  // the maps whose means the figures are
};

// {"metrics": {ID: value}, "mean": {"image": [R, G, B], "reference": [R, G, B], "ratio": x}, "notFinite": {"image": n,
// "reference": n}, "hdrFlipExposures": {"start": stops, "stop": stops, "count": n}}; null for what is no finite number.
nlohmann::json toJson(const Figures& figures);

// Channels that are not finite are taken as 0 in every figure, and their pixels counted in `notFinite`: the caller must
// not let them pass in silence. Throws Error if the sizes differ or are zero.
Comparison comparePictures(const RgbImage& image, const RgbImage& reference, ThreadPool& pool);

}  // namespace lsde
