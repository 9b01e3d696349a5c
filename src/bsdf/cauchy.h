// Refractive index by wavelength.
#pragma once

#include "base/math.h"

namespace lsde {

// At a wavelength in nm (of air), of a medium with index `ior` > 1 at the d line (587.6 nm) and dispersion 20 / V_d:
// Cauchy's equation n = A + B / lambda^2 through the d line with the Abbe number V_d = (n_d - 1) / (n_F - n_C), not
// below 1 (KHR_materials_dispersion).
inline float cauchyIor(float ior, float dispersion, float nm) {
    return std::max(1.0F, ior + (ior - 1) * dispersion / 20 * (523655 / square(nm) - 1.5168F));
}

}  // namespace lsde
