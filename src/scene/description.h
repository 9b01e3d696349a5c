// What a scene file says, before anything is built from it. The loader's result; Scene's input.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "scene/ies_profile.h"
#include "scene/material.h"
#include "scene/mesh.h"
#include "scene/texture.h"

namespace lsde {

enum class PunctualKind : uint8_t { Point, Spot, Directional, Measured };

// KHR_lights_punctual and EXT_lights_ies in world space; the node's scale changes neither direction nor power.
struct PunctualLight {
    std::string name;  // the node's name, else the light's, else "light N"
    PunctualKind kind = PunctualKind::Point;
    Rgb intensity{1};  // color x intensity: W/sr (point, spot; measured: at most), W/m2 (directional)
    Vec3 position{0};
    Vec3 direction{0, 0, -1};  // the way the light shines (-Z of the node)
    float innerConeAngle = 0;  // rad
    float outerConeAngle = kPi / 4;
    std::shared_ptr<const IesProfile> profile;  // measured: in a frame of +X and +Y of the node, and of -direction
    Vec3 right{1, 0, 0}, up{0, 1, 0};
};

// Light from all directions; how the picture lies around the scene: scene/environment_map.h.
struct EnvironmentDescription {
    std::string name;
    RgbImage image;  // W/(m2 sr), finite and >= 0, not all black
    float turn = 0;  // rad about +Y
};

// The sun's disc, of even radiance.
struct SunDescription {
    std::string name;
    Vec3 direction{0, 1, 0};  // unit, to it
    float angularRadius = 0;  // rad, > 0
    Rgb radiance{0};          // W/(m2 sr)
};

enum class CameraKind : uint8_t { Perspective, Orthographic, ThinLens };

struct CameraDescription {
    std::string name;  // node's name, else camera's, else "camera N"
    CameraKind kind = CameraKind::Perspective;
    // Camera to world: looks down -Z, +X right, +Y up; orthonormal (the node's scale is divided out).
    Vec3 position{0};
    Vec3 right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1};
    float yfov = 0.8F;                             // rad (perspective, thin lens)
    float aspectRatio = 0;                         // 0: the picture's
    float xmag = 1, ymag = 1;                      // m, half sizes (orthographic)
    float lensRadius = 0;                          // m: extras.lsde.lensRadius (thin lens if > 0)
    float focusDistance = 1;                       // m: extras.lsde.focusDistance
    float znear = 0;                               // m; kept, not used to clip
    std::optional<std::array<int, 2>> resolution;  // extras.resolution
};

struct SceneDescription {
    std::filesystem::path file;
    std::string sceneName;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;  // at least one: index 0.. as in the file, then the default material if used
    std::vector<Texture> textures;
    std::vector<PunctualLight> lights;
    // From beyond the scene; not in the file: added by what the user asks for.
    std::optional<EnvironmentDescription> environment;
    std::optional<SunDescription> sun;
    std::vector<CameraDescription> cameras;  // of the chosen scene
    std::vector<std::string> variants;       // names of KHR_materials_variants there are
    std::vector<std::string> warnings;       // each one line, already counted
};

}  // namespace lsde
