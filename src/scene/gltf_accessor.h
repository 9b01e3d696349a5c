// Elements of an accessor: interleaved or not, of any component type, sparse or not.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace lsde {

// Points into buffers of a validated file, which must outlive it; nothing here reads beyond them.
struct GltfAccessor {
    std::string where;                    // "FILE: accessor 3", for errors
    const unsigned char* data = nullptr;  // first element; null: all zeros
    size_t stride = 0;                    // bytes from one element to the next
    size_t count = 0;
    int componentType = 5126;
    size_t components = 1;
    bool normalized = false;

    size_t sparseCount = 0;
    const unsigned char* sparseIndices = nullptr;
    int sparseIndexType = 5125;
    const unsigned char* sparseValues = nullptr;

    // Throws Error unless sparse indices increase and lie within the accessor.
    void checkSparse() const;
    // A whole number: an index into vertices.
    uint32_t index(size_t element) const;
    // Up to 4 components as floats, normalised integers in [0,1] or [-1,1]; missing ones 0. Throws Error for a value
    // that is not finite.
    std::array<float, 4> floats(size_t element) const;

  private:
    uint32_t sparseIndex(size_t i) const;
    size_t sparsePosition(size_t element) const;
    const unsigned char* bytesOf(size_t element) const;  // null: zeros
    size_t componentBytes() const;
};

}  // namespace lsde
