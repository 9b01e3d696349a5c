#include "scene/gltf_instances.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace lsde {

namespace {

// The extension's attributes, if there are any of the three that place instances.
std::optional<JsonObject> placingAttributes(const JsonObject& node) {
    const auto extension = node.extension("EXT_mesh_gpu_instancing");
    auto attributes = extension ? extension->object("attributes") : std::nullopt;
    if (!attributes) return {};
    const bool places = std::any_of(kInstanceAttributes.begin(), kInstanceAttributes.end(),
                                    [&](const char* name) { return attributes->has(name); });
    return places ? attributes : std::nullopt;
}

const GltfAccessor* accessorOf(const JsonObject& attributes, const char* name, const GltfModel& model) {
    const auto index = attributes.reference(name, "accessor", model.accessors.size());
    if (!index) return nullptr;
    const GltfAccessor& accessor = model.accessors[*index];
    accessor.checkSparse();
    return &accessor;
}

std::array<float, 4> valueOf(const GltfAccessor* accessor, size_t i, std::array<float, 4> fallback) {
    return accessor == nullptr ? fallback : accessor->floats(i);
}

}  // namespace

uint64_t instanceCount(const JsonObject& node, const GltfModel& model) {
    const auto attributes = placingAttributes(node);
    if (!attributes) return 1;
    for (const char* name : kInstanceAttributes)
        if (const auto index = attributes->reference(name, "accessor", model.accessors.size()))
            return model.accessors[*index].count;
    return 1;
}

std::vector<glm::dmat4> readInstances(const JsonObject& node, const GltfModel& model) {
    const auto attributes = placingAttributes(node);
    if (!attributes) return {glm::dmat4(1)};
    const GltfAccessor* translation = accessorOf(*attributes, kInstanceAttributes[0], model);
    const GltfAccessor* rotation = accessorOf(*attributes, kInstanceAttributes[1], model);
    const GltfAccessor* scale = accessorOf(*attributes, kInstanceAttributes[2], model);
    const uint64_t count = instanceCount(node, model);
    std::vector<glm::dmat4> out;
    out.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        const auto t = valueOf(translation, i, {0, 0, 0, 0});
        const auto q = valueOf(rotation, i, {0, 0, 0, 1});
        const auto s = valueOf(scale, i, {1, 1, 1, 0});
        const glm::dquat r(q[3], q[0], q[1], q[2]);
        if (!(glm::length(r) > 0))
            node.fail(fmt::format("ROTATION of instance {} is 0, expected a unit quaternion", i));
        out.push_back(glm::scale(glm::translate(glm::dmat4(1), {t[0], t[1], t[2]}) * glm::mat4_cast(glm::normalize(r)),
                                 {s[0], s[1], s[2]}));
    }
    return out;
}

}  // namespace lsde
