#include "scene/gltf_ies.h"

#include "base/error.h"
#include "scene/gltf_attachments.h"
#include "scene/gltf_limits.h"

namespace lsde {

namespace {

struct NamedProfile {
    std::string name;
    std::shared_ptr<const IesProfile> profile;
};

NamedProfile readProfile(const GltfResources& resources, const GltfModel& model, const JsonObject& object,
                         Warnings& warnings) {
    std::string text;
    if (const auto view = object.reference("bufferView", "buffer view", model.views.size())) {
        const auto bytes = model.views[*view];
        text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    } else {
        text = resources.behindUri(object, kMaxProfileBytes);
    }
    try {
        auto profile = std::make_shared<const IesProfile>(text);
        if (profile->tilted())
            warnings.add("TILT of an IES profile is left aside: the lamp shines as if it were level", object.where());
        return {object.string("name"), std::move(profile)};
    } catch (const Error& e) {
        object.fail(e.what());
    }
}

}  // namespace

std::vector<PunctualLight> placeMeasuredLights(const GltfResources& resources, const GltfModel& model,
                                               const std::vector<PlacedNode>& placed, Warnings& warnings) {
    const auto extension = resources.root.extension("EXT_lights_ies");
    if (!extension) return {};
    std::vector<NamedProfile> profiles;
    for (const JsonObject& object : extension->objects("lights", "IES light"))
        profiles.push_back(readProfile(resources, model, object, warnings));
    const std::vector<JsonObject> nodes = resources.root.objects("nodes", "node");
    std::vector<PunctualLight> out;
    for (const PlacedNode& p : placed) {
        const JsonObject& node = nodes[p.index];
        const auto use = node.extension("EXT_lights_ies");
        if (!use) continue;
        const size_t index = use->reference("light", "light", profiles.size()).value();
        const NamedProfile& named = profiles[index];
        PunctualLight light;
        light.kind = PunctualKind::Measured;
        light.name = objectName(node, named.name, "IES light", index);
        const std::vector<double> color = use->numbers("color", 3, {1, 1, 1}, kUnitInterval);
        light.intensity = Rgb(color[0], color[1], color[2]) *
                          (static_cast<float>(use->number("multiplier", 1, kNotNegative)) * named.profile->greatest());
        light.profile = named.profile;
        placeLight(node, p.unscaled, light);
        out.push_back(std::move(light));
    }
    return out;
}

}  // namespace lsde
