// Pixels that no sample has seen yet.
#pragma once

#include <span>

#include "image/image.h"

namespace lsde {

// Gives pixels without samples the mean of those around them that have some, nearer ones weighing more (normalized
// convolution, Knutsson & Westin 1993, with a tent as wide as two of the squares that have one seen pixel each). Over a
// lattice of seen pixels that is bilinear interpolation. samples: of each pixel, row by row. Throws Error if
// none has any.
void fillUnseen(RgbImage& image, std::span<const double> samples);

}  // namespace lsde
