#include "scene/gltf.h"

#include <fmt/format.h>

#include <set>

#include "base/error.h"
#include "scene/gltf_animation.h"
#include "scene/gltf_attachments.h"
#include "scene/gltf_compression.h"
#include "scene/gltf_geometry.h"
#include "scene/gltf_ies.h"
#include "scene/gltf_material.h"
#include "scene/gltf_model.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_placement.h"
#include "scene/gltf_textures.h"
#include "scene/gltf_validate.h"
#include "scene/gltf_variants.h"

namespace lsde {

namespace {

SceneDescription load(const std::filesystem::path& file, const GltfOptions& options, Warnings& warnings) {
    const std::string name = file.string();
    GltfSource source = readGltfSource(file, warnings);
    Json json = validateGltf(file, source, options.allowOutside, warnings);
    source.json = {};
    const JsonObject root(json, "", name);
    const GltfResources resources{root, file.parent_path(), options.allowOutside};

    if (!options.variant.empty()) chooseVariant(json, name, options.variant);
    SceneDescription scene;
    scene.variants = readVariants(root);
    scene.file = file;
    const std::vector<GltfMaterial> materials = readMaterials(root, warnings);
    for (const GltfMaterial& m : materials) scene.materials.push_back(m.material);
    const GltfAttachments attachments = readAttachments(root, warnings);
    GltfBuffers buffers = readBuffers(resources, source);
    decodeCompressed(json, name, buffers);
    const GltfModel model = parseModel(root, std::move(buffers));
    if (options.atSeconds)
        applyAnimations(json, name, model, *options.atSeconds, warnings);
    else if (root.size("animations") > 0)
        warnings.add("animations: shown at rest (--at SEC shows a time)", "");

    const size_t index = chooseScene(root, options.scene);
    scene.sceneName = root.objects("scenes", "scene")[index].string("name");
    const std::vector<PlacedNode> placed = placeNodes(root, index, warnings);
    scene.cameras = placeCameras(attachments, root, placed);
    scene.lights = placeLights(attachments, root, placed);
    for (PunctualLight& light : placeMeasuredLights(resources, model, placed, warnings))
        scene.lights.push_back(std::move(light));
    GeometryLoader geometry(name, model, warnings);
    placeMeshes(root, placed, materials, geometry, scene, warnings);
    if (scene.meshes.empty()) root.fail(fmt::format("scene {}: no triangles to render", index));
    countOpenEdges(scene.meshes, scene.materials, warnings);
    std::set<uint32_t> used;
    for (const Mesh& mesh : scene.meshes) used.insert(mesh.material);
    scene.textures = loadTextures(resources, model, scene.materials, used, warnings);
    return scene;
}

}  // namespace

SceneDescription loadGltf(const std::filesystem::path& file, const GltfOptions& options) {
    Warnings warnings;
    try {
        SceneDescription scene = load(file, options, warnings);
        scene.warnings = warnings.lines(file.string());
        return scene;
    } catch (const Error&) {
        if (options.onWarning)
            for (const std::string& line : warnings.lines(file.string())) options.onWarning(line);
        throw;
    }
}

}  // namespace lsde
