#include "scene/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/error.h"

namespace lsde {

namespace {

struct LocalTransform {
    glm::dmat4 full{1};
    glm::dmat4 unscaled{1};
};

glm::dquat readRotation(const JsonObject& node, Warnings& warnings) {
    const std::vector<double> q = node.numbers("rotation", 4, {0, 0, 0, 1});
    const glm::dquat rotation(q[3], q[0], q[1], q[2]);
    // Quaternions rounded to floats are off by some 1e-7, to normalised 16 bits by 5e-5.
    constexpr double kTolerance = 5e-4;
    if (std::fabs(glm::length(rotation) - 1) > kTolerance)
        warnings.add("rotation is not a unit quaternion: normalised", node.where());
    return glm::normalize(rotation);
}

// A matrix has its scale in the lengths of its columns; mirroring stays, since no rotation can stand for it.
glm::dmat4 withoutScale(glm::dmat4 m) {
    for (int i = 0; i < 3; ++i)
        if (const double length = glm::length(glm::dvec3(m[i])); length > 0) m[i] /= length;
    return m;
}

LocalTransform readTransform(const JsonObject& node, Warnings& warnings) {
    LocalTransform local;
    const std::vector<double> matrix = node.numbers("matrix", 16, {});
    if (!matrix.empty()) {
        for (int i = 0; i < 16; ++i) local.full[i / 4][i % 4] = matrix[static_cast<size_t>(i)];
        local.unscaled = withoutScale(local.full);
        return local;
    }
    const std::vector<double> t = node.numbers("translation", 3, {0, 0, 0});
    const std::vector<double> s = node.numbers("scale", 3, {1, 1, 1});
    local.unscaled = glm::translate(glm::dmat4(1), {t[0], t[1], t[2]}) * glm::mat4_cast(readRotation(node, warnings));
    local.full = glm::scale(local.unscaled, {s[0], s[1], s[2]});
    return local;
}

}  // namespace

size_t chooseScene(const JsonObject& root, const std::string& wanted) {
    const std::vector<JsonObject> scenes = root.objects("scenes", "scene");
    if (scenes.empty()) root.fail("no scene to render, expected at least one");
    if (wanted.empty()) return root.reference("scene", "scene", scenes.size()).value_or(0);
    std::string there;
    for (size_t i = 0; i < scenes.size(); ++i) {
        const std::string name = scenes[i].string("name");
        if (name == wanted) return i;
        there += fmt::format("{}{}{}", i == 0 ? "" : ", ", i, name.empty() ? "" : " " + shown(name));
    }
    size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc() && end == wanted.data() + wanted.size() && index < scenes.size()) return index;
    root.fail(fmt::format("scene {}: does not exist, expected one of: {}", shown(wanted), there));
}

std::vector<PlacedNode> placeNodes(const JsonObject& root, size_t scene, Warnings& warnings) {
    const std::vector<JsonObject> nodes = root.objects("nodes", "node");
    std::vector<PlacedNode> placed, pending;
    // A stack: depth first, siblings in their order.
    const auto push = [&](const std::vector<size_t>& children, const glm::dmat4& parent) {
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            pending.push_back({*child, parent, parent});
    };
    push(root.objects("scenes", "scene")[scene].references("nodes", "node", nodes.size()), glm::dmat4(1));
    while (!pending.empty()) {
        PlacedNode node = pending.back();
        pending.pop_back();
        const LocalTransform local = readTransform(nodes[node.index], warnings);
        node.unscaled = node.world * local.unscaled;
        node.world = node.world * local.full;
        placed.push_back(node);
        push(nodes[node.index].references("children", "node", nodes.size()), node.world);
    }
    return placed;
}

std::string objectName(const JsonObject& node, const std::string& fallback, const char* kind, size_t index) {
    std::string name = node.string("name");
    if (name.empty()) name = fallback;
    return name.empty() ? fmt::format("{} {}", kind, index) : name;
}

std::optional<JsonObject> lsdeExtras(const JsonObject& object, std::initializer_list<std::string_view> known,
                                     Warnings& warnings) {
    const auto extras = object.extras();
    auto lsde = extras ? extras->object("lsde") : std::nullopt;
    if (lsde)
        for (const auto& [key, value] : lsde->json().items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                warnings.add(fmt::format("{} is unknown and ignored", shown(key)), lsde->where());
    return lsde;
}

CausticSwitches readSwitches(const JsonObject& node, Warnings& warnings) {
    CausticSwitches switches;
    const auto extras = lsdeExtras(node, {"castsCaustics", "receivesCaustics", "aim"}, warnings);
    if (!extras) return switches;
    switches.casts = extras->boolean("castsCaustics", true);
    switches.receives = extras->boolean("receivesCaustics", true);
    switches.aim = extras->boolean("aim", true);
    return switches;
}

}  // namespace lsde
