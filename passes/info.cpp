#include "passes/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "base/error.h"
#include "base/json.h"
#include "image/exr.h"
#include "passes/emit.h"
#include "passes/explain.h"
#include "photon/map_file.h"
#include "scene/scene.h"

namespace lsde {

namespace {

using Json = nlohmann::json;

Json toJson(Rgb c) { return {c.x, c.y, c.z}; }
std::string show(Rgb c) { return fmt::format("{:.6g} {:.6g} {:.6g}", c.x, c.y, c.z); }

std::string firstBytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error(fmt::format("{}: cannot be opened: {}", file.string(), std::strerror(errno)));
    std::string head(8, '\0');
    in.read(head.data(), 8);
    head.resize(static_cast<size_t>(in.gcount()));
    return head;
}

struct Watts {
    std::array<double, 3> channel{};
};
Watts watts(const FixedRgb& sum, uint64_t paths) {
    Watts w;
    for (int c = 0; c < 3; ++c)
        w.channel[static_cast<size_t>(c)] = paths > 0 ? sum.toDouble(c) / static_cast<double>(paths) : 0;
    return w;
}
std::string show(const Watts& w) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", w.channel[0], w.channel[1], w.channel[2]);
}

const char* kindOf(const Light& light) {
    if (std::holds_alternative<AreaLight>(light.shape)) return "area";
    if (const auto* p = std::get_if<PointLight>(&light.shape)) {
        if (p->profile != nullptr) return "measured";
        return p->isSpot() ? "spot" : "point";
    }
    if (const auto* i = std::get_if<InfiniteLight>(&light.shape)) return i->surrounds() ? "environment" : "sun";
    return "directional";
}

void describeLights(const Scene& scene, InfoResult& out) {
    Json lights = Json::array();
    for (const Light& light : scene.lights()) {
        lights.push_back({{"name", light.name}, {"kind", kindOf(light)}, {"watts", toJson(light.power())}});
        out.lines.push_back(fmt::format("light \"{}\": {}, {} W", light.name, kindOf(light), show(light.power())));
    }
    (*out.json)["lights"] = lights;
    if (scene.lights().empty())
        out.lines.emplace_back(
            "no lights: render needs an emissive material, a punctual light, --sky or --environment FILE");
}

void describeCameras(const Scene& scene, InfoResult& out) {
    Json cameras = Json::array();
    for (const CameraDescription& c : scene.description().cameras) {
        const auto size = pictureSize(c, {});
        cameras.push_back({{"name", c.name}, {"size", size}});
        out.lines.push_back(fmt::format("camera \"{}\": {}x{}", c.name, size[0], size[1]));
    }
    (*out.json)["cameras"] = cameras;
    if (cameras.empty()) out.lines.emplace_back("no camera: render frames the scene");
}

InfoResult describeScene(const std::filesystem::path& file, const InfoSettings& settings, RunContext& run) {
    const std::unique_ptr<Scene> loaded = loadScene(file, settings.scene, run);
    const Scene& scene = *loaded;
    InfoResult out;
    Json& j = *out.json;
    size_t triangles = 0;
    for (const Mesh& m : scene.description().meshes) triangles += m.triangles.size();
    j = {{"kind", "scene"},
         {"hash", scene.hash()},
         {"meshes", scene.meshes().size()},
         {"triangles", triangles},
         {"materials", scene.description().materials.size()},
         {"textures", scene.description().textures.size()},
         {"objects", scene.objects()},
         {"solids", scene.media().size() - 1},
         {"casters", scene.casters().size()},
         {"units", "1 unit = 1 nit, 1 cd, 1 lux = 1 W/(m2 sr), 1 W/sr, 1 W/m2 a channel; metres"},
         {"glossyRoughness", kGlossyRoughness},
         {"warnings", run.warnings()}};
    out.lines.push_back(fmt::format("scene {}: {} meshes, {} triangles, {} materials, {} textures, {} solids",
                                    scene.hash(), scene.meshes().size(), triangles,
                                    scene.description().materials.size(), scene.description().textures.size(),
                                    scene.media().size() - 1));
    out.lines.emplace_back(
        "units: metres; one nit, candela, lux = one W/(m2 sr), W/sr, W/m2 per channel (linear Rec. 709)");
    out.lines.push_back(fmt::format("vertex classes: G below roughness {}, D above", kGlossyRoughness));
    j["variants"] = scene.description().variants;
    for (const std::string& variant : scene.description().variants)
        out.lines.push_back(
            fmt::format("variant \"{}\"{}", variant, variant == settings.scene.gltf.variant ? ": shown" : ""));
    describeLights(scene, out);
    describeCameras(scene, out);
    for (size_t i = 0; i < scene.meshes().size(); ++i)
        if (scene.meshes()[i].caster)
            out.lines.push_back(
                fmt::format("caster \"{}\": material \"{}\"", scene.description().meshes[i].object,
                            scene.description().materials[scene.description().meshes[i].material].name));
    const Explanation explanation = explainByPilot(scene, run);
    out.lines.push_back(explanation.text);
    j["explanation"] = explanation.json();
    if (!explanation.noCaustics.empty()) j["noCaustics"] = explanation.noCaustics;
    return out;
}

void describeLedger(const MapHeader& h, InfoResult& out) {
    const uint64_t paths = h.emittedPaths();
    Json& j = *out.json;
    for (int c = 0; c < kLedgerColumns; ++c) {
        const auto column = static_cast<LedgerColumn>(c);
        const Watts w = watts(h.ledger[column], paths);
        j["ledger"][std::string(name(column))] = w.channel;
        out.lines.push_back(fmt::format("ledger {:>16}: {} W", name(column), show(w)));
    }
    const bool exact = h.ledger.balance() == FixedRgb();
    j["ledgerExact"] = exact;
    out.lines.push_back(fmt::format("ledger's columns {}",
                                    exact ? "sum to what was emitted, exactly" : "DO NOT SUM to what was emitted"));
    for (int c = 0; c < kPhotonClasses; ++c)
        for (size_t o = 0; o < h.objects.size(); ++o) {
            const FixedRgb& sum = h.ledger.flux[static_cast<size_t>(c) * h.objects.size() + o];
            const Watts w = watts(sum, paths);
            j["flux"][std::string(name(static_cast<PhotonClass>(c)))][h.objects[o]] = w.channel;
            if (!(sum == FixedRgb()))
                out.lines.push_back(
                    fmt::format("flux {:>8} \"{}\": {} W", name(static_cast<PhotonClass>(c)), h.objects[o], show(w)));
        }
}

InfoResult describeMap(const std::filesystem::path& file, RunContext& run) {
    const PhotonMap map = readPhotonMap(file, run, true);
    const MapHeader& h = map.header;
    InfoResult out;
    Json& j = *out.json;
    const uint64_t bytes = std::filesystem::file_size(file);
    j = {{"kind", "map"},
         {"sceneHash", h.sceneHash},
         {"units", h.units},
         {"seed", h.seed},
         {"totalPaths", h.totalPaths},
         {"emittedPaths", h.emittedPaths()},
         {"maxDepth", h.maxDepth},
         {"store", h.store},
         {"aimed", h.aimed},
         {"lights", h.lights},
         {"bytes", bytes},
         {"unclassified", h.ledger.unclassified},
         {"maxAimWeight", h.ledger.maxAimWeight}};
    out.lines.push_back(fmt::format("map of scene {}: {} of {} paths, seed {}, store {}{}", h.sceneHash,
                                    h.emittedPaths(), h.totalPaths, h.seed, h.store, h.aimed ? "" : ", not aimed"));
    uint64_t stored = 0;
    for (int c = 0; c < kPhotonClasses; ++c) {
        const auto k = static_cast<PhotonClass>(c);
        const uint64_t count = map.photons(k).count;
        stored += count;
        const uint64_t landed = h.ledger.landed[static_cast<size_t>(c)];
        const auto payload = map.photons(k).payload;
        const auto dispersed = std::count_if(payload.begin(), payload.end(),
                                             [](const PhotonPayload& p) { return p.wavelength != kAllWavelengths; });
        j["photons"][std::string(name(k))] = {{"stored", count}, {"landed", landed}, {"dispersed", dispersed}};
        out.lines.push_back(fmt::format("{:>8}: {} photons landed, {} stored{}", name(k), landed, count,
                                        dispersed > 0 ? fmt::format(", {} of one wavelength", dispersed) : ""));
    }
    if (stored > 0) {
        const double each = static_cast<double>(bytes) / static_cast<double>(stored);
        j["bytesPerPhoton"] = each;
        out.lines.push_back(fmt::format("{} bytes, {:.2f} a photon", bytes, each));
    }
    if (h.ledger.unclassified > 0)
        out.lines.push_back(fmt::format("{} photons of more than {} events: layer unclassified", h.ledger.unclassified,
                                        PathCode::kMaxEvents));
    out.lines.push_back(fmt::format("largest weight of an aimed path: {:.4g}", h.ledger.maxAimWeight));
    describeLedger(h, out);
    return out;
}

InfoResult describeImage(const std::filesystem::path& file) {
    const ImageFile image = readExr(file);
    InfoResult out;
    Json& j = *out.json;
    uint64_t notFinite = 0;
    std::vector<std::string> channels;
    for (const auto& [channel, values] : image.channels) {
        channels.push_back(channel);
        for (const float v : values) notFinite += std::isfinite(v) ? 0 : 1;
    }
    j = {{"kind", "image"},
         {"width", image.width},
         {"height", image.height},
         {"channels", channels},
         {"layers", image.layerNames()},
         {"notFinite", notFinite},
         {"attributes", image.attributes}};
    out.lines.push_back(fmt::format("image: {}x{}, {} channels, {} values not finite", image.width, image.height,
                                    channels.size(), notFinite));
    for (const std::string& layer : image.layerNames()) {
        const RgbImage picture = image.layer(layer);
        std::array<double, 3> sum{};
        for (const Rgb p : picture.pixels)
            for (int c = 0; c < 3; ++c) sum[static_cast<size_t>(c)] += p[c];
        const auto n = static_cast<double>(picture.pixels.size());
        out.lines.push_back(
            fmt::format("layer \"{}\": mean {:.6g} {:.6g} {:.6g}", layer, sum[0] / n, sum[1] / n, sum[2] / n));
    }
    for (const auto& [key, value] : image.attributes) out.lines.push_back(fmt::format("{}: {}", key, value));
    return out;
}

}  // namespace

InfoResult::InfoResult() : json(std::make_unique<Json>()) {}
InfoResult::~InfoResult() = default;
InfoResult::InfoResult(InfoResult&&) noexcept = default;

InfoResult describeFile(const std::filesystem::path& file, const InfoSettings& settings, RunContext& run) {
    const std::string head = firstBytes(file);
    if (head.starts_with("LSDECONT")) return describeMap(file, run);
    if (head.starts_with("\x76\x2f\x31\x01") || file.extension() == ".exr") return describeImage(file);
    if (file.extension() == ".lsmap") return describeMap(file, run);
    return describeScene(file, settings, run);
}

}  // namespace lsde
