#include "passes/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "base/error.h"

namespace lsde {

namespace {

std::optional<double> finiteNumber(const std::string& text) {
    double value = 0;
    if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value)) return std::nullopt;
    return value;
}

void addEnvironment(CLI::App& app, CommonOptions& o) {
    CLI::Option* file =
        app.add_option("--environment", o.environment.file,
                       "light from all around: an equirectangular picture of radiance (OpenEXR, Radiance .hdr)")
            ->type_name("FILE");
    app.add_option("--environment-rotate", o.environment.turnDeg,
                   "turn it about the vertical; at 0 its centre lies along +Z, at 90 along +X")
        ->needs(file)
        ->check(numberFrom(-3600, 3600))
        ->type_name("DEG");
    app.add_option("--environment-strength", o.environment.strength, "factor of its radiance")
        ->needs(file)
        ->check(positiveNumber())
        ->type_name("X");
}

void addSky(CLI::App& app, CommonOptions& o) {
    CLI::Option* sky =
        app.add_flag("--sky", o.withSky,
                     "light from the sun and a clear sky (Preetham et al. 1999): lights \"sun\", \"sky\"")
            ->excludes("--environment");
    const auto add = [&](const char* name, float& value, double least, double most, const char* text,
                         const char* type) {
        app.add_option(name, value, text)
            ->needs(sky)
            ->check(numberFrom(least, most))
            ->capture_default_str()
            ->type_name(type);
    };
    add("--sun-elevation", o.sky.sunElevationDeg, 0, 90, "of the sun above the horizon", "DEG");
    add("--sun-azimuth", o.sky.sunAzimuthDeg, -360, 360, "of the sun, from +Z towards +X", "DEG");
    add("--turbidity", o.sky.turbidity, 2, 10, "haze of the air: 2 is clear, 10 hazy", "T");
    add("--ground-albedo", o.sky.groundAlbedo, 0, 1, "of the ground beyond the scene, below the horizon", "A");
}

}  // namespace

CLI::Validator numberFrom(double least, double most) {
    return {[=](const std::string& text) {
                const auto value = finiteNumber(text);
                if (value && *value >= least && *value <= most) return std::string();
                return fmt::format("{}: expected a number from {} to {}", text, least, most);
            },
            fmt::format("from {} to {}", least, most)};
}

CLI::Validator positiveNumber() {
    return {[](const std::string& text) {
                const auto value = finiteNumber(text);
                return value && *value > 0 ? std::string() : fmt::format("{}: expected a number above 0", text);
            },
            "above 0"};
}

CLI::Validator notEmpty() {
    return {[](const std::string& text) { return text.empty() ? "expected a name" : std::string(); }, ""};
}

void addCommon(CLI::App& app, CommonOptions& o, bool scene) {
    app.add_option("--threads", o.threads, "threads (0: all processors)")
        ->check(numberFrom(0, 4096))
        ->capture_default_str();
    app.add_option("--seed", o.seed, "seed of all random numbers")->capture_default_str();
    app.add_flag("--quiet", o.quiet, "warnings and errors only, no progress bar");
    app.add_option("--log-level", o.logLevel, "debug, info or warning")
        ->check(CLI::IsMember({"debug", "info", "warning"}))
        ->capture_default_str();
    app.add_flag("--force", o.force, "overwrite outputs that exist");
    app.add_option("--json", o.json, "write the figures of the run as JSON to FILE (-: standard output)")
        ->type_name("FILE");
    if (!scene) return;
    app.add_flag("--allow-outside", o.scene.gltf.allowOutside,
                 "take buffers and images from outside the scene's folder");
    app.add_option("--scene", o.scene.gltf.scene, "scene within the file, by name or index (default: the file's)")
        ->type_name("NAME");
    app.add_option("--at", o.scene.gltf.atSeconds,
                   "the scene where its animations have it at this time (default: at rest)")
        ->check(numberFrom(-1e9, 1e9))
        ->type_name("SEC");
    app.add_option("--variant", o.scene.gltf.variant,
                   "materials of this variant (KHR_materials_variants; info lists them)")
        ->check(notEmpty())
        ->type_name("NAME");
    addEnvironment(app, o);
    addSky(app, o);
}

std::vector<std::string> splitNames(const std::string& list) {
    std::vector<std::string> out;
    std::string::size_type begin = 0;
    while (!list.empty() && begin <= list.size()) {
        const auto end = std::min(list.find(',', begin), list.size());
        out.push_back(list.substr(begin, end - begin));
        begin = end + 1;
    }
    return out;
}

std::vector<int> parseInts(const std::string& option, const std::string& text, char separator, size_t count,
                           const char* expected) {
    std::vector<int> out;
    std::string::size_type begin = 0;
    while (begin <= text.size()) {
        const auto end = std::min(text.find(separator, begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        char* stop = nullptr;
        const long value = std::strtol(part.c_str(), &stop, 10);
        if (part.empty() || *stop != 0 || value < 0 || value > 65536)
            throw UsageError(fmt::format("{} {}: expected {}", option, text, expected));
        out.push_back(static_cast<int>(value));
        begin = end + 1;
    }
    if (out.size() != count) throw UsageError(fmt::format("{} {}: expected {}", option, text, expected));
    return out;
}

}  // namespace lsde
