#include "passes/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/error.h"
#include "base/json.h"
#include "compare/report.h"
#include "image/exr.h"
#include "store/file.h"

namespace lsde {

namespace {

using Json = nlohmann::json;

// A report's pictures travel as text; beyond this, browsers refuse it.
constexpr int64_t kMaxReportPixels = int64_t{1} << 24;

// ---- limits --------------------------------------------------------------------------------------------------------

struct Limit {
    const Metric* metric;
    double value;
};

Limit parseLimit(const std::string& text) {
    const auto split = text.find('=');
    if (split == std::string::npos) throw UsageError(fmt::format("--fail-above {}: expected METRIC=X", text));
    const std::string id = text.substr(0, split);
    const std::string number = text.substr(split + 1);
    const Metric* metric = findMetric(id);
    if (metric == nullptr) {
        std::vector<std::string_view> ids;
        for (const Metric& m : metrics()) ids.push_back(m.id);
        throw UsageError(
            fmt::format("--fail-above {}: no metric \"{}\", expected one of {}", text, id, fmt::join(ids, ", ")));
    }
    char* end = nullptr;
    const double value = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != 0 || !std::isfinite(value))
        throw UsageError(fmt::format("--fail-above {}: \"{}\" is not a number", text, number));
    return {metric, value};
}

std::vector<std::string> missedLimits(const Figures& figures, const std::vector<Limit>& limits) {
    std::vector<std::string> failures;
    for (const Limit& limit : limits) {
        const Metric& m = *limit.metric;
        const double value = figures.*m.value;
        if (std::isnan(value))
            failures.push_back(fmt::format("{} is not defined for pictures this small", m.name));
        else if (m.largerIsBetter ? value < limit.value : value > limit.value)
            failures.push_back(fmt::format("{} {:.6g} is {} {:.6g}", m.name, value,
                                           m.largerIsBetter ? "below" : "above", limit.value));
    }
    return failures;
}

// ---- pictures ------------------------------------------------------------------------------------------------------

std::string titleOf(const std::string& layer) {
    return layer.empty() ? "the picture" : fmt::format("layer \"{}\"", layer);
}

bool hasLayer(const ImageFile& image, const std::string& layer) {
    const auto names = image.layerNames();
    return std::find(names.begin(), names.end(), layer) != names.end();
}

void checkLayer(const std::filesystem::path& path, const ImageFile& image, const std::string& layer) {
    if (hasLayer(image, layer)) return;
    std::vector<std::string> there;
    for (const std::string& name : image.layerNames()) there.push_back(titleOf(name));
    throw Error(fmt::format("{}: {} is not there, expected one of: {}", path.string(), titleOf(layer),
                            there.empty() ? "(no layer has R, G and B)" : fmt::format("{}", fmt::join(there, ", "))));
}

void checkSizes(const CompareSettings& s, const ImageFile& image, const ImageFile& reference) {
    if (image.width == reference.width && image.height == reference.height) return;
    throw Error(fmt::format("{}: {}x{} pixels, but {} has {}x{}: expected equal sizes (nothing is scaled)",
                            s.image.string(), image.width, image.height, s.reference.string(), reference.width,
                            reference.height));
}

Crop checkedCrop(const CompareSettings& s, const ImageFile& image) {
    if (!s.crop) return {0, 0, image.width, image.height};
    const Crop& c = *s.crop;
    if (c.x0 < 0 || c.y0 < 0 || c.x0 >= c.x1 || c.y0 >= c.y1 || c.x1 > image.width || c.y1 > image.height)
        throw Error(fmt::format("--crop {},{},{},{}: expected X0 < X1 <= {} and Y0 < Y1 <= {}, the size of {}", c.x0,
                                c.y0, c.x1, c.y1, image.width, image.height, s.image.string()));
    return c;
}

RgbImage croppedLayer(const ImageFile& file, const std::string& layer, const Crop& crop) {
    const RgbImage whole = file.layer(layer);
    RgbImage part(crop.x1 - crop.x0, crop.y1 - crop.y0);
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x) part.at(x, y) = whole.at(crop.x0 + x, crop.y0 + y);
    return part;
}

// The layer asked for, then the others that both have; the picture itself before the named ones.
std::vector<std::string> commonLayers(const ImageFile& image, const ImageFile& reference, const std::string& first) {
    std::vector<std::string> out{first};
    for (const std::string& name : image.layerNames())
        if (name != first && hasLayer(reference, name)) out.push_back(name);
    return out;
}

std::vector<LayerComparison> compareLayers(const CompareSettings& s, const ImageFile& image, const ImageFile& reference,
                                           const Crop& crop, RunContext& run) {
    const PhaseTimer timer(run, "compare");
    std::vector<LayerComparison> out;
    const auto names = commonLayers(image, reference, s.layer);
    for (const std::string& name : names) {
        run.checkInterrupt();
        run.progress("compare", static_cast<double>(out.size()) / static_cast<double>(names.size()));
        LayerComparison layer{name, croppedLayer(image, name, crop), croppedLayer(reference, name, crop), {}};
        layer.comparison = comparePictures(layer.image, layer.reference, run.pool);
        out.push_back(std::move(layer));
    }
    return out;
}

// ---- output --------------------------------------------------------------------------------------------------------

void addNotFinite(const std::filesystem::path& path, const std::string& layer, uint64_t count,
                  std::vector<std::string>& failures) {
    if (count > 0)
        failures.push_back(fmt::format("{}: {}: {} pixels not finite", path.string(), titleOf(layer), count));
}

std::string meansLine(const char* what, const PictureFigures& p) {
    return fmt::format("{:<15} {:.6g} {:.6g} {:.6g}", what, p.mean[0], p.mean[1], p.mean[2]);
}

std::string channelRatios(const Figures& f) {
    const auto ratio = [&](size_t c) { return f.image.mean[c] / f.reference.mean[c]; };
    return fmt::format("{:.5f} {:.5f} {:.5f}", ratio(0), ratio(1), ratio(2));
}

std::vector<std::string> linesOf(const CompareResult& r) {
    const Figures& f = r.layers.front().figures;
    std::vector<std::string> lines;
    lines.push_back(fmt::format("{} against {}: {}, {}x{} pixels", r.image.string(), r.reference.string(),
                                titleOf(r.layers.front().layer), r.width, r.height));
    for (const Metric& m : metrics())
        lines.push_back(fmt::format("{:<15} {:<12.6g} {}", m.name, f.*m.value, m.formula));
    lines.push_back(fmt::format("{:<15} {:.4f} to {:.4f} stops, {} steps", "  exposures", f.hdrFlipExposures.start,
                                f.hdrFlipExposures.stop, f.hdrFlipExposures.count));
    lines.push_back(meansLine("mean picture", f.image));
    lines.push_back(meansLine("mean reference", f.reference));
    lines.push_back(fmt::format("{:<15} {:.5f} ({})", "ratio of means", f.meanRatio(), channelRatios(f)));
    lines.push_back(fmt::format("{:<15} {} pixels of the picture, {} of the reference{}", "not finite",
                                f.image.notFinite, f.reference.notFinite,
                                f.image.notFinite + f.reference.notFinite > 0 ? "; they count as 0 above" : ""));
    for (size_t i = 1; i < r.layers.size(); ++i) {
        const Figures& g = r.layers[i].figures;
        lines.push_back(
            fmt::format("{}: relMSE {:.4g}, trimmed {:.4g}, FLIP {:.4g}, HDR-FLIP {:.4g}, ratio of means {:.5f}",
                        titleOf(r.layers[i].layer), g.relMse, g.trimmedRelMse, g.flip, g.hdrFlip, g.meanRatio()));
    }
    return lines;
}

void writeReport(const CompareSettings& s, const std::vector<LayerComparison>& layers, const Crop& crop,
                 RunContext& run) {
    const PhaseTimer timer(run, "write report");
    ReportSettings settings;
    settings.imageName = s.image.filename().string();
    settings.referenceName = s.reference.filename().string();
    settings.x0 = crop.x0;
    settings.y0 = crop.y0;
    writeFileAtomically(s.report, reportPage(layers, settings));
}

}  // namespace

Json CompareResult::json() const {
    Json j = toJson(layers.front().figures);
    j["image"] = image.string();
    j["reference"] = reference.string();
    j["width"] = width;
    j["height"] = height;
    if (crop) j["crop"] = {crop->x0, crop->y0, crop->x1, crop->y1};
    j["layer"] = layers.front().layer;
    for (const Metric& m : metrics()) j["formulas"][std::string(m.id)] = m.formula;
    j["layers"] = Json::array();
    for (const LayerFigures& layer : layers) {
        Json entry = toJson(layer.figures);
        entry["layer"] = layer.layer;
        j["layers"].push_back(entry);
    }
    j["failures"] = failures;
    return j;
}

CompareResult comparePass(const CompareSettings& settings, RunContext& run) {
    std::vector<Limit> limits;
    limits.reserve(settings.failAbove.size());
    for (const std::string& text : settings.failAbove) limits.push_back(parseLimit(text));

    const ImageFile image = readExr(settings.image);
    const ImageFile reference = readExr(settings.reference);
    checkLayer(settings.image, image, settings.layer);
    checkLayer(settings.reference, reference, settings.layer);
    checkSizes(settings, image, reference);
    const Crop crop = checkedCrop(settings, image);

    CompareResult result{
        settings.image, settings.reference, crop.x1 - crop.x0, crop.y1 - crop.y0, settings.crop, {}, {}, {}};
    if (!settings.report.empty() && int64_t{result.width} * result.height > kMaxReportPixels)
        throw Error(fmt::format("{}: a report of {}x{} pixels, expected at most {}: use --crop",
                                settings.report.string(), result.width, result.height, kMaxReportPixels));
    const auto layers = compareLayers(settings, image, reference, crop, run);
    for (const LayerComparison& layer : layers) {
        const Figures& f = layer.comparison.figures;
        result.layers.push_back({layer.layer, f});
        addNotFinite(settings.image, layer.layer, f.image.notFinite, result.failures);
        addNotFinite(settings.reference, layer.layer, f.reference.notFinite, result.failures);
    }
    const auto missed = missedLimits(result.layers.front().figures, limits);
    result.failures.insert(result.failures.end(), missed.begin(), missed.end());
    result.lines = linesOf(result);
    if (!settings.report.empty()) writeReport(settings, layers, crop, run);
    return result;
}

}  // namespace lsde
