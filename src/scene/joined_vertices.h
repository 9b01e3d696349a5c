// Vertices joined by position: exporters split a vertex wherever normals or texture coordinates differ.
#pragma once

#include <array>
#include <cstring>
#include <unordered_map>

#include "base/hash.h"
#include "base/math.h"

namespace lsde {

// Numbers positions from 0 in order of first appearance, equal ones alike.
class JoinedVertices {
  public:
    uint32_t id(Vec3 p) {
        p += Vec3(0);  // joins -0 and 0
        return ids_.try_emplace(p, static_cast<uint32_t>(ids_.size())).first->second;
    }

  private:
    struct Hash {
        size_t operator()(Vec3 p) const {
            std::array<uint32_t, 3> bits;
            static_assert(sizeof bits == sizeof p);
            std::memcpy(bits.data(), &p, sizeof bits);
            return hashCombine((uint64_t{bits[0]} << 32) | bits[1], bits[2]);
        }
    };
    std::unordered_map<Vec3, uint32_t, Hash> ids_;
};

// Key of the edge between two joined vertices, whichever comes first.
inline uint64_t edgeKey(uint32_t a, uint32_t b) { return a < b ? (uint64_t{a} << 32) | b : (uint64_t{b} << 32) | a; }

}  // namespace lsde
