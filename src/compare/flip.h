// FLIP: the difference that a person sees who flips between two pictures on a screen.
// LDR: Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"; HDR: Andersson et al. 2021,
// "Visualizing Errors in Rendered High Dynamic Range Images". Pictures are linear Rec. 709 and finite; maps are in
// [0,1] for every pixel.
#pragma once

#include "base/parallel.h"
#include "compare/plane.h"
#include "image/image.h"

namespace lsde {

// A screen 0.7 m wide with 3840 pixels a row, seen from 0.7 m: about 67 pixels per degree.
inline constexpr double kFlipPixelsPerDegree = 3840 * (3.14159265358979323846 / 180);

// FLIP of the pictures as a screen shows them: clamped to [0,1].
Plane ldrFlip(const RgbImage& image, const RgbImage& reference, ThreadPool& pool,
              double pixelsPerDegree = kFlipPixelsPerDegree);

// In stops: from the exposure that takes the reference's maximum out of saturation to the one that takes its median
// there.
struct ExposureRange {
    double start = 0;
    double stop = 0;
    int count = 2;  // exposures, equally far apart, both ends included
};

// Of the reference's luminance (2021, section 4). Where more than half of the picture is black, the papers' range is
// infinite; the median of what is not black is taken then. Both ends are 0 for a picture that is black altogether.
ExposureRange flipExposures(const RgbImage& reference);

// Largest FLIP over the exposures, for pictures tone-mapped by the ACES curve. Negative values count as black.
Plane hdrFlip(const RgbImage& image, const RgbImage& reference, const ExposureRange& exposures, ThreadPool& pool,
              double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace lsde
