// Buffers, buffer views and accessors. All sums are of whole numbers below 2^53 in 64 bits: none overflows.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "scene/gltf_compression.h"
#include "scene/gltf_limits.h"
#include "scene/gltf_uri.h"
#include "scene/gltf_validate_parts.h"

namespace lsde {

namespace {

constexpr auto kLargest = static_cast<int64_t>(kMaxFileBytes);
constexpr int64_t kLargestSparse =
    std::numeric_limits<int32_t>::max();  // what tinygltf keeps of sparse offsets and counts

uint64_t componentBytes(int componentType) {
    switch (componentType) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case 5126:
            return 4;
        default:
            return 0;
    }
}

// Bytes of an element; columns of matrices start at multiples of 4 (glTF 2.0, section 3.6.2.4). 0: no such type.
uint64_t elementBytes(const std::string& type, int componentType) {
    const uint64_t component = componentBytes(componentType);
    if (type == "SCALAR") return component;
    if (type.size() != 4 || type[3] < '2' || type[3] > '4') return 0;
    const auto n = static_cast<uint64_t>(type[3] - '0');
    if (type.starts_with("VEC")) return n * component;
    if (type.starts_with("MAT")) return n * ((n * component + 3) / 4 * 4);
    return 0;
}

// That `count` elements of `bytes` each lie within the view, aligned.
void checkWithin(const GltfChecks& checks, const JsonObject& object, const AccessorInfo& a, uint64_t bytes) {
    const ViewInfo& view = checks.views[*a.view];
    const uint64_t stride = view.stride != 0 ? view.stride : bytes;
    if (stride < bytes)
        object.fail(fmt::format("byteStride {} of its buffer view, but an element has {} bytes", stride, bytes));
    // Both factors are below 2^53 and 2^8; the sum is below 2^63.
    const uint64_t end = a.offset + stride * (a.count - 1) + bytes;
    if (end > view.bytes)
        object.fail(fmt::format("{} elements end at byte {}, but buffer view {} has {} bytes", a.count, end, *a.view,
                                view.bytes));
    const uint64_t alignment = componentBytes(a.componentType);
    if ((view.offset + a.offset) % alignment != 0)
        object.fail(fmt::format("starts at byte {} of its buffer, expected a multiple of {}", view.offset + a.offset,
                                alignment));
}

// Whether the view's data are there, as such or compressed.
bool hasData(const GltfChecks& checks, const JsonObject& view, size_t buffer) {
    const auto meshopt = readMeshoptView(view, checks.buffers.size());
    if (checks.buffers[buffer].hasData || !meshopt) return checks.buffers[buffer].hasData;
    const BufferInfo& compressed = checks.buffers[meshopt->buffer];
    if (meshopt->offset + meshopt->bytes > compressed.bytes)
        view.fail(fmt::format("{}: bytes {} to {}, but buffer {} has {} bytes", kMeshopt, meshopt->offset,
                              meshopt->offset + meshopt->bytes, meshopt->buffer, compressed.bytes));
    return compressed.hasData;
}

// One of the two parts of a sparse accessor: as an accessor of its own. Returns whether its buffer has data.
bool checkSparsePart(const GltfChecks& checks, const JsonObject& part, AccessorInfo a) {
    part.require("bufferView");
    a.view = part.reference("bufferView", "buffer view", checks.views.size());
    a.offset = static_cast<uint64_t>(part.integer("byteOffset", 0, 0, kLargestSparse));
    const ViewInfo& view = checks.views[*a.view];
    if (view.stride != 0)
        part.fail(fmt::format("byteStride {} of its buffer view, expected none for sparse data", view.stride));
    checkWithin(checks, part, a, elementBytes(a.type, a.componentType));
    return view.hasData;
}

void checkSparse(const GltfChecks& checks, const JsonObject& sparse, AccessorInfo& accessor) {
    for (const char* key : {"count", "indices", "values"}) sparse.require(key);
    AccessorInfo part = accessor;
    part.count = static_cast<uint64_t>(
        sparse.integer("count", 1, 1, std::min(kLargestSparse, static_cast<int64_t>(accessor.count))));
    const JsonObject indices = sparse.object("indices").value();
    AccessorInfo indexPart = part;
    indexPart.type = "SCALAR";
    indexPart.componentType = static_cast<int>(indices.integer("componentType", 0, 0, 1 << 16));
    if (indexPart.componentType != 5121 && indexPart.componentType != 5123 && indexPart.componentType != 5125)
        indices.fail(fmt::format("componentType {}, expected 5121, 5123 or 5125", indexPart.componentType));
    accessor.hasData &= checkSparsePart(checks, indices, indexPart);
    accessor.hasData &= checkSparsePart(checks, sparse.object("values").value(), part);
}

AccessorInfo checkAccessor(const GltfChecks& checks, const JsonObject& object) {
    for (const char* key : {"componentType", "count", "type"}) object.require(key);
    AccessorInfo a;
    a.componentType = static_cast<int>(object.integer("componentType", 0, 0, 1 << 16));
    a.type = object.string("type");
    a.count = static_cast<uint64_t>(object.integer("count", 0, 1, kLargest));
    a.offset = static_cast<uint64_t>(object.integer("byteOffset", 0, 0, kLargest));
    a.normalized = object.boolean("normalized", false);
    if (componentBytes(a.componentType) == 0)
        object.fail(fmt::format("componentType {}, expected 5120, 5121, 5122, 5123, 5125 or 5126", a.componentType));
    const uint64_t bytes = elementBytes(a.type, a.componentType);
    if (bytes == 0) object.fail(fmt::format("type {}, expected SCALAR, VEC2-4 or MAT2-4", shown(a.type)));
    if (a.normalized && a.componentType >= 5125)
        object.fail(fmt::format("normalized, expected only with 8 or 16 bits (componentType {})", a.componentType));
    a.view = object.reference("bufferView", "buffer view", checks.views.size());
    if (a.view) {
        checkWithin(checks, object, a, bytes);
        a.hasData = checks.views[*a.view].hasData;
    } else if (a.offset != 0) {
        object.fail("byteOffset without bufferView");
    } else if (a.count > kMaxBareElements) {
        object.fail(fmt::format("{} elements without a buffer view, limit {}", a.count, kMaxBareElements));
    }
    if (const auto sparse = object.object("sparse")) checkSparse(checks, *sparse, a);
    return a;
}

}  // namespace

uint64_t bytesBehindUri(const GltfChecks& checks, const JsonObject& object) {
    const std::string uri = object.string("uri");
    try {
        if (isDataUri(uri)) return decodeDataUri(uri).size();
        return std::filesystem::file_size(resolveUri(checks.folder, uri, checks.allowOutside));
    } catch (const Error& e) {
        object.fail(e.what());
    }
}

void checkBuffers(GltfChecks& checks) {
    for (const JsonObject& object : checks.root.objects("buffers", "buffer")) {
        object.require("byteLength");
        BufferInfo buffer;
        buffer.bytes = static_cast<uint64_t>(object.integer("byteLength", 0, 1, kLargest));
        if (object.has("uri")) {
            const uint64_t there = bytesBehindUri(checks, object);
            if (there < buffer.bytes)
                object.fail(fmt::format("byteLength {}, but its uri has {} bytes", buffer.bytes, there));
        } else if (checks.buffers.empty() && checks.source.hasBinary) {
            const uint64_t there = checks.source.binary.size();
            if (there < buffer.bytes)
                object.fail(fmt::format("byteLength {}, but the BIN chunk has {} bytes", buffer.bytes, there));
            // A chunk is padded to a multiple of 4.
            if (there > buffer.bytes + 3)
                checks.warnings.add(fmt::format("byteLength {}, but the BIN chunk has {} bytes", buffer.bytes, there),
                                    object.where());
        } else {
            if (checks.buffers.empty() && checks.source.isGlb && !object.has("extensions"))
                object.fail("neither uri nor BIN chunk, expected one of them");
            buffer.hasData = false;
        }
        checks.buffers.push_back(buffer);
    }
}

void checkBufferViews(GltfChecks& checks) {
    for (const JsonObject& object : checks.root.objects("bufferViews", "buffer view")) {
        for (const char* key : {"buffer", "byteLength"}) object.require(key);
        ViewInfo view;
        view.buffer = object.reference("buffer", "buffer", checks.buffers.size()).value();
        view.offset = static_cast<uint64_t>(object.integer("byteOffset", 0, 0, kLargest));
        view.bytes = static_cast<uint64_t>(object.integer("byteLength", 0, 1, kLargest));
        view.stride = static_cast<uint64_t>(object.integer("byteStride", 0, 4, 252));
        if (view.stride % 4 != 0) object.fail(fmt::format("byteStride {}, expected a multiple of 4", view.stride));
        const uint64_t there = checks.buffers[view.buffer].bytes;
        if (view.offset + view.bytes > there)
            object.fail(fmt::format("bytes {} to {}, but buffer {} has {} bytes", view.offset, view.offset + view.bytes,
                                    view.buffer, there));
        if (view.stride > view.bytes)
            object.fail(fmt::format("byteStride {}, but it has {} bytes", view.stride, view.bytes));
        view.hasData = hasData(checks, object, view.buffer);
        checks.views.push_back(view);
    }
}

void checkAccessors(GltfChecks& checks) {
    for (const JsonObject& object : checks.root.objects("accessors", "accessor"))
        checks.accessors.push_back(checkAccessor(checks, object));
}

}  // namespace lsde
