// The scene's solids: the medium that each holds, which of them touch, and which are around a point.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"
#include "scene/scene.h"

namespace lsde {

namespace {

// Whether a face of solid `a` lies in the plane of a triangle of b near it: else nothing of b can coincide with it.
// Pairs of large meshes are not looked through: they may.
bool mayLieAgainst(const Mesh& a, const Bounds& boundsOfA, const Mesh& b, float tolerance) {
    constexpr size_t kMostPairs = 10'000'000;
    std::vector<Triangle> nearby;
    for (const Triangle& t : b.triangles) {
        Bounds bounds;
        for (const uint32_t vertex : t) bounds.grow(b.positions[vertex]);
        if (boundsOfA.overlaps(bounds)) nearby.push_back(t);
    }
    if (nearby.size() * a.triangles.size() > kMostPairs) return true;
    return std::any_of(nearby.begin(), nearby.end(), [&](const Triangle& t) {
        const Vec3 p = b.positions[t[0]];
        const Vec3 n = glm::normalize(glm::cross(b.positions[t[1]] - p, b.positions[t[2]] - p));
        const auto inPlane = [&](uint32_t vertex) {
            return std::fabs(glm::dot(n, a.positions[vertex] - p)) <= tolerance;
        };
        return std::any_of(a.triangles.begin(), a.triangles.end(),
                           [&](const Triangle& face) { return std::all_of(face.begin(), face.end(), inPlane); });
    });
}

// Of a solid, where a ray meets it first.
struct NearestFace {
    MediumId medium;
    float t;
    bool leaves, touches = false;
};

}  // namespace

void Scene::buildMedia() {
    media_.push_back({});
    std::map<std::pair<uint32_t, uint32_t>, MediumId> solids;  // (node, material)
    for (size_t i = 0; i < meshes_.size(); ++i) {
        const Mesh& mesh = description_.meshes[i];
        const Material& material = description_.materials[mesh.material];
        if (!material.isSolid()) continue;
        const auto [at, added] = solids.try_emplace({mesh.node, mesh.material}, static_cast<MediumId>(media_.size()));
        if (added) {
            if (media_.size() > 65000)
                throw Error(fmt::format("{}: more than 65000 solids", description_.file.string()));
            Medium medium;
            medium.ior = material.ior;
            // What does not refract, or what is taken for a mirror (ior 0), does not disperse.
            medium.dispersion = material.ior > 1 ? material.dispersion : 0;
            disperses_ |= medium.dispersion > 0;
            medium.priority = mesh.priority;
            const VolumeProperties& v = *material.volume;
            if (std::isfinite(v.attenuationDistance))
                for (int c = 0; c < 3; ++c)
                    medium.absorption[c] = -std::log(std::max(v.attenuationColor[c], 1e-30F)) / v.attenuationDistance;
            media_.push_back(medium);
        }
        meshes_[i].medium = at->second;
    }
    findTouching();
    checkNesting();
}

void Scene::findTouching() {
    std::vector<Bounds> bounds;
    bounds.reserve(meshes_.size());
    for (const Mesh& mesh : description_.meshes) bounds.push_back(mesh.bounds());
    for (size_t a = 0; a < meshes_.size(); ++a) {
        if (meshes_[a].medium == kOutside) continue;
        Bounds grown = bounds[a];
        const float tolerance = 2 * surfaceEpsilon(glm::max(glm::abs(grown.lo), glm::abs(grown.hi)), 0);
        grown.lo -= Vec3(tolerance);
        grown.hi += Vec3(tolerance);
        for (size_t b = 0; b < meshes_.size() && !meshes_[a].mayTouch; ++b)
            meshes_[a].mayTouch = meshes_[b].medium != meshes_[a].medium && grown.overlaps(bounds[b]) &&
                                  mayLieAgainst(description_.meshes[a], grown, description_.meshes[b], tolerance);
    }
}

// Looks from a face of each solid: exact where solids lie within each other, as they do when many are nested.
void Scene::checkNesting() const {
    std::vector<bool> seen(media_.size(), false);
    for (size_t i = 0; i < meshes_.size(); ++i) {
        if (meshes_[i].medium == kOutside || seen[meshes_[i].medium]) continue;
        seen[meshes_[i].medium] = true;
        const Mesh& mesh = description_.meshes[i];
        const Triangle& t = mesh.triangles.front();
        const Vec3 centre = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3.0F;
        std::vector<MediumId> around = solidsAround(centre);
        std::erase(around, meshes_[i].medium);
        if (around.size() >= MediaStack::kMaxDepth)
            throw Error(fmt::format("{}: \"{}\" lies in {} solids at once, limit {}", description_.file.string(),
                                    mesh.object, around.size(), MediaStack::kMaxDepth - 1));
    }
}

std::vector<MediumId> Scene::solidsAround(Vec3 p) const {
    if (media_.size() == 1) return {};
    // Nearly straight up, so that an open sheet of water holds what is below it; askew, so that no edge is met exactly.
    const Ray ray{p, glm::normalize(Vec3(0.0123F, 1, 0.0071F))};
    std::vector<Hit> hits;
    accel_.allHits(ray, hits);
    // The nearest surface of a solid tells by its facing whether p is inside. Faces of both kinds at one place only
    // touch the ray (a vertex of the outline), and tell nothing.
    std::vector<NearestFace> nearest;
    for (const Hit& hit : hits) {
        const MediumId m = meshes_[hit.mesh].medium;
        if (m == kOutside) continue;
        const Surface s = surface(hit);
        const bool leaves = glm::dot(s.ng, ray.direction) > 0;
        const auto at =
            std::find_if(nearest.begin(), nearest.end(), [m](const NearestFace& c) { return c.medium == m; });
        if (at != nearest.end() && hit.t <= at->t + s.epsilon) {
            at->touches |= leaves != at->leaves;
        } else if (at == nearest.end() || at->touches) {
            if (at != nearest.end()) nearest.erase(at);
            nearest.push_back({m, hit.t, leaves});
        }
    }
    std::vector<MediumId> inside;
    for (const NearestFace& c : nearest)
        if (c.leaves && !c.touches) inside.push_back(c.medium);
    return inside;
}

MediaStack Scene::mediaAt(Vec3 p) const {
    MediaStack stack;
    const std::vector<MediumId> inside = solidsAround(p);
    // The solid that the ray leaves last was entered first.
    for (auto m = inside.rbegin(); m != inside.rend(); ++m) stack.enter(*m);
    return stack;
}

void Scene::coincidentSurfaces(const Surface& s, float distance, std::vector<Hit>& out) const {
    const Ray probe{s.position + distance * s.ng, -s.ng, 2 * distance};
    accel_.allHits(probe, out);
    std::erase_if(out, [&](const Hit& h) {
        return meshes_[h.mesh].medium == meshes_[s.mesh].medium || !accel_.isThere(probe, h) ||
               description_.materials[description_.meshes[h.mesh].material].isThinWall();
    });
}

}  // namespace lsde
