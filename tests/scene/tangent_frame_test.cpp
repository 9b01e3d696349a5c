// Normal textures, and the tangents that they lie along.
#include "scene/tangent_frame.h"

#include <doctest/doctest.h>

#include "scene/gltf_file.h"
#include "support/near.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;
using doctest::Approx;

namespace {

Texture oneTexel(uint8_t x, uint8_t y, uint8_t z) {
    Texture t;
    t.width = t.height = 1;
    t.rgba = {x, y, z, 255};
    return t;
}

// (0,0,0) to (1,1,0), front +z, u to the right and v downwards as in a picture.
Mesh pictureSquare() {
    Mesh m = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    m.texCoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    return m;
}

Surface surfaceOf(Mesh mesh, Texture normals, float scale = 1) {
    SceneDescription d;
    d.meshes = {std::move(mesh)};
    d.materials = {lambert(Rgb(0.5F))};
    d.materials[0].normalTexture.texture = 0;
    d.materials[0].normalScale = scale;
    d.textures = {std::move(normals)};
    const Scene scene(std::move(d));
    Hit hit;
    REQUIRE(scene.accel().intersect({{0.3F, 0.4F, 1}, {0, 0, -1}, kInfinity}, hit));
    return scene.surface(hit);
}

}  // namespace

TEST_CASE("red bends the normal along the picture's rows, green up its columns, blue leaves it") {
    // 204 / 255 = 0.8: 0.6 along the axis. 230 / 255: about 0.8 along the normal.
    checkNear(surfaceOf(pictureSquare(), oneTexel(204, 128, 230)).ns,
              glm::normalize(Vec3(0.6F, 1 / 255.0F, 205 / 255.0F)));
    checkNear(surfaceOf(pictureSquare(), oneTexel(128, 204, 230)).ns,
              glm::normalize(Vec3(1 / 255.0F, 0.6F, 205 / 255.0F)));
    checkNear(surfaceOf(pictureSquare(), oneTexel(204, 128, 230)).ng, {0, 0, 1});
    Mesh mirrored = pictureSquare();
    for (Vec2& uv : mirrored.texCoords[0]) uv.x = 1 - uv.x;
    const Vec3 n = surfaceOf(mirrored, oneTexel(204, 204, 230)).ns;
    CHECK(n.x < -0.3F);
    CHECK(n.y > 0.3F);
}

TEST_CASE("the scale multiplies red and green alone") {
    const Vec3 n = surfaceOf(pictureSquare(), oneTexel(204, 204, 255), 0.5F).ns;
    CHECK(n.x / n.z == Approx(0.3));
    CHECK(n.y / n.z == Approx(0.3));
    CHECK(surfaceOf(pictureSquare(), oneTexel(204, 204, 255), -1).ns.x < -0.3F);
}

TEST_CASE("a normal that a texture bends behind the face, or to nothing, is left as it was") {
    for (const Texture& t : {oneTexel(255, 128, 0), oneTexel(128, 128, 0)})
        checkNear(surfaceOf(pictureSquare(), t).ns, {0, 0, 1});
}

TEST_CASE("given tangents take the place of texture coordinates, at right angles to the normal") {
    Mesh m = pictureSquare();
    m.tangents.assign(4, Vec4(0, 1, 0.5F, -1));
    const TangentFrame frame = tangentFrame(m, m.triangles[0], 0.2F, 0.3F, {0, 0, 1}, 0);
    checkNear(frame.tangent, {0, 1, 0});
    checkNear(frame.bitangent, {1, 0, 0});
    m.tangents.assign(4, Vec4(0, 0, 0, 1));  // says nothing
    checkNear(tangentFrame(m, m.triangles[0], 0.2F, 0.3F, {0, 0, 1}, 0).tangent, {1, 0, 0});
}

TEST_CASE("without anything to tell them, tangents are some pair at right angles") {
    Mesh m = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    for (const bool textured : {false, true}) {
        if (textured) m.texCoords[0].assign(4, Vec2(0.5F));
        const TangentFrame frame = tangentFrame(m, m.triangles[0], 0.2F, 0.3F, {0, 0, 1}, 0);
        CHECK(glm::length(frame.tangent) == Approx(1));
        CHECK(glm::dot(frame.tangent, frame.bitangent) == Approx(0));
        CHECK(frame.tangent.z == 0);
    }
}

TEST_CASE(
    "a file's tangents turn with their node, mirrored ones too, and are kept where a normal texture asks for them") {
    GltfFile file = triangleFileWith({{"normalTexture", {{"index", 0}, {"scale", 0.5}}}});
    const size_t tangents = file.accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
    const size_t uvs = file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    file["/meshes/0/primitives/0/attributes/TANGENT"] = tangents;
    file["/meshes/0/primitives/0/attributes/TEXCOORD_0"] = uvs;
    file.json["textures"] = {{{"source", 0}}};
    // A white texel, as PNG.
    file.json["images"] = {{{"uri",
                             "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4//8/"
                             "AAX+Av4N70a4AAAAAElFTkSuQmCC"}}};
    file["/nodes/0/scale"] = {1, 1, -2};
    file["/nodes/0/rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // a quarter turn about z
    const SceneDescription scene = load(file);
    CHECK(scene.materials[0].normalScale == 0.5F);
    REQUIRE(scene.meshes[0].tangents.size() == 3);
    checkNear(Vec3(scene.meshes[0].tangents[0]), {0, 1, 0});
    CHECK(scene.meshes[0].tangents[0].w == -1);
    file.json["materials"][0].erase("normalTexture");
    CHECK(load(file).meshes[0].tangents.empty());
}
