// Structural similarity.
#pragma once

#include "base/parallel.h"
#include "compare/plane.h"

namespace lsde {

// Mean SSIM of two planes with values in [0,1] (Wang et al. 2004): Gaussian window of 11x11 pixels and sigma 1.5,
// population variances, K1 = 0.01, K2 = 0.03, L = 1. The mean is over the pixels whose window lies within the picture;
// not a number if there is none.
double structuralSimilarity(const Plane& image, const Plane& reference, ThreadPool& pool);

}  // namespace lsde
