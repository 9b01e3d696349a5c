#include "scene/mesh_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <limits>
#include <map>

#include "base/error.h"
#include "scene/gltf_limits.h"
#include "scene/joined_vertices.h"

namespace lsde {

namespace {

// Columns of the matrix by which areas, and so normals, are transformed: det(M) M^-T, finite for singular matrices too.
glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

// Whether the square of the area is a normal float, so that the face has a normal in single precision.
bool hasNormal(const Mesh& mesh, const Triangle& t) {
    const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    return lengthSquared(glm::cross(b - a, c - a)) >= FLT_MIN;
}

Vec3 faceNormal(const Mesh& mesh, const Triangle& t) {
    const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    return glm::normalize(glm::cross(b - a, c - a));
}

void placePositions(const PrimitiveData& primitive, const glm::dmat4& world, Mesh& mesh) {
    mesh.positions.reserve(primitive.positions.size());
    for (size_t i = 0; i < primitive.positions.size(); ++i) {
        const glm::dvec3 p(world * glm::dvec4(glm::dvec3(primitive.positions[i]), 1));
        for (int c = 0; c < 3; ++c)
            if (!(std::fabs(p[c]) <= kMaxCoordinate))
                throw Error(fmt::format("{}: {}: a vertex at {:.4g} {:.4g} {:.4g} m, limit {:g} m", primitive.file,
                                        primitive.where, p.x, p.y, p.z, kMaxCoordinate));
        mesh.positions.emplace_back(p);
    }
}

// Unit normals; zero where the file's is (for flattenWithoutNormal) or where the matrix makes it so.
void placeNormals(const PrimitiveData& primitive, const glm::dmat4& world, Mesh& mesh, Warnings& warnings) {
    // Khronos' validator allows as much: normals in 8 bits are off by less.
    constexpr float kUnitTolerance = 0.00674F;
    const glm::dmat3 linear(world);
    const glm::dmat3 transform = cofactors(linear) * (glm::determinant(linear) < 0 ? -1.0 : 1.0);
    uint64_t notUnit = 0;
    mesh.normals.reserve(primitive.normals.size());
    for (const Vec3 n : primitive.normals) {
        const float length = glm::length(n);
        notUnit += length > 0 && std::fabs(length - 1) > kUnitTolerance ? 1 : 0;
        const glm::dvec3 transformed = transform * glm::dvec3(n);
        const double scale = glm::length(transformed);
        mesh.normals.emplace_back(scale > 0 && std::isfinite(scale) ? Vec3(transformed / scale) : Vec3(0));
    }
    if (notUnit > 0) warnings.add("normals are not of unit length: normalised", primitive.where, notUnit);
}

// Tangents lie in the surface and turn with it; a mirroring node turns the bitangents' side over.
void placeTangents(const PrimitiveData& primitive, const glm::dmat4& world, Mesh& mesh) {
    const glm::dmat3 linear(world);
    const float side = glm::determinant(linear) < 0 ? -1.0F : 1.0F;
    mesh.tangents.reserve(primitive.tangents.size());
    for (const Vec4 tangent : primitive.tangents) {
        const glm::dvec3 placed = linear * glm::dvec3(tangent);
        const double length = glm::length(placed);
        // One of no length says nothing: 0 makes the surface's own be found from its texture coordinates.
        mesh.tangents.emplace_back(length > 0 ? Vec3(placed / length) : Vec3(0), std::copysign(side, side * tangent.w));
    }
}

// Triangles with a vertex whose normal is zero get vertices of their own, with the face's normal.
void flattenWithoutNormal(Mesh& mesh, const std::string& where, Warnings& warnings) {
    uint64_t flattened = 0;
    const auto isZero = [&](uint32_t v) { return mesh.normals[v] == Vec3(0); };
    for (Triangle& t : mesh.triangles) {
        if (std::none_of(t.begin(), t.end(), isZero)) continue;
        ++flattened;
        const Vec3 normal = faceNormal(mesh, t);
        for (uint32_t& vertex : t) {
            const uint32_t from = vertex;
            vertex = static_cast<uint32_t>(mesh.positions.size());
            mesh.positions.push_back(Vec3(mesh.positions[from]));
            mesh.normals.push_back(normal);
            if (!mesh.tangents.empty()) mesh.tangents.push_back(Vec4(mesh.tangents[from]));
            for (auto& uvs : mesh.texCoords)
                if (!uvs.empty()) uvs.push_back(Vec2(uvs[from]));
            if (!mesh.colors.empty()) mesh.colors.push_back(Vec4(mesh.colors[from]));
        }
    }
    if (flattened > 0) warnings.add("normals are zero: triangles rendered flat", where, flattened);
}

template <typename T>
std::vector<T> gather(const std::vector<T>& from, const std::vector<uint32_t>& elements) {
    std::vector<T> out;
    if (from.empty()) return out;
    out.reserve(elements.size());
    for (const uint32_t e : elements) out.push_back(from[e]);
    return out;
}

// Vertices that no triangle uses would enlarge the bounds.
void dropUnusedVertices(Mesh& mesh) {
    const std::vector<uint32_t> used = VertexSelector().select(mesh.triangles, mesh.positions.size());
    mesh.positions = gather(mesh.positions, used);
    mesh.normals = gather(mesh.normals, used);
    mesh.tangents = gather(mesh.tangents, used);
    for (auto& uvs : mesh.texCoords) uvs = gather(uvs, used);
    mesh.colors = gather(mesh.colors, used);
}

struct EdgeUse {
    uint64_t key;
    uint32_t mesh;
    bool operator<(const EdgeUse& b) const { return key < b.key; }
};

// Adds one to a mesh's openEdges for each edge that one triangle of all these meshes has alone. Returns their number.
uint64_t countOpenEdgesOf(std::vector<Mesh>& meshes, const std::vector<uint32_t>& solid) {
    JoinedVertices joined;
    std::vector<EdgeUse> uses;
    for (const uint32_t m : solid)
        for (const Triangle& t : meshes[m].triangles) {
            std::array<uint32_t, 3> v;
            for (size_t i = 0; i < 3; ++i) v[i] = joined.id(meshes[m].positions[t[i]]);
            for (size_t i = 0; i < 3; ++i) uses.push_back({edgeKey(v[i], v[(i + 1) % 3]), m});
        }
    std::sort(uses.begin(), uses.end());
    uint64_t open = 0;
    for (size_t i = 0, end = 0; i < uses.size(); i = end) {
        while (end < uses.size() && uses[end].key == uses[i].key) ++end;
        if (end - i > 1) continue;
        ++meshes[uses[i].mesh].openEdges;
        ++open;
    }
    return open;
}

}  // namespace

uint64_t triangleCount(PrimitiveMode mode, uint64_t corners) {
    if (mode == PrimitiveMode::Triangles) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
}

std::vector<Triangle> assembleTriangles(PrimitiveMode mode, std::span<const uint32_t> corners) {
    std::vector<Triangle> triangles;
    triangles.reserve(triangleCount(mode, corners.size()));
    if (mode == PrimitiveMode::Triangles) {
        for (size_t i = 0; i + 2 < corners.size(); i += 3)
            triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
        return triangles;
    }
    for (size_t i = 0; i + 2 < corners.size(); ++i) {
        // Every second triangle of a strip is wound the other way round (glTF 2.0, section 3.7.2.1).
        const size_t flip = mode == PrimitiveMode::Strip ? i % 2 : 0;
        const Triangle t = mode == PrimitiveMode::Fan
                               ? Triangle{corners[i + 1], corners[i + 2], corners[0]}
                               : Triangle{corners[i], corners[i + 1 + flip], corners[i + 2 - flip]};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
    }
    return triangles;
}

std::vector<uint32_t> VertexSelector::select(std::span<Triangle> triangles, size_t vertexCount) {
    constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
    if (numbers_.size() < vertexCount) numbers_.resize(vertexCount, kUnused);
    std::vector<uint32_t> used;
    for (Triangle& t : triangles)
        for (uint32_t& vertex : t) {
            uint32_t& number = numbers_[vertex];
            if (number == kUnused) {
                number = static_cast<uint32_t>(used.size());
                used.push_back(vertex);
            }
            vertex = number;
        }
    for (const uint32_t vertex : used) numbers_[vertex] = kUnused;
    return used;
}

std::optional<Mesh> placePrimitive(const PrimitiveData& primitive, const glm::dmat4& world, Warnings& warnings) {
    Mesh mesh;
    placePositions(primitive, world, mesh);
    placeNormals(primitive, world, mesh, warnings);
    placeTangents(primitive, world, mesh);
    mesh.texCoords = primitive.texCoords;
    mesh.colors = primitive.colors;
    const bool mirrored = glm::determinant(glm::dmat3(world)) < 0;
    uint64_t degenerate = 0;
    mesh.triangles.reserve(primitive.triangles.size());
    for (const Triangle& t : primitive.triangles) {
        const Triangle wound = mirrored ? Triangle{t[0], t[2], t[1]} : t;
        if (hasNormal(mesh, wound))
            mesh.triangles.push_back(wound);
        else
            ++degenerate;
    }
    if (degenerate > 0) warnings.add("degenerate triangles left out", primitive.where, degenerate);
    if (mesh.triangles.empty()) return {};
    if (degenerate > 0) dropUnusedVertices(mesh);
    if (!mesh.normals.empty()) flattenWithoutNormal(mesh, primitive.where, warnings);
    return mesh;
}

void countOpenEdges(std::vector<Mesh>& meshes, std::span<const Material> materials, Warnings& warnings) {
    std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> solids;
    for (uint32_t m = 0; m < meshes.size(); ++m)
        if (materials[meshes[m].material].isSolid()) solids[{meshes[m].node, meshes[m].material}].push_back(m);
    for (const auto& [key, solid] : solids)
        if (const uint64_t open = countOpenEdgesOf(meshes, solid); open > 0)
            warnings.add("open mesh of a solid, so that inside and outside are told by facing alone: open edges",
                         fmt::format("\"{}\"", meshes[solid.front()].object), open);
}

}  // namespace lsde
