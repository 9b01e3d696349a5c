// Path filters on pictures.
#include <doctest/doctest.h>

#include "passes/pictures.h"

using namespace lsde;
using namespace lsde::test;

namespace {

void checkPartition(const std::string& scene, const std::string& integrator,
                    const std::vector<LayerRequest>& partition) {
    PictureSettings s = settingsFor(integrator, 32, 16, 50000);
    s.paths = partition;
    const RenderResult r = render(scene, s);
    RgbImage sum(32, 32);
    // Photons of more than 29 events have no expression, and a layer of their own where there are any.
    std::vector<std::string> names;
    names.reserve(partition.size() + 1);
    for (const LayerRequest& layer : partition) names.push_back(layer.name);
    if (r.image.channels.contains("unclassified.R")) names.emplace_back("unclassified");
    for (const std::string& name : names) {
        const RgbImage part = r.image.layer(name);
        for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += part.pixels[i];
    }
    for (size_t i = 0; i < sum.pixels.size(); ++i)
        CHECK(maxComponent(glm::abs(sum.pixels[i] - r.picture.pixels[i])) <=
              1e-6F * (1 + maxComponent(r.picture.pixels[i])));
    // Without the layers the picture is the same, to the bit.
    s.paths.clear();
    CHECK(render(scene, s).picture.pixels == r.picture.pixels);
}

}  // namespace

TEST_CASE("the layers of a partition sum to the full picture") {
    const std::vector<LayerRequest> bySurfaces{{"direct1", "L[DS]?E"}, {"caustic1", "LS+DE"},
                                               {"seen", "LS+DS+E"},    {"mirrored", "LSS+E"},
                                               {"lit", "LDS+E"},       {"twice", "L[DS]*D[DS]*D[DS]*E"}};
    // Where an expression names G, D is diffuse alone.
    const std::vector<LayerRequest> byGloss{{"none", "LE"}, {"s", "L.*SE"}, {"g", "L.*GE"}, {"d", "LDE|L.*[DGS]DE"}};
    for (const char* scene : {"glass-sphere-small", "cornell-small", "pane-ball"})
        for (const char* integrator : {"photon", "path", "light"}) {
            CAPTURE(scene);
            CAPTURE(integrator);
            checkPartition(scene, integrator, bySurfaces);
        }
    for (const char* integrator : {"photon", "path"}) checkPartition("rough-metal-area", integrator, byGloss);
}

TEST_CASE("built-in layers are a partition too") {
    const RenderResult r = render("glass-sphere-small", settingsFor("photon", 32, 16, 50000));
    for (size_t i = 0; i < r.picture.pixels.size(); ++i) {
        Rgb sum(0);
        for (const char* layer : {"direct", "caustic", "indirect"}) sum += r.image.layer(layer).pixels[i];
        CHECK(maxComponent(glm::abs(sum - r.picture.pixels[i])) < 1e-5F * std::max(1.0F, maxComponent(sum)));
    }
}

TEST_CASE("a picture of single paths wants no photons that cannot be on them") {
    struct Row {
        std::string expression;
        bool caustic, indirect;
    };
    // D may be glossy, and bend light as a caster does; but not where G is named.
    for (const Row& row : {Row{"LS+DE", true, false},
                           {"LS+DS+E", true, false},
                           {"LDE", false, false},
                           {"LD+E", true, true},
                           {"LD+E|LGE", false, true},
                           {"LDS+DE", true, true},
                           {"LGDE", true, true},
                           {"L[DS]*E", true, true}}) {
        CAPTURE(row.expression);
        const RenderLayers layers({}, row.expression);
        CHECK(layers.wantsCaustic() == row.caustic);
        CHECK(layers.wantsIndirect() == row.indirect);
    }
    CHECK(RenderLayers({}, {}).wantsIndirect());
}

TEST_CASE("only renders the mean of its layer, and nothing else") {
    for (const char* expression : {"LS+DE", "LDE", "LS+DS+E", "LD[DS]+E"}) {
        CAPTURE(expression);
        PictureSettings layered = settingsFor("photon", 16, 64, 100000);
        layered.paths = {{"wanted", expression}};
        PictureSettings only = settingsFor("photon", 16, 64, 100000);
        only.only = expression;
        const Estimate a = estimate("glass-sphere-small", layered, 6, 2, "wanted"),
                       b = estimate("glass-sphere-small", only, 6, 2);
        for (size_t i = 0; i < a.mean.size(); ++i)
            CHECK(std::fabs(a.mean[i] - b.mean[i]) <= 5 * std::hypot(a.error[i], b.error[i]) + 1e-3 * a.mean[i]);
    }
}

TEST_CASE("pictures of single lights sum to the picture of all, from one stored map") {
    const auto folder = std::filesystem::temp_directory_path();
    const auto file = folder / ("lsde-layers-test-" + std::to_string(::getpid()) + ".lsmap");
    // Lights of `lights` have no specular receiver; the pane's scene has one lamp: names are what matters here.
    RunContext run(0, 1);
    EmitSettings emit;
    emit.photons = 50000;
    writePhotonMap(file, emitPhotons(sceneOf("lights"), emit, run), run);
    PictureSettings s = settingsFor("photon", 16, 256);
    s.map = file;
    const double all = meanOf(render("lights", s).picture);
    double sum = 0;
    for (const char* light : {"point", "spot", "sun"}) {
        s.lights = {light};
        sum += meanOf(render("lights", s).picture);
    }
    std::filesystem::remove(file);
    CHECK(sum == doctest::Approx(all).epsilon(0.01));
}
