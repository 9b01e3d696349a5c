#include "passes/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/json.h"
#include "passes/emission_pilot.h"
#include "path/event.h"

namespace lsde {

namespace {

// At most three names, and how many there are.
std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (size_t i = 0; i < std::min<size_t>(names.size(), 3); ++i)
        out += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", names[i]);
    return names.size() > 3 ? fmt::format("{} and {} more", out, names.size() - 3) : out;
}

// Names of the lights that pass, each once.
template <typename Passes>
std::vector<std::string> lightsWhere(const Scene& scene, const Passes& passes) {
    std::set<std::string> seen;
    std::vector<std::string> names;
    for (size_t i = 0; i < scene.lights().size(); ++i)
        if (passes(i) && seen.insert(scene.lights()[i].name).second) names.push_back(scene.lights()[i].name);
    return names;
}

const Material& materialOf(const Scene& scene, size_t mesh) {
    return scene.description().materials[scene.description().meshes[mesh].material];
}

// Objects with a mesh that passes.
template <typename Passes>
std::vector<std::string> objectsWhere(const Scene& scene, const Passes& passes) {
    std::vector<bool> passing(scene.objects().size());
    for (size_t i = 0; i < scene.meshes().size(); ++i)
        if (passes(i)) passing[scene.meshes()[i].object] = true;
    std::vector<std::string> names;
    for (size_t o = 0; o < passing.size(); ++o)
        if (passing[o]) names.push_back(scene.objects()[o]);
    return names;
}

std::vector<std::string> specularObjects(const Scene& scene) {
    return objectsWhere(scene, [&](size_t i) { return hasNarrowLobe(materialOf(scene, i)); });
}

// The smoothest metal or glass: what its owner may have meant to be smooth.
std::string smoothest(const Scene& scene) {
    const Material* found = nullptr;
    std::string out;
    for (size_t i = 0; i < scene.meshes().size(); ++i) {
        const Material& m = materialOf(scene, i);
        if (!(m.metallic > 0 || m.transmission > 0) || (found != nullptr && found->roughness <= m.roughness)) continue;
        found = &m;
        out = fmt::format("the smoothest {}, \"{}\", has roughness {:.3g}", m.transmission > 0 ? "glass" : "metal",
                          scene.description().meshes[i].object, m.roughness);
    }
    return out;
}

// Of some paths, how the lights meet the casters: whether any is aimed at one, and whether any arrives.
struct Reach {
    bool aims = false, arrives = false;
};

Reach reachOf(const Scene& scene, const std::vector<bool>& lights) {
    constexpr uint64_t kPaths = 4096;
    const EmissionSampler sources(scene, lights, kAimedAtCasters);
    Reach reach;
    reach.aims = scene.casters().empty();  // extras.lsde.aim is false: nothing tells
    WalkScratch scratch;
    for (uint64_t i = 0; i < kPaths && !reach.arrives; ++i) {
        Sampler sampler = Sampler::sequence(0, Stage::EmissionPilot, i);
        LightPathStart start;
        const bool emits = sources.sample(sampler, start);
        reach.aims |= start.part > 0;
        PathState path = start.path();
        Vertex v;
        reach.arrives = emits && advance(scene, path, v, scratch) && hasNarrowLobe(scene.material(v.surface));
    }
    return reach;
}

std::pair<NoCaustics, std::string> whyNone(const Scene& scene, const std::vector<bool>& lights, const Ledger& ledger) {
    if (std::find(lights.begin(), lights.end(), true) == lights.end())
        return {NoCaustics::NoLight, "the scene has no lights (--sky and --environment FILE add one)"};
    if (specularObjects(scene).empty()) {
        if (const std::string rough = smoothest(scene); !rough.empty())
            return {NoCaustics::TooRough,
                    fmt::format("nothing is smoother than roughness {}, below which light counts as bent ({}); what it "
                                "throws is in the picture all the same, as indirect light",
                                kGlossyRoughness, rough)};
        return {NoCaustics::NothingSpecular,
                fmt::format("nothing in the scene is specular (no mirror, no glass, no roughness below {})",
                            kGlossyRoughness)};
    }
    if (ledger.fluxOf(static_cast<size_t>(PhotonClass::Caustic)) > 0) {
        std::vector<std::string> where;
        for (size_t o = 0; o < scene.objects().size(); ++o)
            if (!(ledger.flux[static_cast<size_t>(PhotonClass::Caustic) * scene.objects().size() + o] == FixedRgb()))
                where.push_back(scene.objects()[o]);
        return {NoCaustics::ReceivesNot,
                fmt::format("extras.lsde.receivesCaustics is false wherever they would fall: on {}", listed(where))};
    }
    const Reach reach = reachOf(scene, lights);
    if (!reach.aims)
        return {NoCaustics::FacesAway,
                "no light shines towards what is specular: lamps shine to their front only unless they are "
                "double-sided, spots within their cone"};
    if (!reach.arrives) return {NoCaustics::NotReached, "something keeps the light from all that is specular"};
    return {NoCaustics::LandsNowhere,
            "light that comes off what is specular meets no diffuse surface: it is absorbed or leaves the scene"};
}

void addFlux(const Scene& scene, const Ledger& ledger, uint64_t paths, Explanation& out) {
    std::vector<bool> receives(scene.objects().size(), false);
    for (const MeshInfo& m : scene.meshes()) receives[m.object] = receives[m.object] || m.receiver;
    const auto watts = [&](const FixedRgb& sum) {
        const double each = paths > 0 ? 1 / static_cast<double>(paths) : 0;
        return Rgb(glm::dvec3(sum.toDouble(0), sum.toDouble(1), sum.toDouble(2)) * each);
    };
    out.emitted = watts(ledger[LedgerColumn::Emitted]);
    std::vector<std::pair<float, std::string>> byFlux;
    for (size_t o = 0; o < receives.size(); ++o) {
        if (!receives[o]) continue;
        const Rgb flux = watts(ledger.flux[static_cast<size_t>(PhotonClass::Caustic) * scene.objects().size() + o]);
        out.caustic += flux;
        if (!isBlack(flux)) byFlux.emplace_back(-luminance(flux), scene.objects()[o]);
    }
    std::sort(byFlux.begin(), byFlux.end());
    for (const auto& [flux, object] : byFlux) out.receivers.push_back(object);
}

// What surprises people although it is as the files say.
std::string remarks(const Scene& scene, const std::vector<bool>& lights) {
    const auto thin = objectsWhere(scene, [&](size_t i) { return materialOf(scene, i).isThinWall(); });
    const auto unaimed = objectsWhere(scene, [&](size_t i) {
        return hasNarrowLobe(materialOf(scene, i)) && !scene.description().meshes[i].switches.casts;
    });
    const auto points = lightsWhere(scene, [&](size_t i) { return lights[i] && scene.lights()[i].isDelta(); });
    std::string out;
    if (!thin.empty())
        out += fmt::format(" Glass without KHR_materials_volume is a thin wall, which light passes unbent: {}.",
                           listed(thin));
    if (!unaimed.empty())
        out += fmt::format(" Light is not aimed at what has extras.lsde.castsCaustics false: {}.", listed(unaimed));
    if (!points.empty())
        out +=
            fmt::format(" A light without size is seen itself neither straight, nor in mirrors or through glass: {}.",
                        listed(points));
    return out;
}

}  // namespace

std::string_view name(NoCaustics reason) {
    constexpr std::array<std::string_view, 8> kNames{"thereAre",  "noLight",    "nothingSpecular", "tooRough",
                                                     "facesAway", "notReached", "landsNowhere",    "receivesNot"};
    return kNames[static_cast<size_t>(reason)];
}

nlohmann::json Explanation::json() const {
    const auto list = [](Rgb c) { return nlohmann::json{c.x, c.y, c.z}; };
    return {{"reason", name(reason)},  {"text", text},           {"lights", lights},
            {"casters", casters},      {"receivers", receivers}, {"emitted", list(emitted)},
            {"caustic", list(caustic)}};
}

Explanation explain(const Scene& scene, const std::vector<bool>& lights, const Ledger& ledger, uint64_t paths) {
    Explanation out;
    out.lights = lightsWhere(scene, [&](size_t i) { return lights[i]; });
    out.casters = specularObjects(scene);
    addFlux(scene, ledger, paths, out);
    if (isBlack(out.caustic)) {
        std::tie(out.reason, out.noCaustics) = whyNone(scene, lights, ledger);
        out.noCaustics = "no caustics here: " + out.noCaustics;
        out.text = out.noCaustics + "." + remarks(scene, lights);
        return out;
    }
    out.text = fmt::format(
        "Light of {} falls by way of {} on {} as caustics (LS+D): {:.3g} W, {:.2g}% of the {:.3g} W emitted.{}",
        listed(out.lights), listed(out.casters), listed(out.receivers), luminance(out.caustic),
        100 * luminance(out.caustic) / luminance(out.emitted), luminance(out.emitted), remarks(scene, lights));
    return out;
}

Explanation explainByPilot(const Scene& scene, RunContext& run) {
    constexpr uint64_t kPaths = 16384;
    std::vector<bool> lights;
    for (const Light& light : scene.lights()) lights.push_back(!isBlack(light.power()));
    Ledger ledger(scene.lights().size(), scene.objects().size());
    if (std::find(lights.begin(), lights.end(), true) == lights.end()) return explain(scene, lights, ledger, 0);
    const EmissionSampler sources(scene, lights, kAimedAtCasters);
    const DiffuseAim unaimed(scene, 0);
    const LightTracerInput input{scene, sources, unaimed, Store::Caustic, 64, run.seed};
    for (const LightPaths& paths : tracePilot(input, kPaths, run.pool)) ledger.merge(paths.ledger);
    return explain(scene, lights, ledger, kPaths);
}

}  // namespace lsde
