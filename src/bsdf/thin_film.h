// Iridescence: interference in a thin film on a surface.
#pragma once

#include "base/math.h"

namespace lsde {

// KHR_materials_iridescence.
struct ThinFilm {
    float factor = 0;         // of the film's reflectance, the rest is Schlick's of the bare surface
    float ior = 1.3F;         // > 0
    float thickness = 4e-7F;  // m
};

// Reflectance of a surface of reflectance f0 at normal incidence (below 1) under such a film in air, at an angle with
// the normal; in [0,1]. Belcour & Barla 2017 as the extension's text has it: Schlick's reflectances, no polarisation,
// no extinction in metals, spectral integration by Gaussians in Fourier space. The text lets the sum exceed 1 in single
// channels, where a colour is purer than Rec. 709 holds: here it is cut off at 1, as at 0.
Rgb thinFilmReflectance(const ThinFilm& film, Rgb f0, float cosI);

}  // namespace lsde
