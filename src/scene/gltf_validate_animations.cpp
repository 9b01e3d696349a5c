// Animations: references, and that keys and values fit each other.
#include <fmt/format.h>

#include "scene/gltf_validate_parts.h"

namespace lsde {

namespace {

// How many morph targets the meshes of a node have.
size_t targetsOf(const GltfChecks& checks, size_t node) {
    const JsonObject object(checks.root.json()["nodes"][node], "", checks.root.file());
    const auto mesh = object.reference("mesh", "mesh", checks.root.size("meshes"));
    if (!mesh) return 0;
    const Json& primitives = checks.root.json()["meshes"][*mesh]["primitives"];
    return primitives.empty() ? 0 : JsonObject(primitives.front(), "", checks.root.file()).size("targets");
}

const AccessorInfo& accessorOf(const GltfChecks& checks, const JsonObject& sampler, const char* key) {
    sampler.require(key);
    const size_t index = sampler.reference(key, "accessor", checks.accessors.size()).value();
    if (!checks.accessors[index].hasData)
        sampler.fail(fmt::format("accessor {} is in a buffer without data, expected a uri or a BIN chunk", index));
    return checks.accessors[index];
}

bool isCubic(const JsonObject& sampler) { return sampler.string("interpolation") == "CUBICSPLINE"; }

void checkSampler(const GltfChecks& checks, const JsonObject& sampler) {
    const AccessorInfo& input = accessorOf(checks, sampler, "input");
    if (input.type != "SCALAR" || input.componentType != 5126)
        sampler.fail(
            fmt::format("input: {} of componentType {}, expected SCALAR of float", input.type, input.componentType));
    accessorOf(checks, sampler, "output");
    const std::string how = sampler.string("interpolation");
    if (sampler.has("interpolation") && how != "LINEAR" && how != "STEP" && how != "CUBICSPLINE")
        sampler.fail(fmt::format("interpolation {}, expected LINEAR, STEP or CUBICSPLINE", shown(how)));
}

// That the sampler's values are as many as its keys ask for, and of the kind that the path takes.
void checkValues(const GltfChecks& checks, const JsonObject& sampler, const std::string& path, size_t node) {
    const AccessorInfo &input = accessorOf(checks, sampler, "input"), &output = accessorOf(checks, sampler, "output");
    const bool mayBeSmall = path == "rotation" || path == "weights";
    const char* type = path == "weights" ? "SCALAR" : path == "rotation" ? "VEC4" : "VEC3";
    if (output.type != type || !(output.componentType == 5126 || (mayBeSmall && output.normalized)))
        sampler.fail(fmt::format("output: {} of componentType {}, expected {} of float for {}", output.type,
                                 output.componentType, type, path));
    const uint64_t each = (path == "weights" ? targetsOf(checks, node) : 1) * (isCubic(sampler) ? 3 : 1);
    if (output.count != input.count * each)
        sampler.fail(fmt::format("{} keys, but {} values, expected {}", input.count, output.count, input.count * each));
}

void checkChannel(const GltfChecks& checks, const JsonObject& channel, const std::vector<JsonObject>& samplers) {
    for (const char* key : {"sampler", "target"}) channel.require(key);
    const size_t sampler = channel.reference("sampler", "sampler", samplers.size()).value();
    const JsonObject target = channel.object("target").value();
    target.require("path");
    const std::string path = target.string("path");
    const auto node = target.reference("node", "node", checks.root.size("nodes"));
    if (path == "pointer" || !node) return;
    if (path != "translation" && path != "rotation" && path != "scale" && path != "weights")
        target.fail(fmt::format("path {}, expected translation, rotation, scale or weights", shown(path)));
    if (checks.root.json()["nodes"][*node].contains("matrix"))
        target.fail(fmt::format("moves node {}, which has a matrix", *node));
    checkValues(checks, samplers[sampler], path, *node);
}

}  // namespace

void checkAnimations(const GltfChecks& checks) {
    for (const JsonObject& animation : checks.root.objects("animations", "animation")) {
        const std::vector<JsonObject> samplers = animation.objects("samplers", "sampler");
        for (const JsonObject& sampler : samplers) checkSampler(checks, sampler);
        for (const JsonObject& channel : animation.objects("channels", "channel"))
            checkChannel(checks, channel, samplers);
    }
}

}  // namespace lsde
