// Fresnel reflectance.
#pragma once

#include "base/math.h"

namespace lsde {

// How an interface divides unpolarised light.
struct FresnelSplit {
    float reflectance = 1;  // in [0,1]; 1 - reflectance is transmitted
    float cosT = 0;         // of the refracted direction with the normal, > 0; 0 under total reflection
};

// Smooth interface of two dielectrics. cosI in [0,1]; eta: refractive index beyond the interface over that before it.
FresnelSplit fresnelDielectric(float cosI, float eta);

// Schlick's approximation (1994) with F90 = 1; f0: reflectance at normal incidence.
inline Rgb fresnelSchlick(Rgb f0, float cosI) {
    const float m = std::clamp(1 - cosI, 0.0F, 1.0F);
    return f0 + (Rgb(1) - f0) * (square(square(m)) * m);
}

}  // namespace lsde
