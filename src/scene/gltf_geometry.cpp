#include "scene/gltf_geometry.h"

#include <fmt/format.h>

#include <numeric>

#include "base/error.h"

namespace lsde {

namespace {

constexpr int kFirstTriangleMode = static_cast<int>(PrimitiveMode::Triangles);

// Elements of an attribute for these vertices; nothing if it is not among them.
template <typename T>
std::vector<T> readAttribute(const GltfModel& model, const std::map<std::string, int>& attributes, const char* name,
                             const std::vector<uint32_t>& vertices) {
    std::vector<T> out;
    const auto at = attributes.find(name);
    if (at == attributes.end()) return out;
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

const std::vector<LoadedPrimitive>& GeometryLoader::mesh(size_t index, const std::vector<double>& weights) {
    const auto [at, added] = meshes_.try_emplace({index, weights});
    if (added)
        for (size_t p = 0; p < model_.meshes[index].size(); ++p)
            addPrimitive(at->second, model_.meshes[index][p], weights, fmt::format("mesh {} primitive {}", index, p));
    return at->second;
}

void GeometryLoader::addPrimitive(std::vector<LoadedPrimitive>& out, const GltfPrimitive& primitive,
                                  const std::vector<double>& weights, const std::string& where) {
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
    readVertices(primitive, weights, loaded.data);
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

void GeometryLoader::readVertices(const GltfPrimitive& primitive, const std::vector<double>& weights,
                                  PrimitiveData& data) {
    const std::vector<uint32_t> used =
        selector_.select(data.triangles, accessor(primitive.attributes.at("POSITION")).count);
    data.positions = readAttribute<Vec3>(model_, primitive.attributes, "POSITION", used);
    data.normals = readAttribute<Vec3>(model_, primitive.attributes, "NORMAL", used);
    data.tangents = readAttribute<Vec4>(model_, primitive.attributes, "TANGENT", used);
    data.texCoords[0] = readAttribute<Vec2>(model_, primitive.attributes, "TEXCOORD_0", used);
    data.texCoords[1] = readAttribute<Vec2>(model_, primitive.attributes, "TEXCOORD_1", used);
    data.colors = readAttribute<Vec4>(model_, primitive.attributes, "COLOR_0", used);
    if (!data.colors.empty() && accessor(primitive.attributes.at("COLOR_0")).components == 3)
        for (Vec4& color : data.colors) color.w = 1;
    for (size_t t = 0; t < std::min(weights.size(), primitive.targets.size()); ++t)
        if (weights[t] != 0) morph(primitive.targets[t], static_cast<float>(weights[t]), used, data);
}

// Adds a target's share to positions and normals (glTF 2.0, section 3.7.2.2).
void GeometryLoader::morph(const std::map<std::string, int>& target, float weight,
                           const std::vector<uint32_t>& vertices, PrimitiveData& data) {
    const auto add = [&](const char* name, std::vector<Vec3>& values) {
        const std::vector<Vec3> deltas = readAttribute<Vec3>(model_, target, name, vertices);
        for (size_t i = 0; i < std::min(values.size(), deltas.size()); ++i) values[i] += weight * deltas[i];
    };
    add("POSITION", data.positions);
    add("NORMAL", data.normals);
    // Sums are of any length; zero stays zero, for the builder to make flat.
    for (Vec3& n : data.normals)
        if (const float length = glm::length(n); length > 0) n /= length;
    for (const auto& [name, accessor] : target)
        if (name != "POSITION" && name != "NORMAL")
            warnings_.add(fmt::format("morph targets of {} are not shown", name), data.where);
}

}  // namespace lsde
