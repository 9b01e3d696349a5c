#include "scene/gltf_validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.h"
#include "scene/gltf_limits.h"
#include "scene/gltf_validate_parts.h"

namespace lsde {

namespace {

// Extensions that are rendered as they say.
constexpr auto kSupported = std::to_array<std::string_view>({"EXT_lights_ies",
                                                             "EXT_mesh_gpu_instancing",
                                                             "EXT_meshopt_compression",
                                                             "EXT_texture_webp",
                                                             "KHR_draco_mesh_compression",
                                                             "KHR_lights_punctual",
                                                             "KHR_materials_anisotropy",
                                                             "KHR_materials_clearcoat",
                                                             "KHR_materials_dispersion",
                                                             "KHR_materials_emissive_strength",
                                                             "KHR_materials_ior",
                                                             "KHR_materials_iridescence",
                                                             "KHR_materials_sheen",
                                                             "KHR_materials_specular",
                                                             "KHR_materials_transmission",
                                                             "KHR_materials_unlit",
                                                             "KHR_materials_variants",
                                                             "KHR_materials_volume",
                                                             "KHR_mesh_quantization",
                                                             "KHR_texture_transform"});

// Depth and number of values, found before the parser allocates anything for them.
void checkJsonLimits(const std::string& name, const std::string& text) {
    size_t depth = 0, values = 1;
    bool inString = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inString) {
            if (c == '\\') ++i;
            inString = c != '"';
        } else if (c == '"') {
            inString = true;
        } else if (c == '[' || c == '{') {
            ++values;
            if (++depth > kMaxJsonDepth)
                throw Error(fmt::format("{}: JSON nested deeper than {} levels at byte {}", name, kMaxJsonDepth, i));
        } else if (c == ']' || c == '}') {
            depth -= depth > 0 ? 1 : 0;
        } else if (c == ',') {
            ++values;
        }
    }
    if (values > kMaxJsonValues) throw Error(fmt::format("{}: more than {} values in its JSON", name, kMaxJsonValues));
}

Json parseJson(const std::string& name, const std::string& text) {
    checkJsonLimits(name, text);
    try {
        return Json::parse(text);
    } catch (const Json::exception& e) {
        // "[json.exception.parse_error.101] parse error at line 1, column 5: ..."
        std::string_view message = e.what();
        message = message.substr(message.find(']') + 2);
        throw Error(fmt::format("{}: not valid JSON: {:.200}", name, message));
    }
}

// A version "2.0" as {2, 0}.
std::array<int, 2> versionOf(const JsonObject& asset, const char* key) {
    const std::string text = asset.string(key);
    const size_t dot = text.find('.');
    const auto isNumber = [](std::string_view s) {
        return !s.empty() && s.size() < 5 && s.find_first_not_of("0123456789") == std::string_view::npos;
    };
    if (dot == std::string::npos || !isNumber(text.substr(0, dot)) || !isNumber(text.substr(dot + 1)))
        asset.fail(fmt::format("{} {}, expected \"2.0\"", key, shown(text)));
    return {std::stoi(text.substr(0, dot)), std::stoi(text.substr(dot + 1))};
}

std::vector<std::string> strings(const JsonObject& root, const char* key) {
    std::vector<std::string> out;
    if (root.size(key) == 0) return out;
    for (const Json& value : root.json()[key]) {
        if (!value.is_string()) root.fail(fmt::format("{} {}, expected a string", key, shown(value)));
        out.push_back(value.get<std::string>());
    }
    return out;
}

bool isSupported(std::string_view extension) {
    return std::find(kSupported.begin(), kSupported.end(), extension) != kSupported.end();
}

}  // namespace

void checkAsset(const GltfChecks& checks) {
    checks.root.require("asset");
    const JsonObject asset = checks.root.object("asset").value();
    asset.require("version");
    const std::array<int, 2> version = versionOf(asset, "version");
    if (version[0] != 2) asset.fail(fmt::format("version {}, expected 2.0", shown(asset.string("version"))));
    if (!asset.has("minVersion")) return;
    const std::array<int, 2> least = versionOf(asset, "minVersion");
    if (least > version || least > std::array<int, 2>{2, 0})
        asset.fail(fmt::format("minVersion {}, expected at most 2.0", shown(asset.string("minVersion"))));
}

void checkExtensions(GltfChecks& checks) {
    const std::vector<std::string> required = strings(checks.root, "extensionsRequired");
    for (const std::string& extension : required)
        if (!isSupported(extension))
            checks.root.fail(fmt::format("extension {} is required, but not supported", shown(extension)));
    for (const std::string& extension : strings(checks.root, "extensionsUsed")) {
        checks.extensionsUsed.insert(extension);
        if (!isSupported(extension)) checks.warnings.add(fmt::format("extension {} is ignored", shown(extension)), "");
    }
}

Json validateGltf(const std::filesystem::path& file, const GltfSource& source, bool allowOutside, Warnings& warnings) {
    const std::string name = file.string();
    Json json = parseJson(name, source.json);
    GltfChecks checks{JsonObject(json, "", name), file.parent_path(), allowOutside, source, warnings, {}, {}, {}, {}};
    checkAsset(checks);
    checkExtensions(checks);
    checkBuffers(checks);
    checkBufferViews(checks);
    checkAccessors(checks);
    checkTextures(checks);
    checkMeshes(checks);
    checkNodes(checks);
    checkAnimations(checks);
    return json;
}

}  // namespace lsde
