// The stage compare: two pictures, layer by layer, in figures and on one page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/run.h"
#include "compare/metrics.h"
#include "passes/crop.h"

namespace lsde {

struct CompareSettings {
    std::filesystem::path image, reference;  // OpenEXR
    std::string layer;                       // "" for the picture itself
    std::optional<Crop> crop;                // all figures are of this part, as if the pictures ended there
    std::filesystem::path report;            // HTML; empty: none
    std::vector<std::string> failAbove;      // "METRIC=X": a failure if the error is above X; for metrics where larger
                                             // is better (psnr, ssim), if it is below
};

struct LayerFigures {
    std::string layer;
    Figures figures;
};

struct CompareResult {
    std::filesystem::path image, reference;
    int width = 0, height = 0;  // of the part compared
    std::optional<Crop> crop;
    std::vector<LayerFigures> layers;   // the one asked for, then the others that both files have
    std::vector<std::string> failures;  // missed limits, and pixels that are not finite; empty: all is well
    std::vector<std::string> lines;     // the figures for people

    // {"image", "reference", "width", "height", "crop", "layer", "formulas": {ID: text}, "failures", "layers": [...]};
    // the figures of the layer asked for (see toJson(Figures)) stand at the top too.
    nlohmann::json json() const;
};

// Throws UsageError on a limit that cannot be read, before any file is; Error on files that cannot be compared: no
// picture, no such layer, sizes that differ, a crop outside. Writes the report if one is asked for.
CompareResult comparePass(const CompareSettings& settings, RunContext& run);

}  // namespace lsde
