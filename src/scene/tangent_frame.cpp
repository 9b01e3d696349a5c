#include "scene/tangent_frame.h"

namespace lsde {

namespace {

// The tangent, and w = +-1 of the bitangent w cross(normal, tangent); no length: none known.
Vec4 interpolatedTangent(const Mesh& mesh, const Triangle& t, float u, float v) {
    if (mesh.tangents.empty()) return Vec4(0);
    const Vec3 sum =
        (1 - u - v) * Vec3(mesh.tangents[t[0]]) + u * Vec3(mesh.tangents[t[1]]) + v * Vec3(mesh.tangents[t[2]]);
    return {sum, mesh.tangents[t[0]].w};  // the same at all corners of a triangle, says glTF
}

Vec4 tangentByTexCoords(const Mesh& mesh, const Triangle& t, Vec3 normal, int texCoord) {
    const auto& uvs = mesh.texCoords[static_cast<size_t>(texCoord)];
    if (uvs.empty()) return Vec4(0);
    const Vec3 e1 = mesh.positions[t[1]] - mesh.positions[t[0]], e2 = mesh.positions[t[2]] - mesh.positions[t[0]];
    const Vec2 d1 = uvs[t[1]] - uvs[t[0]], d2 = uvs[t[2]] - uvs[t[0]];
    const float determinant = d1.x * d2.y - d2.x * d1.y;
    if (determinant == 0) return Vec4(0);
    const Vec3 alongU = (d2.y * e1 - d1.y * e2) / determinant, alongV = (d1.x * e2 - d2.x * e1) / determinant;
    // v runs downwards in glTF, the bitangent upwards.
    return {alongU, glm::dot(glm::cross(alongU, alongV), normal) > 0 ? -1.0F : 1.0F};
}

}  // namespace

TangentFrame tangentFrame(const Mesh& mesh, const Triangle& t, float u, float v, Vec3 normal, int texCoord) {
    Vec4 tangent = interpolatedTangent(mesh, t, u, v);
    if (Vec3(tangent) == Vec3(0)) tangent = tangentByTexCoords(mesh, t, normal, texCoord);
    const Vec3 inPlane = Vec3(tangent) - normal * glm::dot(normal, Vec3(tangent));
    const float length = glm::length(inPlane);
    if (!(length > 0)) {
        const Frame any(normal);
        return {any.x, any.y};
    }
    const Vec3 unit = inPlane / length;
    return {unit, tangent.w * glm::cross(normal, unit)};
}

}  // namespace lsde
