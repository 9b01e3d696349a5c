#include <doctest/doctest.h>

#include <limits>
#include <numeric>
#include <string>

#include "base/error.h"
#include "base/json.h"
#include "compare/pictures.h"
#include "image/exr.h"
#include "passes/compare.h"
#include "store/fixture.h"

using namespace lsde;
using test::errorOf;

namespace {

// image.exr and reference.exr with the picture and two common layers each; the image has one more.
struct Files {
    test::TemporaryFolder folder;
    ImageFile image, reference;

    Files() {
        image.setLayer("", testPicture(40, 16, 0.2));
        image.setLayer("caustic", testPicture(40, 16, 0.4));
        image.setLayer("albedo", testPicture(40, 1, 0));
        image.setLayer("mine", testPicture(40, 1, 0));
        reference.setLayer("", testPicture(40, 16, 0));
        reference.setLayer("caustic", testPicture(40, 16, 0));
        reference.setLayer("albedo", testPicture(40, 1, 0));
        image.width = reference.width = 64;
        image.height = reference.height = 48;
    }

    CompareSettings settings() const {
        writeExr(folder / "image.exr", image, {});
        writeExr(folder / "reference.exr", reference, {});
        CompareSettings s;
        s.image = folder / "image.exr";
        s.reference = folder / "reference.exr";
        return s;
    }
};

CompareResult run(const CompareSettings& settings) {
    RunContext context(2);
    return comparePass(settings, context);
}

std::string joined(const std::vector<std::string>& lines) {
    return std::accumulate(lines.begin(), lines.end(), std::string(),
                           [](const std::string& all, const std::string& line) { return all + line + "\n"; });
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("compare measures the picture, then every layer that both files have") {
    const Files files;
    const CompareResult r = run(files.settings());
    REQUIRE(r.layers.size() == 3);
    CHECK(r.layers[0].layer.empty());
    CHECK(r.layers[1].layer == "albedo");
    CHECK(r.layers[2].layer == "caustic");
    CHECK(r.layers[1].figures.mse == 0);
    CHECK(r.layers[2].figures.relMse > 3 * r.layers[0].figures.relMse);  // twice the noise
    CHECK(r.failures.empty());

    ThreadPool pool;
    const auto direct = comparePictures(testPicture(40, 16, 0.2), testPicture(40, 16, 0), pool);
    for (const Metric& m : metrics()) CHECK(r.layers[0].figures.*m.value == direct.figures.*m.value);
}

TEST_CASE("the lines print each metric with its formula, and the exposures of HDR-FLIP") {
    const Files files;
    const std::string text = joined(run(files.settings()).lines);
    for (const Metric& m : metrics()) {
        CHECK(contains(text, std::string(m.name)));
        CHECK(contains(text, std::string(m.formula)));
    }
    CHECK(contains(text, "(I-R)^2/(R^2+0.01)"));
    CHECK(contains(text, "-2.9167 to 2.0493 stops, 5 steps"));
    CHECK(contains(text, "the peak is 1"));
    CHECK(contains(text, "layer \"caustic\""));
}

TEST_CASE("the JSON holds the figures of the layer asked for at the top, and of all layers") {
    const Files files;
    CompareSettings s = files.settings();
    s.layer = "caustic";
    const CompareResult r = run(s);
    const nlohmann::json j = r.json();
    CHECK(j.at("layer") == "caustic");
    CHECK(j.at("metrics").at("relmse") == r.layers.front().figures.relMse);
    CHECK(j.at("layers").size() == 3);
    CHECK(j.at("layers")[0].at("layer") == "caustic");
    CHECK(j.at("layers")[1].at("layer") == "");
    CHECK(j.at("formulas").size() == metrics().size());
    CHECK(j.at("hdrFlipExposures").at("count") == 5);
    CHECK(j.at("notFinite").at("image") == 0);
    CHECK(j.at("mean").at("reference").size() == 3);
    CHECK(j.at("width") == 64);
    CHECK_FALSE(j.contains("crop"));
    CHECK(j.at("failures").empty());
}

TEST_CASE("a crop is measured as if the pictures ended there") {
    const Files files;
    CompareSettings s = files.settings();
    s.crop = Crop{10, 5, 40, 35};
    RgbImage image(30, 30), reference(30, 30);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 30; ++x) {
            image.at(x, y) = testPicture(40, 16, 0.2).at(x + 10, y + 5);
            reference.at(x, y) = testPicture(40, 16, 0).at(x + 10, y + 5);
        }
    ThreadPool pool;
    const auto direct = comparePictures(image, reference, pool);
    const CompareResult r = run(s);
    for (const Metric& m : metrics()) CHECK(r.layers[0].figures.*m.value == direct.figures.*m.value);
    CHECK(r.json().at("crop") == nlohmann::json({10, 5, 40, 35}));

    for (const Crop& outside : {Crop{0, 0, 65, 10}, Crop{0, 0, 10, 49}, Crop{5, 5, 5, 10}, Crop{9, 5, 8, 10}}) {
        s.crop = outside;
        CHECK(contains(errorOf([&] { run(s); }), "64"));
    }
}

TEST_CASE("an error above its limit fails, one below passes, in any case of letters") {
    const Files files;
    CompareSettings s = files.settings();
    s.failAbove = {"relMSE=1", "FLIP=0.9", "hdrflip=0.9"};
    CHECK(run(s).failures.empty());
    s.failAbove = {"relmse=1e-9", "mse=100", "SMAPE=1e-9"};
    const auto failures = run(s).failures;
    REQUIRE(failures.size() == 2);
    CHECK(contains(failures[0], "relMSE"));
    CHECK(contains(failures[0], "above 1e-09"));
    CHECK(contains(failures[1], "SMAPE"));
}

TEST_CASE("metrics where larger is better fail below their limit") {
    const Files files;
    CompareSettings s = files.settings();
    s.failAbove = {"psnr=5", "ssim=0.1"};
    CHECK(run(s).failures.empty());
    s.failAbove = {"psnr=90", "ssim=0.9999"};
    const auto failures = run(s).failures;
    REQUIRE(failures.size() == 2);
    CHECK(contains(failures[0], "PSNR"));
    CHECK(contains(failures[0], "below 90"));
    CHECK(contains(failures[1], "SSIM"));
}

TEST_CASE("a limit on a metric that is not defined for the picture fails") {
    const Files files;
    CompareSettings s = files.settings();
    s.crop = Crop{0, 0, 8, 8};
    s.failAbove = {"ssim=0.1"};
    CHECK(contains(joined(run(s).failures), "SSIM is not defined"));
}

TEST_CASE("a limit that cannot be read is wrong usage, told before any file is opened") {
    CompareSettings s;
    s.image = "absent.exr";
    for (const char* limit : {"beauty=1", "relmse", "relmse=", "relmse=x", "relmse=1x", "relmse=nan", "=1"}) {
        s.failAbove = {limit};
        CAPTURE(limit);
        CHECK_THROWS_AS(run(s), UsageError);
    }
    s.failAbove = {"beauty=1"};
    const std::string error = errorOf([&] { run(s); });
    for (const Metric& m : metrics()) CHECK(contains(error, std::string(m.id)));
}

TEST_CASE("pixels that are not finite fail the comparison, in any layer of either picture") {
    Files files;
    files.image.channels["caustic.G"][100] = std::numeric_limits<float>::quiet_NaN();
    files.image.channels["caustic.G"][101] = std::numeric_limits<float>::infinity();
    files.reference.channels["B"][5] = -std::numeric_limits<float>::infinity();
    const CompareResult r = run(files.settings());
    REQUIRE(r.failures.size() == 2);
    CHECK(contains(r.failures[0], "reference.exr: the picture: 1 pixels not finite"));
    CHECK(contains(r.failures[1], "image.exr: layer \"caustic\": 2 pixels not finite"));
    CHECK(contains(joined(r.lines), "1 of the reference; they count as 0"));
}

TEST_CASE("pictures of different sizes are refused by name and size, also whole multiples") {
    Files files;
    ImageFile large;
    large.width = 128;
    large.height = 96;
    large.setLayer("", RgbImage(128, 96, Rgb(1)));
    files.image = large;
    const std::string error = errorOf([&] { run(files.settings()); });
    for (const char* part : {"image.exr", "128x96", "reference.exr", "64x48"}) CHECK(contains(error, part));
}

TEST_CASE("a layer that one file lacks is refused by name, with those there are") {
    const Files files;
    CompareSettings s = files.settings();
    s.layer = "mine";
    const std::string error = errorOf([&] { run(s); });
    for (const char* part : {"reference.exr", "\"mine\"", "\"caustic\"", "\"albedo\""}) CHECK(contains(error, part));
    s.layer = "depth";
    CHECK(contains(errorOf([&] { run(s); }), "image.exr"));
}

TEST_CASE("the report is written with the files' names but not their folders") {
    const Files files;
    CompareSettings s = files.settings();
    s.report = files.folder / "page.html";
    run(s);
    const std::string page = test::contentOf(s.report);
    CHECK(contains(page, "\"image\":\"image.exr\""));
    CHECK_FALSE(contains(page, files.folder.path().string()));
    run(s);
    CHECK(test::contentOf(s.report) == page);
}

TEST_CASE("the means and ratio are those of the picture over the reference") {
    Files files;
    files.image.setLayer("", RgbImage(64, 48, Rgb(1, 2, 3)));
    files.reference.setLayer("", RgbImage(64, 48, Rgb(2, 2, 4)));
    const CompareResult r = run(files.settings());
    CHECK(r.layers[0].figures.meanRatio() == doctest::Approx(0.75));
    CHECK(contains(joined(r.lines), "0.75000 (0.50000 1.00000 0.75000)"));
}
