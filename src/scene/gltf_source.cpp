// Reading the container: a .gltf is JSON text, a .glb a header and chunks (glTF 2.0, section 4).
#include <fmt/format.h>

#include <cstring>
#include <string_view>

#include "base/error.h"
#include "scene/gltf_limits.h"
#include "scene/gltf_validate.h"
#include "store/file.h"

namespace lsde {

namespace {

constexpr std::string_view kMagic = "glTF";
constexpr size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;  // "JSON", "BIN\0"

// All supported machines are little-endian, as GLB is.
uint32_t word(std::string_view bytes, size_t offset) {
    uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

struct Chunk {
    size_t begin = 0, size = 0;
    uint32_t type = 0;
};

Chunk chunkAt(const std::string& name, std::string_view bytes, size_t offset, size_t end, int number) {
    if (end - offset < kChunkHeaderBytes)
        throw Error(fmt::format("{}: GLB chunk {}: truncated, {} bytes left, expected a header of {}", name, number,
                                end - offset, kChunkHeaderBytes));
    const Chunk chunk{offset + kChunkHeaderBytes, word(bytes, offset), word(bytes, offset + 4)};
    if (chunk.size > end - chunk.begin)
        throw Error(fmt::format("{}: GLB chunk {}: {} bytes, but only {} are left", name, number, chunk.size,
                                end - chunk.begin));
    if (chunk.size % 4 != 0)
        throw Error(fmt::format("{}: GLB chunk {}: {} bytes, expected a multiple of 4", name, number, chunk.size));
    return chunk;
}

// Where the file's length and the header's differ: the header's holds. Returns it.
size_t checkedLength(const std::string& name, std::string_view bytes, Warnings& warnings) {
    if (bytes.size() < kHeaderBytes)
        throw Error(
            fmt::format("{}: truncated GLB: {} bytes, expected a header of {}", name, bytes.size(), kHeaderBytes));
    if (const uint32_t version = word(bytes, 4); version != 2)
        throw Error(fmt::format("{}: GLB version {}, expected 2", name, version));
    const size_t length = word(bytes, 8);
    if (length > bytes.size())
        throw Error(fmt::format("{}: truncated GLB: {} bytes, but its header says {}", name, bytes.size(), length));
    if (length < kHeaderBytes)
        throw Error(fmt::format("{}: GLB header says {} bytes, expected at least {}", name, length, kHeaderBytes));
    if (length < bytes.size()) warnings.add(fmt::format("{} bytes follow the GLB's end", bytes.size() - length), "");
    return length;
}

GltfSource splitGlb(const std::string& name, std::string&& bytes, Warnings& warnings) {
    GltfSource source;
    source.isGlb = true;
    const size_t end = checkedLength(name, bytes, warnings);
    const Chunk json = chunkAt(name, bytes, kHeaderBytes, end, 0);
    if (json.type != kJsonChunk)
        throw Error(
            fmt::format("{}: GLB chunk 0: type {:#010x}, expected JSON ({:#010x})", name, json.type, kJsonChunk));
    Chunk binary;
    size_t offset = json.begin + json.size;
    for (int number = 1; offset < end; ++number) {
        const Chunk chunk = chunkAt(name, bytes, offset, end, number);
        offset = chunk.begin + chunk.size;
        if (chunk.type == kBinaryChunk && number == 1) {
            binary = chunk;
            source.hasBinary = true;
        } else if (chunk.type == kBinaryChunk || chunk.type == kJsonChunk) {
            throw Error(fmt::format("{}: GLB chunk {}: {} chunk, expected JSON as chunk 0 and BIN as chunk 1 only",
                                    name, number, chunk.type == kBinaryChunk ? "BIN" : "JSON"));
        } else {
            warnings.add("GLB chunk of unknown type ignored", fmt::format("GLB chunk {}", number));
        }
    }
    source.json = bytes.substr(json.begin, json.size);
    // In place: the binary part may be most of 4 GiB.
    bytes.erase(0, binary.begin);
    bytes.resize(binary.size);
    source.binary = std::move(bytes);
    return source;
}

GltfSource splitFile(const std::string& name, std::string bytes, Warnings& warnings) {
    if (bytes.empty()) throw Error(name + ": the file is empty, expected glTF");
    if (bytes.starts_with(kMagic)) return splitGlb(name, std::move(bytes), warnings);
    GltfSource source;
    source.json = std::move(bytes);
    return source;
}

}  // namespace

GltfSource readGltfSource(const std::filesystem::path& file, Warnings& warnings) {
    const std::string name = file.string();
    GltfSource source = splitFile(name, readFile(file, kMaxFileBytes), warnings);
    if (source.json.starts_with("\xEF\xBB\xBF"))
        throw Error(name + ": starts with a byte-order mark, which glTF forbids: expected JSON");
    const size_t first = source.json.find_first_not_of(" \t\r\n");
    if (first == std::string::npos || source.json[first] != '{')
        throw Error(name + ": not glTF: expected a JSON object or \"glTF\" at its start");
    return source;
}

}  // namespace lsde
