// One interface for all surfaces: f by lobe class with both densities, samples with weight, densities, eta and event.
//
// Directions are unit vectors in the local frame with z = shading normal on the mesh's front side, so z may be
// negative; wo points back along the path already traced, wi along the direction sampled or evaluated; both leave the
// surface. A direction in the surface's plane (z = 0) scatters nothing. Geometric normals, the side tests with them and
// the eta^2 of radiance are the walk's business (transport/walk.h).
#pragma once

#include <array>
#include <span>
#include <variant>

#include "base/math.h"
#include "bsdf/conductor.h"
#include "bsdf/dielectric.h"
#include "bsdf/diffuse.h"
#include "bsdf/layered.h"
#include "bsdf/metal_rough.h"
#include "bsdf/transmissive.h"
#include "path/event.h"

namespace lsde {

using Bsdf = std::variant<BlackBsdf, DiffuseBsdf, MirrorBsdf, DielectricBsdf, ThinDielectricBsdf, MetalRoughBsdf,
                          TransmissiveBsdf, LayeredBsdf>;

// f of each non-delta lobe (1/sr, no cosine; for power from wo to wi, see BsdfEval), with the densities that
// sampleBsdf() has for wi given wo, and for wo given wi. Densities include the probability of choosing the lobe.
// What is not asked for may be missing.
BsdfEval evalBsdf(const Bsdf& bsdf, Vec3 wo, Vec3 wi, Asked asked = Asked::All);

// Draws one lobe and a direction. uLobe chooses the lobe. False: absorbed, no direction.
bool sampleBsdf(const Bsdf& bsdf, Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample);

// All delta lobes with their weights (pdfW = reversePdfW = 1 in the sample: nothing was chosen), for splitting. Empty
// for a Bsdf without delta lobes.
struct DeltaLobes {
    std::array<BsdfSample, 2> lobe;
    int count = 0;
};
DeltaLobes deltaLobes(const Bsdf& bsdf, Vec3 wo);

// Draws from the non-delta lobes alone (their choice renormalised), for use beside deltaLobes().
bool sampleNonDelta(const Bsdf& bsdf, Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample);

// What the Bsdf has, without asking for directions.
bool hasDelta(const Bsdf& bsdf);
bool hasDiffuseLobe(const Bsdf& bsdf);
bool hasGlossyLobe(const Bsdf& bsdf);
bool glossyLobePasses(const Bsdf& bsdf);  // the glossy lobe goes through the surface as well
// Vertex class of a lobe (path/event.h): a Glossy event of roughness >= kGlossyRoughness is of class Diffuse.
VertexClass glossyClass(const Bsdf& bsdf);
VertexClass classOf(const Bsdf& bsdf, const BsdfSample& sample);
// What a thin wall lets pass unbent at an angle with the normal; 0 of anything else.
Rgb straightTransmittance(const Bsdf& bsdf, float cosTheta);
// Reflectance for the albedo layer (diffuse + specular at normal incidence; what interfaces transmit counts as well);
// in [0,1] each.
Rgb albedo(const Bsdf& bsdf);

}  // namespace lsde
