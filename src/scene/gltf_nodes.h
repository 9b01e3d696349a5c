// The scene's hierarchy, flattened to the world matrices of its nodes. From the raw JSON of a validated file.
#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf_json.h"
#include "scene/mesh.h"
#include "scene/warnings.h"

namespace lsde {

struct PlacedNode {
    size_t index = 0;        // in the file
    glm::dmat4 world{1};     // node to world
    glm::dmat4 unscaled{1};  // the same without the node's own scale, which turns neither cameras nor lights
};

// The scene that `wanted` names, by name or index; empty: the file's default, else the first. Throws Error naming those
// there are.
size_t chooseScene(const JsonObject& root, const std::string& wanted);

// All nodes of a scene, parents before children, in the order of the file's lists.
std::vector<PlacedNode> placeNodes(const JsonObject& root, size_t scene, Warnings& warnings);

// The node's name, else the fallback (what hangs on the node), else "KIND INDEX".
std::string objectName(const JsonObject& node, const std::string& fallback, const char* kind, size_t index);

// extras.lsde, if there is one. A key other than the known ones gets a warning.
std::optional<JsonObject> lsdeExtras(const JsonObject& object, std::initializer_list<std::string_view> known,
                                     Warnings& warnings);

// extras.lsde of a node that has a mesh.
CausticSwitches readSwitches(const JsonObject& node, Warnings& warnings);

}  // namespace lsde
