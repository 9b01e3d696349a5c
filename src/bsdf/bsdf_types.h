// Values that every Bsdf takes and gives.
#pragma once

#include "base/math.h"
#include "path/event.h"

namespace lsde {

struct LobeEval {
    Rgb f{0};               // 1/sr, without the cosine
    float pdfW = 0;         // 1/sr, of wi given wo, times the probability of choosing this lobe
    float reversePdfW = 0;  // 1/sr, of wo given wi, likewise
};

// f is that of power on its way from wo to wi: what a photon that came from wo carries on. For radiance that arrives
// from wi and goes to wo, as a path from the eye asks for it, f / eta^2 (Veach 1997, section 5.2): at a refraction
// f(wo, wi) = eta^2 f(wi, wo).
struct BsdfEval {
    LobeEval diffuse;
    LobeEval glossy;
    float eta = 1;  // refractive index on wi's side over that on wo's side; 1 where both are on one side
};

// What is asked of an evaluation; more may be given. Where photons are gathered, densities would be most of the cost.
enum class Asked : uint8_t { DiffuseF, F, All };

struct BsdfSample {
    Vec3 wi{0};             // unit, local frame
    Rgb weight{0};          // f |cos(wi)| / pdfW for power (delta: reflectance or transmittance / probability)
    float pdfW = 0;         // 1/sr of the lobe drawn, with its choice; delta: the probability of the choice
    float reversePdfW = 0;  // likewise for wo given wi
    float eta = 1;          // refractive index on wi's side over that on wo's side; 1 for reflection
    Event event = Event::Diffuse;
    bool delta = false;
    bool transmitted = false;  // wi is on the other side
    bool straight = false;     // T: passes without bending (thin wall)
};

// Makes of the sample of one lobe that of a choice among several; pReverse: the choice's probability given wi.
inline void choose(BsdfSample& sample, float p, float pReverse) {
    sample.weight /= p;
    sample.pdfW *= p;
    sample.reversePdfW *= pReverse;
}

// A perfect reflection, or a transmission to wi, as the only choice there is.
inline BsdfSample deltaReflection(Vec3 wo, Rgb reflectance) {
    BsdfSample s;
    s.wi = {-wo.x, -wo.y, wo.z};
    s.weight = reflectance;
    s.pdfW = s.reversePdfW = 1;
    s.event = Event::Specular;
    s.delta = true;
    return s;
}

inline BsdfSample deltaTransmission(Vec3 wi, Rgb transmittance, float eta) {
    BsdfSample s;
    s.wi = wi;
    s.weight = transmittance;
    s.pdfW = s.reversePdfW = 1;
    s.eta = eta;
    s.event = Event::Specular;
    s.delta = s.transmitted = true;
    return s;
}

}  // namespace lsde
