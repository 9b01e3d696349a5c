// Radiance pictures (.hdr, .pic) in.
#pragma once

#include <filesystem>

#include "image/image.h"

namespace lsde {

// RGBE pixels, flat or run-length encoded, in the standard orientation (-Y H +X W: top row first). A mantissa m and
// exponent e stand for m 2^(e - 136), as OpenImageIO and Mitsuba read them; EXPOSURE lines are divided out, as the
// format asks. Throws Error naming path and reason for: missing, not a Radiance picture, XYZE, another orientation,
// sizes over `maxPixels`, truncated or damaged.
RgbImage readHdr(const std::filesystem::path& path, int64_t maxPixels = int64_t{1} << 28);

}  // namespace lsde
