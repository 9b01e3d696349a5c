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

struct BsdfEval {
    LobeEval diffuse;
    LobeEval glossy;
};

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

// A perfect reflection as the only choice there is.
inline BsdfSample deltaReflection(Vec3 wo, Rgb reflectance) {
    BsdfSample s;
    s.wi = {-wo.x, -wo.y, wo.z};
    s.weight = reflectance;
    s.pdfW = s.reversePdfW = 1;
    s.event = Event::Specular;
    s.delta = true;
    return s;
}

}  // namespace lsde
