#include "scene/creases.h"

#include <unordered_map>

#include "scene/joined_vertices.h"

namespace lsde {

namespace {

// One side of an edge: the face that it bounds.
struct Side {
    Vec3 normal;    // unit, of the face
    Vec3 outwards;  // unit, in the face's plane, away from it
};

struct Edge {
    Segment segment;
    std::vector<Side> sides;
};

// Edges of all meshes, vertices joined by position.
class EdgeTable {
  public:
    void add(const Mesh& mesh) {
        std::vector<uint32_t> joined(mesh.positions.size());
        for (size_t i = 0; i < joined.size(); ++i) joined[i] = vertices_.id(mesh.positions[i]);
        for (const Triangle& t : mesh.triangles) {
            const Vec3 p[3] = {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
            const Vec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
            for (size_t i = 0; i < 3; ++i) {
                const size_t j = (i + 1) % 3;
                const Vec3 along = p[j] - p[i];
                if (lengthSquared(along) > 0)
                    add(joined[t[i]], joined[t[j]], {p[i], p[j]}, {normal, glm::normalize(glm::cross(along, normal))});
            }
        }
    }
    const std::vector<Edge>& edges() const { return edges_; }

  private:
    void add(uint32_t a, uint32_t b, const Segment& segment, const Side& side) {
        const auto [at, added] = index_.try_emplace(edgeKey(a, b), edges_.size());
        if (added) edges_.push_back({segment, {}});
        edges_[at->second].sides.push_back(side);
    }

    JoinedVertices vertices_;
    std::unordered_map<uint64_t, size_t> index_;
    std::vector<Edge> edges_;
};

bool goesOn(const Edge& edge, size_t side) {
    for (size_t other = 0; other < edge.sides.size(); ++other)
        if (other != side && glm::dot(edge.sides[other].normal, edge.sides[side].normal) > kSameSurfaceCosine)
            return true;
    return false;
}

// Whether rays just beyond the edge meet a face that lies as this side does.
bool goesOnUnmatched(const Scene& scene, const Segment& edge, const Side& side) {
    const Vec3 along = edge.b - edge.a;
    for (const float at : {0.25F, 0.5F, 0.75F}) {
        const Vec3 p = edge.a + at * along;
        // Far enough for the rounding of the coordinates, near enough to meet nothing else.
        const float step = std::max(1e-4F * glm::length(along), 4 * surfaceEpsilon(p, 0));
        Hit hit;
        const Ray down{p + step * (side.outwards + side.normal), -side.normal, 2 * step};
        if (!scene.accel().intersect(down, hit) || glm::dot(scene.surface(hit).ng, side.normal) <= kSameSurfaceCosine)
            return false;
    }
    return true;
}

}  // namespace

std::vector<Segment> findCreases(const Scene& scene) {
    EdgeTable table;
    for (const Mesh& mesh : scene.description().meshes) table.add(mesh);
    std::vector<Segment> creases;
    for (const Edge& edge : table.edges())
        for (size_t side = 0; side < edge.sides.size(); ++side)
            if (!goesOn(edge, side) && !goesOnUnmatched(scene, edge.segment, edge.sides[side])) {
                creases.push_back(edge.segment);
                break;
            }
    return creases;
}

}  // namespace lsde
