#include "compare/report.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <string>
#include <vector>

#include "base/json.h"
#include "compare/pictures.h"

using namespace lsde;

namespace {

LayerComparison compared(const std::string& name, const RgbImage& image, const RgbImage& reference) {
    ThreadPool pool;
    return {name, image, reference, comparePictures(image, reference, pool)};
}

std::string pageOf(const std::vector<LayerComparison>& layers, size_t dataBytes = 15'000'000) {
    ReportSettings settings;
    settings.imageName = "out </script><b>.exr";
    settings.referenceName = "reference.exr";
    settings.x0 = 17;
    settings.dataBytes = dataBytes;
    return reportPage(layers, settings);
}

// What stands between <script ... id="ID"> and </script>.
std::string script(const std::string& page, const std::string& id) {
    const auto tag = page.find(fmt::format("id=\"{}\">", id));
    REQUIRE(tag != std::string::npos);
    const auto begin = page.find('>', tag) + 1;
    return page.substr(begin, page.find("</script>", begin) - begin);
}

std::vector<uint8_t> fromBase64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<uint8_t> out;
    uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<uint32_t>(digits.find(c));
        count += 6;
        if (count >= 8) out.push_back(static_cast<uint8_t>(bits >> (count -= 8)));
    }
    return out;
}

std::vector<float> decoded(const std::string& page, const std::string& id, size_t count) {
    const auto packed = fromBase64(script(page, id));
    std::vector<uint8_t> bytes(2 * count);
    uLongf size = bytes.size();
    REQUIRE(uncompress(bytes.data(), &size, packed.data(), packed.size()) == Z_OK);
    REQUIRE(size == bytes.size());
    std::vector<float> out;
    for (size_t i = 0; i < count; ++i)
        out.push_back(glm::unpackHalf1x16(static_cast<uint16_t>(bytes[i] << 8 | bytes[count + i])));
    return out;
}

}  // namespace

TEST_CASE("the report's data decode to the pictures and maps") {
    RgbImage image = testPicture(37, 16, 0.5);
    image.at(1, 2) = Rgb(1e9F, std::numeric_limits<float>::quiet_NaN(), -kInfinity);  // beyond a half float's range
    const auto layer = compared("", image, testPicture(40, 16, 0));
    const std::string page = pageOf({layer});
    const auto report = nlohmann::json::parse(script(page, "report"));
    const auto& entry = report.at("layers").at(0);
    const size_t pixels = image.pixels.size();

    const auto check = [&](const RgbImage& picture, const char* kind) {
        const double scale = entry.at(std::string(kind) + "Scale");
        const auto values = decoded(page, entry.at("data").get<std::string>() + "-" + kind, 3 * pixels);
        double worst = 0;
        for (size_t p = 0; p < pixels; ++p)
            for (size_t c = 0; c < 3; ++c) {
                const double expected = picture.pixels[p][static_cast<int>(c)];
                const double value = values[c * pixels + p] * scale;
                if (!std::isfinite(expected))
                    CHECK(std::isnan(expected) == std::isnan(value));
                else  // half of the last of 11 bits, and half of the smallest half float
                    worst = std::max(worst, std::abs(value - expected) / (std::abs(expected) / 2048 + scale * 0x1p-25));
            }
        CHECK(worst <= 1);
    };
    check(layer.image, "image");
    check(layer.reference, "reference");

    const auto flip = decoded(page, entry.at("data").get<std::string>() + "-hdrflip", pixels);
    for (size_t p = 0; p < pixels; ++p) REQUIRE(std::abs(flip[p] - layer.comparison.hdrFlip.values[p]) <= 1.0 / 2048);
}

TEST_CASE("the report tells all figures of all layers, and how they are computed") {
    const auto layer = compared("", testPicture(40, 0.9, 0.5), testPicture(40, 0.9, 0));
    const auto caustic = compared("caustic", testPicture(40, 0.9, 0.1), testPicture(40, 0.9, 0));
    const auto report = nlohmann::json::parse(script(pageOf({layer, caustic}), "report"));
    CHECK(report.at("width") == 64);
    CHECK(report.at("height") == 48);
    CHECK(report.at("x0") == 17);
    CHECK(report.at("image") == "out </script><b>.exr");
    REQUIRE(report.at("layers").size() == 2);
    CHECK(report.at("layers")[1].at("layer") == "caustic");
    REQUIRE(report.at("metrics").size() == metrics().size());
    for (const Metric& metric : metrics()) {
        CHECK(report.at("layers")[0].at("metrics").at(std::string(metric.id)) ==
              layer.comparison.figures.*metric.value);
        CHECK(report.at("layers")[1].at("metrics").at(std::string(metric.id)) ==
              caustic.comparison.figures.*metric.value);
    }
    CHECK(report.at("metrics")[1].at("formula") == "mean of (I-R)^2/(R^2+0.01) over pixels and channels");
    CHECK(report.at("relMseEpsilon") == 0.01);
}

TEST_CASE("the report is one page that names nothing outside itself") {
    const auto layer = compared("", testPicture(40, 0.9, 0.5), testPicture(40, 0.9, 0));
    const std::string page = pageOf({layer, compared("a", layer.image, layer.reference)});
    CHECK(page.starts_with("<!DOCTYPE html>"));
    CHECK(page.ends_with("</html>\n"));
    for (const char* outside : {"http:", "https:", "//cdn", "src=", "@import", "url(", "fetch(", "XMLHttpRequest"}) {
        CAPTURE(outside);
        CHECK(page.find(outside) == std::string::npos);
    }
    CHECK(page.find("default-src 'none'") != std::string::npos);
    for (const char* marker : {"@STYLE@", "@SCRIPT@", "@REPORT@", "@DATA@"})
        CHECK(page.find(marker) == std::string::npos);
    // As many tags end as begin, whatever the files' names hold.
    for (const char* tag : {"script", "style", "section", "table", "label", "div", "fieldset", "b"}) {
        const auto count = [&](const std::string& text) {
            int n = 0;
            for (size_t at = page.find(text); at != std::string::npos; at = page.find(text, at + 1)) ++n;
            return n;
        };
        CAPTURE(tag);
        CHECK(count(fmt::format("<{} ", tag)) + count(fmt::format("<{}>", tag)) == count(fmt::format("</{}>", tag)));
    }
}

TEST_CASE("the same comparison gives the same page") {
    const auto layer = compared("", testPicture(40, 16, 0.5), testPicture(40, 16, 0));
    CHECK(pageOf({layer}) == pageOf({layer}));
}

TEST_CASE("a page that would grow too large keeps the first pictures and all figures") {
    const auto layer = compared("", testPicture(40, 16, 0.5), testPicture(40, 16, 0));
    const std::vector<LayerComparison> layers(4, layer);
    const size_t one = script(pageOf({layer}), "layer0-image").size();
    const auto shown = [&](size_t dataBytes) {
        const auto report = nlohmann::json::parse(script(pageOf(layers, dataBytes), "report"));
        CHECK(report.at("layers").size() == 4);
        const auto& entries = report.at("layers");
        return std::count_if(entries.begin(), entries.end(), [](const auto& e) { return e.contains("data"); });
    };
    CHECK(shown(1) == 1);
    CHECK(shown(one * 100) == 4);
    const auto some = shown(one * 5);
    CHECK(some >= 2);
    CHECK(some < 4);
}
