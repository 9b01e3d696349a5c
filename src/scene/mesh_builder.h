// From a primitive's arrays to meshes in world space.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/material.h"
#include "scene/mesh.h"
#include "scene/warnings.h"

namespace lsde {

// glTF's modes; points and lines have no surface.
enum class PrimitiveMode : uint8_t { Triangles = 4, Strip = 5, Fan = 6 };

// Number of triangles that `corners` corners (indices, or vertices if there are none) make.
uint64_t triangleCount(PrimitiveMode mode, uint64_t corners);

// Triangles of corners in the mode's order, strips' windings alike. Those of a strip or fan that repeat a corner only
// join its parts, and are left out.
std::vector<Triangle> assembleTriangles(PrimitiveMode mode, std::span<const uint32_t> corners);

// The vertices that triangles use, in order of first use; renumbers the triangles to that order.
class VertexSelector {
  public:
    std::vector<uint32_t> select(std::span<Triangle> triangles, size_t vertexCount);

  private:
    std::vector<uint32_t> numbers_;  // kept between calls: work is by vertices used, not by vertices there
};

// A primitive in its node's space.
struct PrimitiveData {
    std::string file, where;  // "mesh 2 primitive 0", for errors
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    std::vector<Vec4> tangents;
    std::array<std::vector<Vec2>, 2> texCoords;
    std::vector<Vec4> colors;
    std::vector<Triangle> triangles;
};

// The primitive in world space: positions by the matrix in double precision, normals by its inverse transpose, winding
// flipped where it mirrors, degenerate triangles left out. None if no triangle is left. Throws Error for a coordinate
// beyond kMaxCoordinate. The mesh's names, material and switches are the caller's.
std::optional<Mesh> placePrimitive(const PrimitiveData& primitive, const glm::dmat4& world, Warnings& warnings);

// Fills in openEdges of meshes that bound solids: those of one node and material together.
void countOpenEdges(std::vector<Mesh>& meshes, std::span<const Material> materials, Warnings& warnings);

}  // namespace lsde
