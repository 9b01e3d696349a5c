#include "bsdf/thin_film.h"

#include "base/color.h"
#include "bsdf/fresnel.h"

namespace lsde {

namespace {

float f0Between(float a, float b) { return square((a - b) / (a + b)); }

// Reflectance that the first orders of interference add for one phase shift, in Rec. 709: the colour matching functions
// as Gaussians over wave numbers, Fourier transformed (Belcour & Barla 2017, section 4). opd in m, shift in rad.
Rgb sensitivity(float opd, Rgb shift) {
    constexpr float kNormal = 1.0685e-7F;
    const float phase = 2 * kPi * opd;
    const auto lobe = [&](float value, float position, float variance, float shiftBy) {
        return value * std::sqrt(2 * kPi * variance) * std::cos(position * phase + shiftBy) *
               std::exp(-square(phase) * variance) / kNormal;
    };
    const float x = lobe(5.4856e-13F, 1.6810e6F, 4.3278e9F, shift.x) + lobe(9.7470e-14F, 2.2399e6F, 4.5282e9F, shift.x);
    const float y = lobe(4.4201e-13F, 1.7953e6F, 9.3046e9F, shift.y);
    const float z = lobe(5.2481e-13F, 2.2084e6F, 6.6121e9F, shift.z);
    return rec709FromXyz(Vec3(x, y, z));
}

}  // namespace

Rgb thinFilmReflectance(const ThinFilm& film, Rgb f0, float cosI) {
    // A film that vanishes takes its index of refraction along (the text's way to keep it continuous).
    const float t = std::clamp(film.thickness / 3e-8F, 0.0F, 1.0F);
    const float ior = 1 + (film.ior - 1) * (t * t * (3 - 2 * t));
    const float cosT2 = 1 - (1 - square(cosI)) / square(ior);
    if (!(cosT2 > 0)) return Rgb(1);
    const float cosT = std::sqrt(cosT2);
    const Rgb root = glm::sqrt(glm::min(f0, Rgb(0.9999F)));
    const Rgb baseIor = (Rgb(1) + root) / (Rgb(1) - root);
    const float top = fresnelSchlick(Rgb(f0Between(ior, 1)), cosI).x, through = 1 - top;
    Rgb bottomF0, shift;
    for (int c = 0; c < 3; ++c) {
        bottomF0[c] = f0Between(baseIor[c], ior);
        shift[c] = (ior < 1 ? 0 : kPi) + (baseIor[c] < ior ? kPi : 0);
    }
    const Rgb bottom = fresnelSchlick(bottomF0, cosT);
    const Rgb both = glm::clamp(top * bottom, 1e-5F, 0.9999F);
    const Rgb series = square(through) * bottom / (Rgb(1) - both);
    const float opd = 2 * ior * film.thickness * cosT;
    Rgb reflectance = top + series, order = series - through;
    for (int m = 1; m <= 2; ++m) {
        order *= glm::sqrt(both);
        reflectance += 2.0F * order * sensitivity(static_cast<float>(m) * opd, static_cast<float>(m) * shift);
    }
    return glm::clamp(reflectance, 0.0F, 1.0F);
}

}  // namespace lsde
