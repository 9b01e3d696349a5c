#include "transport/walk.h"

#include <limits>

#include "bsdf/cauchy.h"

namespace lsde {

namespace {

// Refractive index of a medium: glTF's ior 0 stands for an infinite one.
float iorOf(const Medium& m, WavelengthId wavelength) {
    if (m.dispersion > 0 && wavelength != kAllWavelengths)
        return cauchyIor(m.ior, m.dispersion, wavelengthNm(wavelength));
    return m.ior == 0 ? 1e6F : m.ior;
}

// Where a ray arrives: a surface, and the solids before and behind it.
struct Arrival {
    Surface surface;
    Crossing media;
    bool interface = false;  // bounds a solid
};

Arrival arrivalAt(const Scene& scene, const Hit& hit, const PathState& path, WalkScratch& scratch) {
    Arrival a{scene.surface(hit), {path.media, path.media}};
    const MeshInfo& info = scene.meshes()[hit.mesh];
    if (info.medium == kOutside) return a;
    a.interface = true;
    cross(a.media, info.medium, glm::dot(a.surface.ng, path.ray.direction) < 0);
    if (!info.mayTouch) return a;
    // Surfaces that coincide are crossed as one, since a ray that leaves the first would start beyond the others.
    scene.coincidentSurfaces(a.surface, a.surface.epsilon, scratch.hits);
    ++scratch.rays;
    const Hit* opaque = nullptr;
    for (const Hit& other : scratch.hits) {
        const MediumId medium = scene.meshes()[other.mesh].medium;
        if (medium == kOutside)
            opaque = &other;
        else
            cross(a.media, medium, glm::dot(scene.surface(other).ng, path.ray.direction) < 0);
    }
    if (opaque == nullptr) return a;
    // A glass on a table, both at the same height: in optical contact, the table lies within the glass.
    return {scene.surface({hit.t, opaque->mesh, opaque->triangle, opaque->u, opaque->v}),
            {a.media.before, a.media.before}};
}

// Whether a direction is on the same side of the geometric and of the shading normal; else nothing is carried that way.
bool sidesAgree(const Surface& s, Vec3 direction) { return glm::dot(direction, s.ng) * glm::dot(direction, s.ns) > 0; }

// Transmittance of a smooth thin wall along a straight passage; 0 of anything else.
Rgb straightTransmittance(const Scene& scene, const Surface& s, Vec3 direction) {
    if (!scene.material(s).isThinWall() || !sidesAgree(s, direction)) return Rgb(0);
    return straightTransmittance(scene.bsdf(s, 1, 1), std::fabs(glm::dot(s.ns, direction)));
}

// The rest of the segment from p along wi, from a surface on it. The origin moves off the surface but the end stays:
// along wi from the moved origin, a ray that meets a light at a grazing angle would arrive early, behind the light's
// surface.
Ray shadowRay(const Surface& s, Vec3 p, Vec3 wi, float distance) {
    const Vec3 origin = offsetOrigin(s.position, s.ng, wi, s.epsilon);
    if (!std::isfinite(distance)) return {origin, wi, kInfinity};
    const Vec3 toEnd = p + distance * wi - origin;
    const float length = glm::length(toEnd);
    if (!(glm::dot(toEnd, wi) > 0)) return {origin, wi, 0};
    return {origin, toEnd / length, length};
}

}  // namespace

Rgb absorption(const Scene& scene, const MediaStack& media, float distance) {
    if (media.size() == 0) return Rgb(1);
    const Rgb sigma = scene.media()[media.dominant(scene.media())].absorption;
    if (isBlack(sigma)) return Rgb(1);
    // A channel that is not absorbed goes any distance: 0 times infinity must be 0.
    const float d = std::min(distance, std::numeric_limits<float>::max());
    return {std::exp(-sigma.x * d), std::exp(-sigma.y * d), std::exp(-sigma.z * d)};
}

bool arrive(const Scene& scene, const Hit& hit, PathState& path, Vertex& vertex, WalkScratch& scratch) {
    const auto [s, media, interface] = arrivalAt(scene, hit, path, scratch);
    vertex.distance += hit.t;
    path.throughput *= absorption(scene, media.before, hit.t);
    const MediumId before = media.before.dominant(scene.media());
    const MediumId behind = media.after.dominant(scene.media());
    if (interface && before == behind) {
        path.media = media.after;
        path.ray = {offsetOrigin(s.position, s.ng, path.ray.direction, s.epsilon), path.ray.direction, kInfinity};
        return false;
    }
    vertex.surface = s;
    vertex.interface = interface;
    vertex.before = media.before;
    vertex.behind = media.after;
    vertex.medium = before;
    vertex.woWorld = -path.ray.direction;
    vertex.frame = Frame(s.ns);
    vertex.wo = vertex.frame.toLocal(vertex.woWorld);
    const bool fromFront = glm::dot(s.ng, vertex.woWorld) > 0;
    const Medium &in = scene.media()[before], &out = scene.media()[behind];
    const float iorBefore = iorOf(in, path.reserved), iorBehind = iorOf(out, path.reserved);
    vertex.disperses = interface && in.dispersion + out.dispersion > 0;
    vertex.bsdf = scene.bsdf(s, fromFront ? iorBefore : iorBehind, fromFront ? iorBehind : iorBefore);
    return true;
}

bool advance(const Scene& scene, PathState& path, Vertex& vertex, WalkScratch& scratch) {
    vertex.distance = 0;
    for (int crossings = 0; crossings < kMostCrossings; ++crossings) {
        Hit hit;
        ++scratch.rays;
        if (!scene.accel().intersect(path.ray, hit)) return false;
        if (arrive(scene, hit, path, vertex, scratch)) return true;
    }
    return false;
}

bool scatter(const Vertex& vertex, const BsdfSample& sample, Quantity quantity, PathState& path) {
    const Surface& s = vertex.surface;
    const Vec3 wi = vertex.frame.toWorld(sample.wi);
    const float woNg = glm::dot(vertex.woWorld, s.ng), wiNg = glm::dot(wi, s.ng);
    // Reflected light stays on its geometric side, transmitted light changes it; else the shading normal lies.
    if ((woNg * wiNg > 0) == sample.transmitted) return false;
    if (woNg * vertex.wo.z <= 0 || wiNg * sample.wi.z <= 0) return false;
    path.throughput *= sample.weight;
    if (vertex.disperses) path.wavelength = path.reserved;
    if (quantity == Quantity::Radiance)
        path.throughput /= square(sample.eta);
    else
        path.throughput *= std::fabs((vertex.wo.z * wiNg) / (woNg * sample.wi.z));
    if (isBlack(path.throughput) || !isFinite(path.throughput)) return false;
    path.media = vertex.media(sample.transmitted);
    path.ray = {offsetOrigin(s.position, s.ng, wi, s.epsilon), wi, kInfinity};
    return true;
}

Visibility visibility(const Scene& scene, const Vertex& from, Vec3 wi, float distance, WalkScratch& scratch) {
    const Surface& s = from.surface;
    Ray ray = shadowRay(s, s.position, wi, distance);
    Visibility v;
    if (!scene.hasThinWalls()) {
        ++scratch.rays;
        v.transmittance = Rgb(scene.accel().transmittance(ray, scratch.hits));
        if (isBlack(v.transmittance)) return v;
    } else {
        Rgb tint(1);
        Hit hit;
        for (++scratch.rays; scene.accel().intersect(ray, hit); ++scratch.rays) {
            const Surface wall = scene.surface(hit);
            tint *= straightTransmittance(scene, wall, wi);
            if (isBlack(tint) || ++v.straightPassages == kMostCrossings) return v;
            ray = shadowRay(wall, s.position, wi, distance);
        }
        v.transmittance = tint;
    }
    const MediaStack& media = from.media(from.isThrough(wi));
    if (media.size() > 0) v.transmittance *= absorption(scene, media, distance);
    return v;
}

}  // namespace lsde
