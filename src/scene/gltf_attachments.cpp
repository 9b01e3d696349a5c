#include "scene/gltf_attachments.h"

#include <fmt/format.h>

#include "base/error.h"
#include "scene/gltf_limits.h"

namespace lsde {

namespace {

// A column of a node's matrix as a unit vector.
Vec3 direction(const JsonObject& node, const glm::dmat4& m, int column) {
    const glm::dvec3 v(m[column]);
    const double length = glm::length(v);
    if (!(length > 0) || !std::isfinite(length))
        node.fail("its matrix is singular: a camera or light has no direction");
    return v / length;
}

Vec3 position(const JsonObject& node, const glm::dmat4& m) {
    const glm::dvec3 p(m[3]);
    for (int c = 0; c < 3; ++c)
        if (!(std::fabs(p[c]) <= kMaxCoordinate))
            node.fail(fmt::format("its camera or light is at {:.4g} {:.4g} {:.4g} m, limit {:g} m", p.x, p.y, p.z,
                                  kMaxCoordinate));
    return p;
}

// Beyond these a picture 1280 pixels wide has no height, or one without bounds.
constexpr Range kAspectRatios{0.02, 1000};

void readResolution(const JsonObject& object, CameraDescription& camera) {
    const auto extras = object.extras();
    if (!extras || !extras->has("resolution")) return;
    const std::vector<double> size = extras->numbers("resolution", 2, {}, {1, kMaxPictureSide});
    if (size[0] != std::floor(size[0]) || size[1] != std::floor(size[1]))
        extras->fail(fmt::format("resolution {}, expected whole numbers", shown(extras->json()["resolution"])));
    if (size[0] * size[1] > kMaxPicturePixels)
        extras->fail(
            fmt::format("resolution {}, limit {} pixels", shown(extras->json()["resolution"]), kMaxPicturePixels));
    camera.resolution = {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

void readPerspective(const JsonObject& object, CameraDescription& camera) {
    object.require("perspective");
    const JsonObject lens = object.object("perspective").value();
    lens.require("yfov");
    lens.require("znear");
    camera.yfov = static_cast<float>(lens.number("yfov", 0, {0, 3.14159, true, true}));
    if (lens.has("aspectRatio")) camera.aspectRatio = static_cast<float>(lens.number("aspectRatio", 0, kAspectRatios));
    camera.znear = static_cast<float>(lens.number("znear", 0, kPositive));
    lens.number("zfar", 1, kPositive);
}

void readOrthographic(const JsonObject& object, CameraDescription& camera) {
    object.require("orthographic");
    const JsonObject lens = object.object("orthographic").value();
    for (const char* key : {"xmag", "ymag", "znear", "zfar"}) lens.require(key);
    camera.kind = CameraKind::Orthographic;
    camera.xmag = static_cast<float>(lens.number("xmag", 0));
    camera.ymag = static_cast<float>(lens.number("ymag", 0));
    for (const float mag : {camera.xmag, camera.ymag})
        if (!(std::fabs(mag) > 0))
            lens.fail(fmt::format("xmag {}, ymag {}, expected other than 0", camera.xmag, camera.ymag));
    if (!kAspectRatios.contains(std::fabs(camera.xmag / camera.ymag)))
        lens.fail(fmt::format("xmag {}, ymag {}, expected a ratio in [{}, {}]", camera.xmag, camera.ymag,
                              kAspectRatios.lo, kAspectRatios.hi));
    camera.znear = static_cast<float>(lens.number("znear", 0, kNotNegative));
    lens.number("zfar", 1, kPositive);
}

void readThinLens(const JsonObject& object, CameraDescription& camera, Warnings& warnings) {
    const auto extras = lsdeExtras(object, {"lensRadius", "focusDistance"}, warnings);
    if (!extras) return;
    camera.lensRadius = static_cast<float>(extras->number("lensRadius", 0, kNotNegative));
    if (camera.lensRadius > 0) {
        if (camera.kind != CameraKind::Perspective) extras->fail("lensRadius, expected only with a perspective camera");
        extras->require("focusDistance");
        camera.kind = CameraKind::ThinLens;
    }
    camera.focusDistance = static_cast<float>(extras->number("focusDistance", 1, kPositive));
}

CameraDescription readCamera(const JsonObject& object, Warnings& warnings) {
    CameraDescription camera;
    camera.name = object.string("name");
    object.require("type");
    const std::string type = object.string("type");
    if (type == "perspective")
        readPerspective(object, camera);
    else if (type == "orthographic")
        readOrthographic(object, camera);
    else
        object.fail(fmt::format("type {}, expected \"perspective\" or \"orthographic\"", shown(type)));
    readThinLens(object, camera, warnings);
    readResolution(object, camera);
    return camera;
}

void placeCamera(const JsonObject& node, const glm::dmat4& frame, CameraDescription& camera) {
    camera.position = position(node, frame);
    camera.back = direction(node, frame, 2);
    const Vec3 up = direction(node, frame, 1), right = direction(node, frame, 0);
    const Vec3 across = glm::cross(up, camera.back);
    if (!(lengthSquared(across) > 1e-12F)) node.fail("its matrix is singular: a camera has no direction");
    camera.right = glm::normalize(across);
    camera.up = glm::cross(camera.back, camera.right);
    // Mirrored above this node: so is the picture, by the right-hand axis.
    if (glm::dot(camera.right, right) < 0) camera.right = -camera.right;
    // A negative half size mirrors as well.
    if (camera.xmag < 0) camera.right = -camera.right;
    if (camera.ymag < 0) camera.up = -camera.up;
    camera.xmag = std::fabs(camera.xmag);
    camera.ymag = std::fabs(camera.ymag);
}

// None for a type that the extension does not know.
std::optional<PunctualLight> readLight(const JsonObject& object, Warnings& warnings) {
    object.require("type");
    const std::string type = object.string("type");
    PunctualLight light;
    light.name = object.string("name");
    const std::vector<double> color = object.numbers("color", 3, {1, 1, 1}, kUnitInterval);
    light.intensity =
        Rgb(color[0], color[1], color[2]) * static_cast<float>(object.number("intensity", 1, kNotNegative));
    if (object.has("range")) {
        object.number("range", 1, kPositive);
        warnings.add("a light's range is ignored: light falls off by the inverse square at any distance",
                     object.where());
    }
    if (type == "directional") {
        light.kind = PunctualKind::Directional;
    } else if (type == "spot") {
        light.kind = PunctualKind::Spot;
        object.require("spot");
        const JsonObject spot = object.object("spot").value();
        const double outer = spot.number("outerConeAngle", kPi / 4, {0, 1.5707964, true});
        const double inner = spot.number("innerConeAngle", 0, {0, outer, false, true});
        light.outerConeAngle = static_cast<float>(outer);
        light.innerConeAngle = static_cast<float>(inner);
    } else if (type != "point") {
        warnings.add(fmt::format("light of unknown type {} left out", shown(type)), object.where());
        return {};
    }
    return light;
}

}  // namespace

GltfAttachments readAttachments(const JsonObject& root, Warnings& warnings) {
    GltfAttachments out;
    for (const JsonObject& object : root.objects("cameras", "camera", true))
        out.cameras.push_back(readCamera(object, warnings));
    if (const auto extension = root.extension("KHR_lights_punctual"))
        for (const JsonObject& object : extension->objects("lights", "light", true))
            out.lights.push_back(readLight(object, warnings));
    return out;
}

std::vector<CameraDescription> placeCameras(const GltfAttachments& attachments, const JsonObject& root,
                                            const std::vector<PlacedNode>& placed) {
    const std::vector<JsonObject> nodes = root.objects("nodes", "node");
    std::vector<CameraDescription> out;
    for (const PlacedNode& p : placed) {
        const JsonObject& node = nodes[p.index];
        const auto index = node.reference("camera", "camera", attachments.cameras.size());
        if (!index) continue;
        CameraDescription camera = attachments.cameras[*index];
        camera.name = objectName(node, camera.name, "camera", *index);
        placeCamera(node, p.unscaled, camera);
        out.push_back(std::move(camera));
    }
    return out;
}

void placeLight(const JsonObject& node, const glm::dmat4& frame, PunctualLight& light) {
    light.position = position(node, frame);
    if (light.kind == PunctualKind::Point) return;
    light.direction = -direction(node, frame, 2);
    if (light.kind != PunctualKind::Measured) return;
    // Right angles where shear left none; mirrored where the node is.
    const Vec3 right = direction(node, frame, 0), up = direction(node, frame, 1);
    const Vec3 across = right - glm::dot(right, light.direction) * light.direction;
    if (!(lengthSquared(across) > 1e-12F)) node.fail("its matrix is singular: a light has no direction");
    light.right = glm::normalize(across);
    light.up = glm::cross(light.right, light.direction);
    if (glm::dot(light.up, up) < 0) light.up = -light.up;
}

std::vector<PunctualLight> placeLights(const GltfAttachments& attachments, const JsonObject& root,
                                       const std::vector<PlacedNode>& placed) {
    const std::vector<JsonObject> nodes = root.objects("nodes", "node");
    std::vector<PunctualLight> out;
    for (const PlacedNode& p : placed) {
        const JsonObject& node = nodes[p.index];
        const auto use = node.extension("KHR_lights_punctual");
        const auto index = use ? use->reference("light", "light", attachments.lights.size()) : std::nullopt;
        if (!index || !attachments.lights[*index]) continue;
        PunctualLight light = *attachments.lights[*index];
        light.name = objectName(node, light.name, "light", *index);
        placeLight(node, p.unscaled, light);
        out.push_back(std::move(light));
    }
    return out;
}

}  // namespace lsde
