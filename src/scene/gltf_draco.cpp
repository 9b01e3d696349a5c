// The one file that includes Draco.
#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <array>

#include "base/error.h"
#include "scene/gltf_compression.h"

namespace lsde {

namespace {

constexpr const char* kDamaged = "its Draco data are damaged";

std::unique_ptr<draco::Mesh> decodeMesh(std::span<const unsigned char> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    try {
        auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
        if (mesh.ok() && mesh.value() != nullptr) return std::move(mesh).value();
    } catch (const std::exception&) {
        // Sizes that no memory could hold.
    }
    throw Error(kDamaged);
}

template <typename T>
void append(std::string& bytes, const T* values, size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

template <typename T>
void convert(const draco::PointAttribute& attribute, DracoTarget& target) {
    std::array<T, 4> element{};
    if (!attribute.is_mapping_identity() && attribute.indices_map_size() < target.count) throw Error(kDamaged);
    for (uint32_t point = 0; point < target.count; ++point) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(point));
        if (value.value() >= attribute.size()) throw Error(kDamaged);
        if (!attribute.ConvertValue<T>(value, static_cast<int8_t>(target.components), element.data()))
            throw Error(fmt::format("Draco attribute {} does not fit its accessor's format", target.attribute));
        append(target.bytes, element.data(), target.components);
    }
}

void convertTo(const draco::PointAttribute& attribute, DracoTarget& target) {
    switch (target.componentType) {
        case 5120:
            return convert<int8_t>(attribute, target);
        case 5121:
            return convert<uint8_t>(attribute, target);
        case 5122:
            return convert<int16_t>(attribute, target);
        case 5123:
            return convert<uint16_t>(attribute, target);
        case 5125:
            return convert<uint32_t>(attribute, target);
        default:
            return convert<float>(attribute, target);
    }
}

template <typename T>
void appendFaces(const draco::Mesh& mesh, std::string& bytes) {
    for (uint32_t f = 0; f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(f))) {
            const auto index = static_cast<T>(corner.value());
            append(bytes, &index, 1);
        }
}

}  // namespace

void decodeDraco(std::span<const unsigned char> bytes, std::span<DracoTarget> attributes, DracoTarget* indices) {
    const std::unique_ptr<draco::Mesh> mesh = decodeMesh(bytes);
    for (DracoTarget& target : attributes) {
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(target.attribute);
        if (attribute == nullptr)
            throw Error(fmt::format("Draco attribute {} does not exist ({} in its data)", target.attribute,
                                    mesh->num_attributes()));
        if (mesh->num_points() != target.count)
            throw Error(
                fmt::format("{} vertices in its Draco data, but accessors of {}", mesh->num_points(), target.count));
        convertTo(*attribute, target);
    }
    if (indices == nullptr) return;
    if (uint64_t{mesh->num_faces()} * 3 != indices->count)
        throw Error(fmt::format("{} triangles in its Draco data, but {} indices", mesh->num_faces(), indices->count));
    if (indices->componentType == 5121)
        appendFaces<uint8_t>(*mesh, indices->bytes);
    else if (indices->componentType == 5123)
        appendFaces<uint16_t>(*mesh, indices->bytes);
    else
        appendFaces<uint32_t>(*mesh, indices->bytes);
}

}  // namespace lsde
