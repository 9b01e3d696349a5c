#include "scene/gltf_geometry.h"

#include <fmt/format.h>

#include <numeric>

#include "base/error.h"

namespace lsde {

namespace {

constexpr int kFirstTriangleMode = static_cast<int>(PrimitiveMode::Triangles);

// Elements of an attribute for these vertices; nothing if the primitive does not have it.
template <typename T>
std::vector<T> readAttribute(const GltfModel& model, const GltfPrimitive& primitive, const char* name,
                             const std::vector<uint32_t>& vertices) {
    std::vector<T> out;
    const auto at = primitive.attributes.find(name);
    if (at == primitive.attributes.end()) return out;
    const GltfAccessor& accessor = model.accessors[static_cast<size_t>(at->second)];
    accessor.checkSparse();
    out.reserve(vertices.size());
    for (const uint32_t vertex : vertices) {
        const std::array<float, 4> values = accessor.floats(vertex);
        T element(0);
        for (int c = 0; c < T::length(); ++c) element[c] = values[static_cast<size_t>(c)];
        out.push_back(element);
    }
    return out;
}

}  // namespace

uint64_t GeometryLoader::triangles(size_t mesh) const {
    uint64_t sum = 0;
    for (const GltfPrimitive& p : model_.meshes[mesh]) {
        const auto position = p.attributes.find("POSITION");
        if (p.mode >= kFirstTriangleMode && position != p.attributes.end())
            sum += triangleCount(static_cast<PrimitiveMode>(p.mode),
                                 accessor(p.indices >= 0 ? p.indices : position->second).count);
    }
    return sum;
}

const std::vector<LoadedPrimitive>& GeometryLoader::mesh(size_t index) {
    const auto [at, added] = meshes_.try_emplace(index);
    if (added)
        for (size_t p = 0; p < model_.meshes[index].size(); ++p)
            addPrimitive(at->second, model_.meshes[index][p], fmt::format("mesh {} primitive {}", index, p));
    return at->second;
}

void GeometryLoader::addPrimitive(std::vector<LoadedPrimitive>& out, const GltfPrimitive& primitive,
                                  const std::string& where) {
    if (primitive.mode < kFirstTriangleMode) return warnings_.add("points and lines left out", where);
    if (primitive.attributes.count("POSITION") == 0) return warnings_.add("primitive without POSITION left out", where);
    const auto mode = static_cast<PrimitiveMode>(primitive.mode);
    const std::vector<uint32_t> corners = readCorners(primitive, where);
    if (mode == PrimitiveMode::Triangles ? corners.size() % 3 != 0 : corners.size() < 3)
        warnings_.add("corners that complete no triangle left out", where);
    LoadedPrimitive loaded;
    loaded.material = primitive.material;
    loaded.data.file = file_;
    loaded.data.where = where;
    loaded.data.triangles = assembleTriangles(mode, corners);
    if (loaded.data.triangles.empty()) return;
    readVertices(primitive, loaded.data);
    out.push_back(std::move(loaded));
}

std::vector<uint32_t> GeometryLoader::readCorners(const GltfPrimitive& primitive, const std::string& where) const {
    const size_t vertices = accessor(primitive.attributes.at("POSITION")).count;
    std::vector<uint32_t> corners;
    if (primitive.indices < 0) {
        corners.resize(vertices);
        std::iota(corners.begin(), corners.end(), 0U);
        return corners;
    }
    const GltfAccessor& indices = accessor(primitive.indices);
    indices.checkSparse();
    corners.reserve(indices.count);
    for (size_t i = 0; i < indices.count; ++i) {
        corners.push_back(indices.index(i));
        if (corners.back() >= vertices)
            throw Error(
                fmt::format("{}: {}: index {} = {}, but {} vertices", file_, where, i, corners.back(), vertices));
    }
    return corners;
}

void GeometryLoader::readVertices(const GltfPrimitive& primitive, PrimitiveData& data) {
    const std::vector<uint32_t> used =
        selector_.select(data.triangles, accessor(primitive.attributes.at("POSITION")).count);
    data.positions = readAttribute<Vec3>(model_, primitive, "POSITION", used);
    data.normals = readAttribute<Vec3>(model_, primitive, "NORMAL", used);
    data.texCoords[0] = readAttribute<Vec2>(model_, primitive, "TEXCOORD_0", used);
    data.texCoords[1] = readAttribute<Vec2>(model_, primitive, "TEXCOORD_1", used);
    data.colors = readAttribute<Vec4>(model_, primitive, "COLOR_0", used);
    if (!data.colors.empty() && accessor(primitive.attributes.at("COLOR_0")).components == 3)
        for (Vec4& color : data.colors) color.w = 1;
}

}  // namespace lsde
