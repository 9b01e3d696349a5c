#include "scene/casters.h"

#include <algorithm>

namespace lsde {

namespace {

Sphere around(const Sphere& a, const Sphere& b) {
    const Vec3 d = b.centre - a.centre;
    const float distance = glm::length(d);
    if (distance + b.radius <= a.radius) return a;
    if (distance + a.radius <= b.radius) return b;
    const float radius = 0.5F * (distance + a.radius + b.radius);
    return {a.centre + d * ((radius - a.radius) / distance), radius};
}

}  // namespace

Sphere boundingSphereOf(const Mesh& mesh) {
    Sphere s;
    s.centre = mesh.bounds().centre();
    for (const Vec3 p : mesh.positions) s.radius = std::max(s.radius, glm::length(p - s.centre));
    return s;
}

std::vector<Caster> groupCasters(std::vector<Sphere> spheres, size_t limit) {
    struct Group {
        size_t begin, end;
        Bounds centres;
        Sphere sphere;
    };
    const auto group = [&](size_t begin, size_t end) {
        Group g{begin, end, {}, spheres[begin]};
        for (size_t i = begin; i < end; ++i) {
            g.centres.grow(spheres[i].centre);
            g.sphere = around(g.sphere, spheres[i]);
        }
        return g;
    };
    std::vector<Group> groups;
    if (!spheres.empty()) groups.push_back(group(0, spheres.size()));
    while (groups.size() < std::min(limit, spheres.size())) {
        const auto largest = std::max_element(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
            return (a.end - a.begin > 1 ? a.sphere.radius : -1) < (b.end - b.begin > 1 ? b.sphere.radius : -1);
        });
        const Group g = *largest;
        const Vec3 extent = g.centres.extent();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const size_t middle = (g.begin + g.end) / 2;
        const auto first = spheres.begin();
        std::nth_element(first + static_cast<std::ptrdiff_t>(g.begin), first + static_cast<std::ptrdiff_t>(middle),
                         first + static_cast<std::ptrdiff_t>(g.end),
                         [axis](const Sphere& a, const Sphere& b) { return a.centre[axis] < b.centre[axis]; });
        *largest = group(g.begin, middle);
        groups.push_back(group(middle, g.end));
    }
    std::vector<Caster> casters;
    casters.reserve(groups.size());
    for (const Group& g : groups) casters.push_back({g.sphere});
    return casters;
}

}  // namespace lsde
