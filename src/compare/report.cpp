#include "compare/report.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/packing.hpp>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/json.h"
#include "compare/pixel_error.h"
#include "compare/report_page.h"

namespace lsde {

namespace {

using Bytes = std::vector<uint8_t>;
using Json = nlohmann::json;

std::string base64(const Bytes& bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t count = std::min<size_t>(3, bytes.size() - i);
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
        for (size_t k = 0; k < 4; ++k) out += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

Bytes deflated(const Bytes& bytes) {
    uLongf size = compressBound(bytes.size());
    Bytes out(size);
    if (compress2(out.data(), &size, bytes.data(), bytes.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
        throw Error("report: zlib cannot pack a picture");
    out.resize(size);
    return out;
}

// The power of two that keeps the picture's largest value within a half float (65504), and 1 if it is there already.
double halfScale(const RgbImage& image) {
    float largest = 0;
    for (const Rgb& pixel : image.pixels)
        for (int c = 0; c < 3; ++c)
            if (std::isfinite(pixel[c])) largest = std::max(largest, std::abs(pixel[c]));
    return largest < 32768 ? 1 : std::exp2(std::ilogb(largest) - 14);
}

std::vector<float> planes(const RgbImage& image, double scale) {
    const size_t count = image.pixels.size();
    std::vector<float> out(3 * count);
    for (size_t p = 0; p < count; ++p)
        for (size_t c = 0; c < 3; ++c)
            out[c * count + p] = static_cast<float>(image.pixels[p][static_cast<int>(c)] / scale);
    return out;
}

// As half floats, all high bytes before all low bytes: the former repeat themselves and pack well, the latter are
// noise.
std::string block(const std::string& id, const std::vector<float>& values) {
    Bytes bytes(2 * values.size());
    for (size_t i = 0; i < values.size(); ++i) {
        const uint16_t half = glm::packHalf1x16(values[i]);
        bytes[i] = static_cast<uint8_t>(half >> 8);
        bytes[values.size() + i] = static_cast<uint8_t>(half & 0xff);
    }
    return fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, base64(deflated(bytes)));
}

std::string layerBlocks(const std::string& id, const LayerComparison& layer, double imageScale, double referenceScale) {
    const std::vector<double>& flip = layer.comparison.flip.values;
    const std::vector<double>& hdrFlip = layer.comparison.hdrFlip.values;
    return block(id + "-image", planes(layer.image, imageScale)) +
           block(id + "-reference", planes(layer.reference, referenceScale)) +
           block(id + "-flip", {flip.begin(), flip.end()}) + block(id + "-hdrflip", {hdrFlip.begin(), hdrFlip.end()});
}

Json metricRows() {
    Json rows = Json::array();
    for (const Metric& m : metrics())
        rows.push_back({{"id", m.id}, {"name", m.name}, {"formula", m.formula}, {"largerIsBetter", m.largerIsBetter}});
    return rows;
}

// JSON within HTML: without "<" there is no tag and no comment in it.
std::string forHtml(const Json& json) {
    std::string out;
    for (const char c : json.dump(-1, ' ', true)) {
        if (c == '<')
            out += "\\u003c";
        else
            out += c;
    }
    return out;
}

void replaceMarker(std::string& page, std::string_view marker, const std::string& text) {
    const auto at = page.find(marker);
    LSDE_ASSERT(at != std::string::npos);
    page.replace(at, marker.size(), text);
}

}  // namespace

std::string reportPage(std::span<const LayerComparison> layers, const ReportSettings& settings) {
    Json report = {{"image", settings.imageName},
                   {"reference", settings.referenceName},
                   {"width", layers.front().image.width},
                   {"height", layers.front().image.height},
                   {"x0", settings.x0},
                   {"y0", settings.y0},
                   {"relMseEpsilon", kRelMseEpsilon},
                   {"smapeEpsilon", kSmapeEpsilon},
                   {"metrics", metricRows()},
                   {"layers", Json::array()}};
    std::string data;
    bool full = false;
    for (const LayerComparison& layer : layers) {
        Json entry = toJson(layer.comparison.figures);
        entry["layer"] = layer.layer;
        const double imageScale = halfScale(layer.image);
        const double referenceScale = halfScale(layer.reference);
        const std::string id = fmt::format("layer{}", report["layers"].size());
        const std::string blocks = full ? "" : layerBlocks(id, layer, imageScale, referenceScale);
        full = full || (!data.empty() && data.size() + blocks.size() > settings.dataBytes);
        if (!full) {
            data += blocks;
            entry.update({{"data", id}, {"imageScale", imageScale}, {"referenceScale", referenceScale}});
        }
        report["layers"].push_back(entry);
    }
    std::string page(kReportPage);
    replaceMarker(page, "@DATA@", data);
    replaceMarker(page, "@REPORT@", forHtml(report));
    return page;
}

}  // namespace lsde
