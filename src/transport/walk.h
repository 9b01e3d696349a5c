// The one random walk, from lights and from the camera: from surface to surface, and over each of them.
#pragma once

#include <vector>

#include "sampling/sampler.h"
#include "sampling/wavelength.h"
#include "transport/vertex.h"

namespace lsde {

// What is carried along the path: radiance of the eye's path is scaled by eta^2 where it crosses an interface, power is
// not; power takes the correction for shading normals (Veach 1997, section 5.3), radiance does not.
enum class Quantity : uint8_t { Radiance, Power };

struct PathState {
    Ray ray;
    MediaStack media;   // around the ray's origin
    Rgb throughput{1};  // eye: dimensionless; light: W; before the weight of its wavelength
    // The wavelength that it will have once it disperses, drawn at its start; kAllWavelengths where nothing disperses.
    WavelengthId reserved = kAllWavelengths;
    WavelengthId wavelength = kAllWavelengths;  // the one that it has

    // The throughput in the picture's channels.
    Rgb rgb() const { return weighed(throughput, wavelength); }
    // The wavelength that what the vertex scatters has, and the throughput with which it does.
    WavelengthId wavelengthAt(const Vertex& vertex) const { return vertex.disperses ? reserved : wavelength; }
    Rgb rgbAt(const Vertex& vertex) const { return weighed(throughput, wavelengthAt(vertex)); }
};

// For a path that starts with the sampler.
inline WavelengthId reserveWavelength(const Scene& scene, const Sampler& sampler) {
    return scene.disperses() ? sampleWavelength(sampler.wavelengthNumber()) : kAllWavelengths;
}

// Scratch of one thread.
struct WalkScratch {
    std::vector<Hit> hits;
    uint64_t rays = 0;
};

// Follows the ray to the next surface where something happens: crossings of solids that another solid hides are passed
// over. The throughput takes the media's absorption (Beer-Lambert). False: the light escapes.
bool advance(const Scene& scene, PathState& path, Vertex& vertex, WalkScratch& scratch);

// Its second half, for paths that are followed side by side: at what the path's ray has hit. The vertex's distance
// grows by the ray's. False: a crossing that another solid hides, and the path goes on beyond it.
bool arrive(const Scene& scene, const Hit& hit, PathState& path, Vertex& vertex, WalkScratch& scratch);

// Surfaces that a ray passes without an event: more than in any scene, so that no rounding makes a walk go on for ever.
inline constexpr int kMostCrossings = 1000;

// Leaves the vertex by the sample. False if nothing is carried on: the sampled direction's geometric and shading sides
// differ, or the throughput is zero. Where the surface disperses, the path has a wavelength from here on, whichever way
// it goes: what is reflected depends on the wavelength as well, most of all near total reflection.
bool scatter(const Vertex& vertex, const BsdfSample& sample, Quantity quantity, PathState& path);

// Light along a segment that starts at a vertex: 0 if something is in the way before `distance` (m; may be infinite);
// smooth thin walls tint it and are counted (each is an S of the path); the medium on its side of the vertex absorbs.
// Surfaces that cover only part dim it by what they are expected to cover or, where there are thin walls too, are there
// or not.
struct Visibility {
    Rgb transmittance{0};
    int straightPassages = 0;
};
Visibility visibility(const Scene& scene, const Vertex& from, Vec3 wi, float distance, WalkScratch& scratch);

// exp(-absorption distance) of the stack's dominant medium.
Rgb absorption(const Scene& scene, const MediaStack& media, float distance);

}  // namespace lsde
