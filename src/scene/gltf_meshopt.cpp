// The one file that includes meshoptimizer.
#include <fmt/format.h>
#include <meshoptimizer.h>

#include "base/error.h"
#include "scene/gltf_compression.h"

namespace lsde {

namespace {

// A group of 16 values takes at least two bits in the codec of vertices, which of the three packs tightest: more than
// this is damage, found before memory is taken for it.
constexpr size_t kMostBytesPerByte = 64;

void unfilter(const MeshoptView& view, std::string& decoded) {
    if (view.filter == "OCTAHEDRAL")
        meshopt_decodeFilterOct(decoded.data(), view.count, view.stride);
    else if (view.filter == "QUATERNION")
        meshopt_decodeFilterQuat(decoded.data(), view.count, view.stride);
    else if (view.filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(decoded.data(), view.count, view.stride);
}

}  // namespace

std::string decodeMeshopt(const MeshoptView& view, std::span<const unsigned char> bytes) {
    const size_t size = view.count * view.stride;
    if (size / kMostBytesPerByte > bytes.size())
        throw Error(fmt::format("{} bytes cannot hold {} compressed ones", bytes.size(), size));
    std::string decoded(size, '\0');
    int failure = 0;
    if (view.mode == "ATTRIBUTES")
        failure = meshopt_decodeVertexBuffer(decoded.data(), view.count, view.stride, bytes.data(), bytes.size());
    else if (view.mode == "TRIANGLES")
        failure = meshopt_decodeIndexBuffer(decoded.data(), view.count, view.stride, bytes.data(), bytes.size());
    else
        failure = meshopt_decodeIndexSequence(decoded.data(), view.count, view.stride, bytes.data(), bytes.size());
    if (failure != 0) throw Error("its compressed data are damaged");
    unfilter(view, decoded);
    return decoded;
}

}  // namespace lsde
