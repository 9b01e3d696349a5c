// What a glTF file may ask for. Each limit is far above real scenes and low enough that a small hostile file can take
// neither all memory nor all day; an Error that meets one names it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lsde {

inline constexpr uint64_t kMaxFileBytes = uint64_t{1} << 32;     // of the scene and of each buffer: GLB's own limit
inline constexpr size_t kMaxJsonDepth = 64;                      // nested arrays and objects
inline constexpr size_t kMaxJsonValues = 20'000'000;             // values in the JSON text, about 1 GB once parsed
inline constexpr size_t kMaxNodeDepth = 1000;                    // parents above a node
inline constexpr uint64_t kMaxPrimitives = 1'000'000;            // primitives of all nodes of a scene
inline constexpr uint64_t kMaxTriangles = 100'000'000;           // of all nodes of a scene
inline constexpr uint64_t kMaxBareElements = 1 << 24;            // of an accessor without a buffer view (all zeros)
inline constexpr double kMaxCoordinate = 1e9;                    // m: squares of areas stay within a float
inline constexpr uint64_t kMaxImageBytes = uint64_t{1} << 30;    // of one encoded image
inline constexpr uint64_t kMaxProfileBytes = uint64_t{1} << 26;  // of one IES profile
inline constexpr uint64_t kMaxImagePixels = uint64_t{1} << 26;   // of one image: 8192 x 8192
inline constexpr uint64_t kMaxScenePixels = uint64_t{1} << 28;   // of all textures in use: 1 GiB decoded
inline constexpr uint32_t kMaxPictureSide = 65536;               // pixels of a camera's resolution
inline constexpr uint32_t kMaxPicturePixels = 1 << 28;

}  // namespace lsde
