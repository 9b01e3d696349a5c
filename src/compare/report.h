// The report: one HTML page that holds everything it shows and needs no network.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "compare/metrics.h"
#include "image/image.h"

namespace lsde {

struct LayerComparison {
    std::string layer;  // "" for the picture itself
    RgbImage image, reference;
    Comparison comparison;
};

struct ReportSettings {
    std::string imageName, referenceName;  // as titles
    int x0 = 0, y0 = 0;                    // of the first pixel within the whole picture, for a crop
    size_t dataBytes = 15'000'000;         // see reportPage
};

// The first layer is the one shown first. Figures of all layers are in the page; pictures and maps of as many, in their
// order, as fit into `dataBytes`, and of the first in any case. The page names those left out.
//
// Pictures are kept as half floats (11 bits, relative) over a power of two of their own, the maps of FLIP as half
// floats. Each is one block <script type="text/plain" id="LAYER-KIND">: base64 of a zlib stream of first the high, then
// the low bytes of all values, plane by plane. The same input gives the same bytes.
std::string reportPage(std::span<const LayerComparison> layers, const ReportSettings& settings);

}  // namespace lsde
