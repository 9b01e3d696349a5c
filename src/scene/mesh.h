// Triangle meshes in world space, one for each primitive of each node.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/bounds.h"
#include "base/math.h"

namespace lsde {

using Triangle = std::array<uint32_t, 3>;

// A vertex attribute within a triangle, at the barycentric weights u, v of its second and third vertex.
template <typename T>
T interpolated(const std::vector<T>& values, const Triangle& t, float u, float v) {
    return (1 - u - v) * values[t[0]] + u * values[t[1]] + v * values[t[2]];
}

// extras.lsde of a node.
struct CausticSwitches {
    bool casts = true;     // castsCaustics
    bool receives = true;  // receivesCaustics
    bool aim = true;       // false: light is never aimed at it
    friend bool operator==(const CausticSwitches&, const CausticSwitches&) = default;
};

// Winding is counter-clockwise seen from the front, a mirroring node's flip already undone.
struct Mesh {
    std::string object;           // the node's name, else the mesh's, else "node N"; flux is reported by it
    std::vector<Vec3> positions;  // m, world
    std::vector<Vec3> normals;    // unit, by the inverse transpose; empty: flat
    std::vector<Vec4> tangents;  // xyz unit, world; w = +-1: the bitangent is w cross(normal, tangent); empty if absent
    std::array<std::vector<Vec2>, 2> texCoords;  // TEXCOORD_0 and _1, empty if absent
    std::vector<Vec4> colors;                    // COLOR_0, linear; empty if absent
    std::vector<Triangle> triangles;             // degenerate ones already left out, with a warning
    uint32_t material = 0;
    // The node in the file, or beyond them an instance: primitives of one and of one material bound one solid.
    uint32_t node = 0;
    CausticSwitches switches;
    int priority = 0;  // extras.priority of the node or material; larger wins
    bool hasPriority = false;
    uint32_t openEdges = 0;  // edges with one triangle only, vertices joined by position (filled for solids)

    Bounds bounds() const {
        Bounds b;
        for (const Vec3 p : positions) b.grow(p);
        return b;
    }
};

}  // namespace lsde
