// OpenEXR files in and out. exr.cpp is the one file that includes OpenEXR.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "image/image.h"

namespace lsde {

struct ExrMetadata {
    std::map<std::string, std::string> text;             // software, paths, ... (attributes of type string)
    std::map<std::string, float> numbers;                // samplesPerPixel, ... (attributes of type float)
    std::optional<float> whiteLuminance;                 // standard attribute, nits of (1,1,1)
    std::optional<std::array<float, 16>> worldToCamera;  // row-major, of row vectors; standard attribute
};

// Float channels, ZIP compression, Rec. 709 chromaticities; atomic (temporary file, fsync, rename). Same bytes for the
// same input, for any number of threads: no date, no host. Throws Error naming path and reason (disk full included).
void writeExr(const std::filesystem::path& path, const ImageFile& image, const ExrMetadata& metadata, int threads = 1);

// Scan-line or tiled, half, float or uint channels, all converted to float; any compression but the lossy DWAA and
// DWAB. Attributes come as text, numbers separated by blanks. Throws Error naming path and reason for: missing, not an
// EXR, truncated or damaged, deep, multi-part, sub-sampled channels, data window that differs from the display window,
// sizes over `maxPixels` (checked before allocation). NaN and infinite pixels are kept; compare and info count them.
ImageFile readExr(const std::filesystem::path& path, int64_t maxPixels = int64_t{1} << 28);

}  // namespace lsde
