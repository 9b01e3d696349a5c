// Animations frozen at a time, and morph targets.
#include <doctest/doctest.h>

#include "scene/gltf_file.h"
#include "scene/scene.h"
#include "support/near.h"

using namespace lsde;
using namespace lsde::test;

namespace {

// The triangle, with one property of its node moved by keys at 1, 2 and 4 s.
GltfFile moving(const std::string& path, size_t output, GltfFile file, const char* interpolation = nullptr) {
    const size_t input = file.accessor<float>({1, 2, 4}, "SCALAR");
    Json sampler = {{"input", input}, {"output", output}};
    if (interpolation != nullptr) sampler["interpolation"] = interpolation;
    file.add("animations",
             {{"samplers", {sampler}}, {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
    return file;
}
GltfFile movingBy(const std::string& path, const std::vector<float>& values, const char* type,
                  const char* interpolation = nullptr) {
    GltfFile file = triangleFile();
    const size_t output = file.accessor<float>(values, type);
    return moving(path, output, file, interpolation);
}

// Corner 1 of the triangle, (1, 0, 0) at rest.
Vec3 cornerAt(const GltfFile& file, std::optional<double> seconds) {
    GltfOptions options;
    options.atSeconds = seconds;
    return load(file, options).meshes.at(0).positions.at(1);
}

}  // namespace

TEST_CASE("a node is where its animation has it at a time, held before the first key and after the last") {
    const GltfFile file = movingBy("translation", {0, 0, 0, 10, 0, 0, 10, 20, 0}, "VEC3");
    checkNear(cornerAt(file, {}), {1, 0, 0});
    checkNear(cornerAt(file, 0), {1, 0, 0});
    checkNear(cornerAt(file, 1.25), {3.5F, 0, 0});
    checkNear(cornerAt(file, 2), {11, 0, 0});
    checkNear(cornerAt(file, 3.5), {11, 15, 0});
    checkNear(cornerAt(file, 100), {11, 20, 0});
    const GltfFile steps = movingBy("translation", {0, 0, 0, 10, 0, 0, 10, 20, 0}, "VEC3", "STEP");
    checkNear(cornerAt(steps, 1.99), {1, 0, 0});
    checkNear(cornerAt(steps, 2), {11, 0, 0});
    checkNear(cornerAt(steps, 3.99), {11, 0, 0});
    checkNear(cornerAt(movingBy("scale", {1, 1, 1, 3, 1, 1, 3, 1, 1}, "VEC3"), 1.5), {2, 0, 0});
}

TEST_CASE("rotations turn at even speed the short way round, in floats or normalised integers") {
    const float s = std::sqrt(0.5F);
    // To 90 degrees about z by the negative quaternion, then to 180.
    const GltfFile file = movingBy("rotation", {0, 0, 0, 1, 0, 0, -s, -s, 0, 0, 1, 0}, "VEC4");
    const auto at = [](double degrees) {
        return Vec3(std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180), 0);
    };
    checkNear(cornerAt(file, 1 + 1.0 / 3), at(30));
    checkNear(cornerAt(file, 2), at(90));
    checkNear(cornerAt(file, 3), at(135));
    GltfFile small = triangleFile();
    const size_t output = small.accessor<int8_t>({0, 0, 0, 127, 0, 0, 127, 0, 0, 0, 127, 0}, "VEC4", true);
    checkNear(cornerAt(moving("rotation", output, small), 1.5), at(90));
}

TEST_CASE("a cubic spline passes its keys with its tangents, scaled by the time between") {
    // Values 0, 1, 1 of x; tangents: after the first key 2 a second, elsewhere 0.
    std::vector<float> values;
    for (const float x : {0.0F, 0.0F, 2.0F, 0.0F, 1.0F, 0.0F, 0.0F, 1.0F, 0.0F}) values.insert(values.end(), {x, 0, 0});
    const GltfFile file = movingBy("translation", values, "VEC3", "CUBICSPLINE");
    checkNear(cornerAt(file, 1), {1, 0, 0});
    // Hermite at the middle: value .5 + tangent 2 / 8.
    checkNear(cornerAt(file, 1.5), {1.75F, 0, 0});
    checkNear(cornerAt(file, 2), {2, 0, 0});
    checkNear(cornerAt(file, 3), {2, 0, 0});
    // Twice as long from the second key: the tangent counts twice.
    values[3 * 5] = 2;
    checkNear(cornerAt(movingBy("translation", values, "VEC3", "CUBICSPLINE"), 3), {2.5F, 0, 0});
}

TEST_CASE("morph targets are added by weight: the mesh's, the node's, or those of an animation") {
    GltfFile file = triangleFile();
    const size_t wide = file.accessor<float>({0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3");
    const size_t deep = file.accessor<float>({0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC3");
    const size_t normals = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const size_t bent = file.accessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    file["/meshes/0/primitives/0/attributes/NORMAL"] = normals;
    file["/meshes/0/primitives/0/targets"] = {{{"POSITION", wide}, {"NORMAL", bent}}, {{"POSITION", deep}}};
    checkNear(cornerAt(file, {}), {1, 0, 0});
    file["/meshes/0/weights"] = {1, 0.5};
    checkNear(cornerAt(file, {}), {2, 0, 0.5F});
    checkNear(load(file).meshes[0].normals[0], glm::normalize(Vec3(1, 0, 1)));
    CHECK(load(file).warnings.empty());
    file["/nodes/0/weights"] = {0, 2};
    checkNear(cornerAt(file, {}), {1, 0, 2});
    const size_t output = file.accessor<float>({0, 0, 1, 0.5, 1, 1}, "SCALAR");
    const GltfFile animated = moving("weights", output, file);
    checkNear(cornerAt(animated, 1.5), {1.5F, 0, 0.25F});
    file["/meshes/0/primitives/0/targets/1/POSITION"] = 1;
    CHECK(contains(refusalOf(file), "target 1: POSITION: accessor 1 is SCALAR of componentType 5123"));
}

TEST_CASE("the scene's hash covers the time only where the scene moves") {
    const auto hashAt = [](const GltfFile& file, std::optional<double> seconds) {
        GltfOptions options;
        options.atSeconds = seconds;
        return hashDescription(load(file, options));
    };
    const GltfFile file = movingBy("translation", {0, 0, 0, 10, 0, 0, 10, 0, 0}, "VEC3");
    CHECK(hashAt(file, 1.5) != hashAt(file, 2));
    CHECK(hashAt(file, 2) == hashAt(file, 3));
    CHECK(hashAt(triangleFile(), 1) == hashAt(triangleFile(), {}));
}

TEST_CASE("animations that contradict themselves are refused, those of other things or twice are told") {
    GltfFile file = movingBy("translation", {0, 0, 0, 10, 0, 0, 10, 20, 0}, "VEC3");
    const auto refusal = [&](const std::string& pointer, const Json& value) {
        GltfFile changed = file;
        changed[pointer] = value;
        return refusalOf(changed);
    };
    CHECK(contains(refusal("/animations/0/channels/0/target/path", "colour"), "path \"colour\", expected translation"));
    CHECK(contains(refusal("/animations/0/channels/0/target/path", "rotation"),
                   "animation 0 sampler 0: output: VEC3 of componentType 5126, expected VEC4 of float for rotation"));
    CHECK(contains(refusal("/animations/0/channels/0/target/node", 7), "node 7 does not exist (1 node)"));
    CHECK(contains(refusal("/animations/0/channels/0/sampler", 1), "sampler 1 does not exist (1 sampler)"));
    CHECK(contains(refusal("/animations/0/samplers/0/interpolation", "ROUND"), "interpolation \"ROUND\", expected"));
    CHECK(
        contains(refusal("/animations/0/samplers/0/interpolation", "CUBICSPLINE"), "3 keys, but 3 values, expected 9"));
    CHECK(contains(refusal("/animations/0/samplers/0/input", 0), "input: VEC3 of componentType 5126"));
    CHECK(contains(refusal("/nodes/0/matrix", std::vector<int>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
                   "moves node 0, which has a matrix"));
    GltfFile backwards = file;
    backwards["/animations/0/samplers/0/input"] = backwards.accessor<float>({1, 3, 2}, "SCALAR");
    CHECK(
        contains(errorOf([&] { cornerAt(backwards, 1); }), "key 2 at 2 s, expected later than the one before at 3 s"));
    file["/animations/0/channels"].push_back(file["/animations/0/channels/0"]);
    file["/animations/0/channels"].push_back({{"sampler", 0}, {"target", {{"path", "pointer"}}}});
    GltfOptions options;
    options.atSeconds = 1;
    const SceneDescription scene = load(file, options);
    CHECK(warnsOnce(scene, "animation 0 channel 1: several animations move the same node: the first is shown"));
    CHECK(warnsOnce(scene, "animation 0 channel 2: an animation of something other than a node is not shown"));
    CHECK(warnsOnce(load(file), "animations: shown at rest (--at SEC shows a time)"));
}
