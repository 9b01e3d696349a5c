// The command line: parses, calls the stages, prints. Everything else is in the library.
#include <fmt/format.h>
#include <signal.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "base/error.h"
#include "base/json.h"
#include "image/png.h"
#include "passes/compare.h"
#include "passes/emit.h"
#include "passes/explain.h"
#include "passes/info.h"
#include "passes/integrators/registry.h"
#include "passes/options.h"
#include "passes/progress_bar.h"
#include "passes/render.h"
#include "passes/scene_source.h"
#include "store/file.h"

namespace {

using namespace lsde;
using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kAllCameras = "all";

RunContext* interruptible = nullptr;  // what the signal handler may touch

extern "C" void onSignal(int signal) {
    // A second signal ends the program at once.
    if (interruptible == nullptr || interruptible->interruptSignal != 0) _exit(128 + signal);
    interruptible->interruptSignal = signal;
}

void setUpLog(RunContext& run, const CommonOptions& o, ProgressBar& bar) {
    auto logger = std::make_shared<spdlog::logger>("lsde", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    logger->set_pattern("%^%l%$: %v");
    logger->set_level(o.quiet || o.logLevel == "warning" ? spdlog::level::warn
                      : o.logLevel == "debug"            ? spdlog::level::debug
                                                         : spdlog::level::info);
    run.onLog = [logger, &bar](LogLevel level, const std::string& line) {
        bar.clear();
        logger->log(level == LogLevel::Debug  ? spdlog::level::debug
                    : level == LogLevel::Info ? spdlog::level::info
                                              : spdlog::level::warn,
                    line);
    };
    if (!o.quiet) run.onProgress = [&bar](const Progress& p) { bar.show(p); };
}

Json runFigures(const RunContext& run) {
    Json j;
    j["wallSeconds"] = wallSeconds();
    j["cpuSeconds"] = cpuSeconds();
    j["peakMemoryBytes"] = peakMemoryBytes();
    j["rays"] = run.rays.load();
    j["threads"] = run.pool.threads();
    j["phases"] = Json::array();
    for (const PhaseTime& p : run.phases)
        j["phases"].push_back({{"name", p.name}, {"wallSeconds", p.wall}, {"cpuSeconds", p.cpu}});
    j["warnings"] = run.warnings();
    return j;
}

void writeJson(const std::string& target, const Json& json) {
    if (target.empty()) return;
    if (target == "-")
        std::cout << json.dump(2) << '\n';
    else
        writeFileAtomically(target, json.dump(2) + "\n");
}

void checkOutputs(const std::vector<fs::path>& outputs, const CommonOptions& o) {
    for (const fs::path& p : outputs)
        if (!p.empty() && p != "-") checkOutput(p, o.force);
}

// ---------------------------------------------------------------------------------------------------------------- emit

struct EmitOptions {
    fs::path scene, output;
    EmitSettings settings;
    std::string store{name(Store::Indirect)}, shard, lights;
    bool noAim = false, resume = false;
};

IndexRange parseShard(const std::string& text, uint64_t photons) {
    unsigned long long i = 0, n = 0;
    char end = 0;
    if (std::sscanf(text.c_str(), "%llu/%llu%c", &i, &n, &end) != 2 || n == 0 || i == 0 || i > n)
        throw UsageError(fmt::format("--shard {}: expected I/N with 1 <= I <= N", text));
    return shardRange(photons, i, n);
}

Json emitFigures(const PhotonMap& map, const fs::path& file) {
    Json j;
    j["photonsEmitted"] = map.header.emittedPaths();
    for (int c = 0; c < kPhotonClasses; ++c) {
        const auto k = static_cast<PhotonClass>(c);
        j["photonsStored"][std::string(name(k))] = map.photons(k).count;
        j["photonsLanded"][std::string(name(k))] = map.header.ledger.landed[static_cast<size_t>(c)];
    }
    j["absorbedWatts"] = map.header.ledger[LedgerColumn::AbsorbedSurface].toDouble(1) /
                         std::max<double>(1, static_cast<double>(map.header.emittedPaths()));
    j["maxAimWeight"] = map.header.ledger.maxAimWeight;
    j["bytes"] = fs::file_size(file);
    return j;
}

// What is still to be emitted: all, or what an interrupted emission left.
std::optional<IndexRange> resumeFrom(const EmitOptions& o, IndexRange wanted, RunContext& run) {
    if (!o.resume || !fs::exists(o.output)) return wanted;
    const PhotonMap done = readPhotonMap(o.output, run);
    const auto& ranges = done.header.ranges;
    if (ranges.size() != 1 || ranges[0].begin != wanted.begin || ranges[0].end > wanted.end)
        throw Error(fmt::format("{}: cannot be resumed: holds other light paths than the beginning of [{}, {})",
                                o.output.string(), wanted.begin, wanted.end));
    if (ranges[0].end == wanted.end) return {};
    run.info(fmt::format("resuming after {} of {} paths", ranges[0].end - wanted.begin, wanted.end - wanted.begin));
    return IndexRange{ranges[0].end, wanted.end};
}

int runEmit(EmitOptions& o, const CommonOptions& common, RunContext& run) {
    checkOutputs({o.resume ? fs::path() : o.output, common.json}, common);
    for (const Store store : {Store::Caustic, Store::Indirect, Store::All})
        if (o.store == name(store)) o.settings.store = store;
    o.settings.aim = !o.noAim;
    o.settings.lights = splitNames(o.lights);
    const auto scene = loadScene(o.scene, common.scene, run);
    if (scene->lights().empty()) throw Error(noLightError(*scene));
    const IndexRange wanted =
        o.shard.empty() ? IndexRange{0, o.settings.photons} : parseShard(o.shard, o.settings.photons);
    const auto range = resumeFrom(o, wanted, run);
    if (!range) {
        run.info(fmt::format("{}: already complete", o.output.string()));
        return 0;
    }
    o.settings.range = *range;
    bool interrupted = false;
    PhotonMap map = emitPhotons(*scene, o.settings, run, &interrupted);
    if (range->begin != wanted.begin) map = mergePhotonMaps(readPhotonMap(o.output, run), std::move(map), run);
    {
        const PhaseTimer timer(run, "write map");
        writePhotonMap(o.output, map, run);
    }
    const Explanation explanation =
        explain(*scene, scene->lightSelection(o.settings.lights), map.header.ledger, map.header.emittedPaths());
    if (explanation.noCaustics.empty())
        run.info(explanation.text);
    else
        run.warn(explanation.text);
    Json j = runFigures(run);
    j.update(emitFigures(map, o.output));
    j["explanation"] = explanation.json();
    writeJson(common.json, j);
    run.info(fmt::format("{}: {} paths, {} caustic photons, {} bytes, {:.1f} CPU s", o.output.string(),
                         map.header.emittedPaths(), map.photons(PhotonClass::Caustic).count, fs::file_size(o.output),
                         cpuSeconds()));
    if (interrupted) throw Interrupted(run.interruptSignal);
    return 0;
}

// -------------------------------------------------------------------------------------------------------------- render

struct RenderOptions {
    fs::path scene, output;
    RenderSettings settings;
    bool noCache = false;
    uint64_t photons = 0;
    double spp = 0, wall = 0, cpu = 0, error = 0;
    std::optional<float> exposure;
    std::string integrator = "photon", size, crop, index = "kd", indirect = "photons", only, lights;
    std::vector<std::string> paths;
};

void settle(RenderOptions& o, const CLI::App& app) {
    RenderSettings& s = o.settings;
    s.cache = !o.noCache;
    if (app.count("--photons") > 0) s.photons = o.photons;
    if (app.count("--spp") > 0) s.spp = o.spp;
    if (app.count("--time") > 0) s.wallLimit = o.wall;
    if (app.count("--cpu-time") > 0) s.cpuLimit = o.cpu;
    if (app.count("--error") > 0) s.errorLimit = o.error;
    if (!o.size.empty()) {
        const auto v = parseInts("--size", o.size, 'x', 2, "WxH, each from 1 to 65536");
        if (v[0] == 0 || v[1] == 0)
            throw UsageError(fmt::format("--size {}: expected WxH, each from 1 to 65536", o.size));
        s.size = {v[0], v[1]};
    }
    if (!o.crop.empty()) {
        const auto v = parseInts("--crop", o.crop, ',', 4, "X0,Y0,X1,Y1 in pixels");
        s.crop = Crop{v[0], v[1], v[2], v[3]};
    }
    if (!o.only.empty()) s.only = o.only;
    s.lights = splitNames(o.lights);
    s.indirectFromMap = o.indirect == "photons";
    s.index = o.index == "flann" ? IndexKind::Flann : IndexKind::Kd;
    int number = 0;
    for (const std::string& p : o.paths) s.paths.push_back(parseLayerRequest(p, ++number));
}

// "all" is every camera of the scene.
std::vector<CameraDescription> camerasOf(const Scene& scene, const std::string& name) {
    const auto& there = scene.description().cameras;
    return name != kAllCameras || there.empty() ? std::vector{scene.camera(name == kAllCameras ? "" : name)} : there;
}

// OUT.NAME.exr for each of all cameras: what a file name may not hold is replaced, a name that comes again is numbered.
std::vector<fs::path> picturesOf(const RenderOptions& o, const std::vector<CameraDescription>& cameras, bool all) {
    if (!all) return {o.output};
    std::vector<fs::path> files;
    for (const CameraDescription& camera : cameras) {
        std::string name = camera.name.empty() ? "camera" : camera.name;
        for (char& c : name)
            if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_') c = '_';
        const auto file = [&](const std::string& part) {
            return fs::path(o.output).replace_extension("." + part + o.output.extension().string());
        };
        fs::path next = file(name);
        for (int i = 2; std::find(files.begin(), files.end(), next) != files.end(); ++i)
            next = file(name + "-" + std::to_string(i));
        files.push_back(next);
    }
    return files;
}

// Under a sky a white surface that lies in the open is white.
float exposureStops(const RenderOptions& o, const SceneSettings& scene) {
    if (o.exposure) return *o.exposure;
    return scene.sky ? -std::log2(luminance(openIrradiance(*scene.sky)) * kInvPi) : 0;
}

void writePicture(const fs::path& file, const RenderResult& r, float stops, RunContext& run) {
    const PhaseTimer timer(run, "write picture");
    run.pool.both([&] { writeExr(file, r.image, r.metadata, run.pool.threads()); },
                  [&] { writePng(fs::path(file).replace_extension(".png"), r.picture, stops); });
}

Json pictureFigures(const fs::path& file, const RenderResult& r) {
    Json j;
    j["samplesPerPixel"] = r.samples;
    if (r.samples == std::floor(r.samples)) j["samplesPerPixel"] = static_cast<uint64_t>(r.samples);
    j["notFinite"] = r.notFinite;
    if (r.relativeError)
        j["estimatedRelMse"] = {{"total", r.relativeError->total()},
                                {"camera", r.relativeError->camera},
                                {"photons", r.relativeError->photons}};
    j["bytes"] = fs::file_size(file);
    return j;
}

void checkPictures(const std::vector<fs::path>& files, const CommonOptions& common) {
    for (const fs::path& file : files) checkOutputs({file, fs::path(file).replace_extension(".png")}, common);
}

int runRender(RenderOptions& o, const CommonOptions& common, const CLI::App& app, RunContext& run) {
    settle(o, app);
    const IntegratorEntry& method = integratorByName(o.integrator);
    const bool all = o.settings.camera == kAllCameras;
    if (!all) checkPictures({o.output}, common);
    checkOutputs({common.json}, common);
    // Expressions are refused before the scene is loaded.
    const RenderLayers layers(o.settings.paths, o.settings.only);
    const auto scene = loadScene(o.scene, common.scene, run);
    const std::vector<CameraDescription> cameras = camerasOf(*scene, o.settings.camera);
    const std::vector<fs::path> files = picturesOf(o, cameras, all);
    if (all) checkPictures(files, common);
    const float stops = exposureStops(o, common.scene);
    bool interrupted = false;
    Json shared, pictures = Json::array();
    renderPictures(*scene, method, o.settings, cameras, run, [&](size_t camera, RenderResult&& r) {
        writePicture(files[camera], r, stops, run);
        run.info(fmt::format("{}: {} samples a pixel, {} light paths, {:.1f} CPU s", files[camera].string(), r.samples,
                             r.photons, cpuSeconds()));
        pictures.push_back(pictureFigures(files[camera], r));
        if (all) {
            pictures.back()["file"] = files[camera].string();
            pictures.back()["camera"] = cameras[camera].name;
        }
        shared["photonsEmitted"] = r.photons;
        shared["photonsStored"] = {{"caustic", r.storedPhotons}, {"indirect", r.storedIndirect}};
        if (r.passes > 0) shared["progressivePasses"] = r.passes;
        if (!r.cachedMap.empty()) shared["cachedMap"] = r.cachedMap.string();
        interrupted = r.interrupted;
    });
    Json j = runFigures(run);
    j.update(shared);
    if (all)
        j["pictures"] = pictures;
    else
        j.update(pictures.front());
    writeJson(common.json, j);
    if (interrupted) throw Interrupted(run.interruptSignal);
    return 0;
}

void addRender(CLI::App& app, RenderOptions& o) {
    app.add_option("SCENE", o.scene, "glTF scene (.gltf, .glb)")->required();
    app.add_option("-o,--output", o.output, "picture (OpenEXR); a tone-mapped PNG is written beside it")->required();
    app.add_option("--map", o.settings.map, "photon map of this scene (default: emitted, or found in the cache)")
        ->type_name("MAP.lsmap");
    app.add_flag("--no-cache", o.noCache, "neither look for the map in the user's cache folder nor keep it there");
    app.add_flag("--other-scene", o.settings.otherScene, "take a map of another scene");
    app.add_option("--photons", o.photons, "light paths to emit (default 1000000)")
        ->check(positiveNumber())
        ->type_name("N");
    app.add_option("--spp", o.spp, "samples a pixel, on average, at least 1/64 (default 64)")
        ->check(numberFrom(1.0 / 64, 1e9))
        ->type_name("N");
    app.add_option("--time", o.wall, "wall seconds for the whole run")->check(positiveNumber())->type_name("SEC");
    app.add_option("--cpu-time", o.cpu, "CPU seconds of all threads for the whole run")
        ->check(positiveNumber())
        ->type_name("SEC");
    app.add_option("--error", o.error,
                   "end when the estimated relMSE, the mean of error^2 / (value^2 + 0.01), is as low; photons and "
                   "samples are chosen unless given")
        ->check(positiveNumber())
        ->type_name("E");
    app.add_option("--size", o.size, "picture size in pixels (default: the camera's extras.resolution, else 1280 wide)")
        ->type_name("WxH");
    app.add_option("--exposure", o.exposure,
                   "stops by which the PNG alone is brightened (default 0; with --sky as its light asks for)")
        ->check(numberFrom(-100, 100))
        ->type_name("STOPS");
    app.add_option("--crop", o.crop, "only these pixels of the picture")->type_name("X0,Y0,X1,Y1");
    app.add_option("--camera", o.settings.camera,
                   "camera by name (default: the first; without one, the scene is framed); all: a picture of each by "
                   "one map, OUT.NAME.exr")
        ->type_name("NAME");
    app.add_option("--paths", o.paths,
                   "Heckbert expression, light first, as a layer of its own: EXPR=NAME (may be repeated)")
        ->type_name("EXPR[=NAME]");
    app.add_option("--only", o.only, "render these paths alone")->type_name("EXPR");
    app.add_option("--lights", o.lights, "only these lights, by name")->type_name("NAME,...");
    app.add_option("--integrator", o.integrator, "method: photon, path or light")
        ->capture_default_str()
        ->type_name("NAME");
    app.add_option("--progressive", o.settings.progressive, "independent photon passes with shrinking radius")
        ->check(positiveNumber())
        ->type_name("PASSES");
    app.add_option("--indirect", o.indirect,
                   "light that met a diffuse surface before: photons (of the map, where it holds them), or paths (no "
                   "bias, more noise)")
        ->check(CLI::IsMember({"photons", "paths"}))
        ->capture_default_str();
    app.add_option("--index", o.index, "photon index: kd or flann")
        ->check(CLI::IsMember({"kd", "flann"}))
        ->capture_default_str();
}

// ---------------------------------------------------------------------------------------------------- the other three

int runMerge(const std::vector<fs::path>& maps, const fs::path& output, const CommonOptions& common, RunContext& run) {
    checkOutputs({output, common.json}, common);
    const PhotonMap map = mergePhotonMaps(maps, run);
    writePhotonMap(output, map, run);
    Json j = runFigures(run);
    j.update(emitFigures(map, output));
    writeJson(common.json, j);
    run.info(fmt::format("{}: {} of {} paths", output.string(), map.header.emittedPaths(), map.header.totalPaths));
    return 0;
}

int runInfo(const fs::path& file, const InfoSettings& settings, const CommonOptions& common, RunContext& run) {
    checkOutputs({common.json}, common);
    const InfoResult info = describeFile(file, settings, run);
    if (common.json.empty())
        for (const std::string& line : info.lines) std::cout << line << '\n';
    else
        writeJson(common.json, *info.json);
    return 0;
}

int runCompare(const CompareSettings& settings, const CommonOptions& common, RunContext& run) {
    checkOutputs({settings.report, common.json}, common);
    const CompareResult result = comparePass(settings, run);
    if (common.json != "-")
        for (const std::string& line : result.lines) std::cout << line << '\n';
    writeJson(common.json, result.json());
    for (const std::string& failure : result.failures) std::cerr << "error: " << failure << '\n';
    return result.failures.empty() ? 0 : 1;
}

int parseAndRun(int argc, char** argv) {
    CLI::App app{"lsde: caustics by multi-pass photon mapping"};
    app.set_version_flag("--version", std::string("lsde ") + LSDE_VERSION);
    app.require_subcommand(1);
    app.get_formatter()->column_width(34);
    CommonOptions common;

    EmitOptions emit;
    CLI::App* emitCommand = app.add_subcommand("emit", "trace light from the sources into a photon map");
    emitCommand->add_option("SCENE", emit.scene, "glTF scene (.gltf, .glb)")->required();
    emitCommand->add_option("-o,--output", emit.output, "photon map")->required()->type_name("MAP.lsmap");
    emitCommand->add_option("--photons", emit.settings.photons, "light paths of the whole emission, over all shards")
        ->check(positiveNumber())
        ->capture_default_str()
        ->type_name("N");
    emitCommand->add_option("--max-depth", emit.settings.maxDepth, "events of a light path")
        ->check(numberFrom(1, 1000000))
        ->capture_default_str()
        ->type_name("N");
    emitCommand
        ->add_option("--store", emit.store,
                     "caustic: L X+ D alone; indirect: also light that met a D; all: also direct light")
        ->check(CLI::IsMember({"caustic", "indirect", "all"}))
        ->capture_default_str();
    emitCommand->add_option("--shard", emit.shard, "emit part I of N of the paths (I from 1)")->type_name("I/N");
    emitCommand->add_option("--lights", emit.lights, "only these lights, by name")->type_name("NAME,...");
    emitCommand->add_flag("--no-aim", emit.noAim, "emit in all directions, not towards what bends light");
    emitCommand->add_flag("--resume", emit.resume, "go on with the map that an interrupted emission left");
    addCommon(*emitCommand, common, true);

    RenderOptions render, reference;
    CLI::App* renderCommand = app.add_subcommand("render", "picture of a scene with its caustics");
    addRender(*renderCommand, render);
    addCommon(*renderCommand, common, true);
    CLI::App* referenceCommand = app.add_subcommand("reference", "picture by path tracing, as ground truth");
    reference.integrator = "path";
    addRender(*referenceCommand, reference);
    addCommon(*referenceCommand, common, true);

    CompareSettings compare;
    CLI::App* compareCommand = app.add_subcommand("compare", "how far apart two pictures are, and where");
    compareCommand->add_option("IMAGE", compare.image, "picture (OpenEXR)")->required();
    compareCommand->add_option("REFERENCE", compare.reference, "ground truth (OpenEXR)")->required();
    compareCommand->add_option("--layer", compare.layer, "layer (default: the picture itself)")->type_name("NAME");
    std::string compareCrop;
    compareCommand->add_option("--crop", compareCrop, "only these pixels")->type_name("X0,Y0,X1,Y1");
    compareCommand->add_option("--report", compare.report, "one self-contained HTML page")->type_name("PAGE.html");
    compareCommand
        ->add_option("--fail-above", compare.failAbove,
                     "exit 1 if this metric is above X (psnr and ssim: below X): mse, relmse, trimmed, smape, psnr, "
                     "ssim, flip or hdrflip (may be repeated)")
        ->type_name("METRIC=X");
    addCommon(*compareCommand, common, false);

    std::vector<fs::path> maps;
    fs::path merged;
    CLI::App* mergeCommand = app.add_subcommand("merge", "one map from shards of one emission");
    mergeCommand->add_option("MAP", maps, "photon maps")->required();
    mergeCommand->add_option("-o,--output", merged, "photon map")->required()->type_name("MAP.lsmap");
    addCommon(*mergeCommand, common, false);

    fs::path infoFile;
    InfoSettings info;
    CLI::App* infoCommand =
        app.add_subcommand("info", "what a scene, a map or an image holds, and whether it is sound");
    infoCommand->add_option("FILE", infoFile, "scene, map or image")->required();
    bool verify = false;  // info always checks every byte
    infoCommand->add_flag("--verify", verify, "check every byte (always done)");
    addCommon(*infoCommand, common, true);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        const int code = app.exit(e, std::cout, std::cerr);
        return code == 0 ? 0 : 2;
    }
    if (!compareCrop.empty()) {
        const auto v = parseInts("--crop", compareCrop, ',', 4, "X0,Y0,X1,Y1 in pixels");
        compare.crop = {v[0], v[1], v[2], v[3]};
    }
    if (!common.environment.file.empty()) common.scene.environment = common.environment;
    if (common.withSky) common.scene.sky = common.sky;
    RunContext run(common.threads, common.seed);
    interruptible = &run;
    ProgressBar bar;
    setUpLog(run, common, bar);
    if (emitCommand->parsed()) return runEmit(emit, common, run);
    if (renderCommand->parsed()) return runRender(render, common, *renderCommand, run);
    if (referenceCommand->parsed()) return runRender(reference, common, *referenceCommand, run);
    if (compareCommand->parsed()) return runCompare(compare, common, run);
    if (mergeCommand->parsed()) return runMerge(maps, merged, common, run);
    info.scene = common.scene;
    return runInfo(infoFile, info, common, run);
}

}  // namespace

int main(int argc, char** argv) {
    struct sigaction action {};
    action.sa_handler = onSignal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    signal(SIGXFSZ, SIG_IGN);  // a full quota is an error of the write, not the end of the process
    guardMappedFiles();
    int code = 1;
    try {
        code = parseAndRun(argc, argv);
        std::cout.flush();
        if (!std::cout) throw Error("standard output: cannot be written");
    } catch (const UsageError& e) {
        std::cerr << "error: " << e.what() << '\n';
        code = 2;
    } catch (const Interrupted& e) {
        std::cerr << "interrupted\n";
        code = 128 + e.signal;
    } catch (const std::bad_alloc&) {
        std::cerr << "error: out of memory\n";
    } catch (const std::exception& e) {
        std::cerr << "error: " << e.what() << '\n';
    }
    interruptible = nullptr;
    return code;
}
