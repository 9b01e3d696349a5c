#include "bsdf/sheen.h"

#include <array>

namespace lsde {

namespace {

constexpr float kLeastRoughness = 0.07F;  // below it the lobe would leave what floats resolve

// Conty Estevez & Kulla 2017, section 3: Smith's Lambda as fitted to the exponentiated sine.
float lambdaFit(float x, float alpha) {
    const float t = square(1 - alpha);
    const auto mix = [t](float rough, float smooth) { return rough + t * (smooth - rough); };
    const float a = mix(21.5473F, 25.3245F), b = mix(3.82987F, 3.32435F), c = mix(0.19823F, 0.16801F);
    const float d = mix(-1.97760F, -1.27393F), e = mix(-4.32054F, -4.85967F);
    return a / (1 + b * std::pow(x, c)) + d * x + e;
}

float lambda(float cosTheta, float alpha) {
    return std::exp(cosTheta < 0.5F ? lambdaFit(cosTheta, alpha)
                                    : 2 * lambdaFit(0.5F, alpha) - lambdaFit(1 - cosTheta, alpha));
}

// Rows by roughness i / 15 (at least 0.07), columns by cosine (k / 15)^2 (at least 0.001).
constexpr size_t kSteps = 16;
constexpr std::array<std::array<float, kSteps>, kSteps> kAlbedo = {
    {{2.9188F, 2.8295F, 2.0962F, 1.3169F, 0.7201F, 0.3363F, 0.1288F, 0.0381F, 0.0080F, 0.0011F, 0.0001F, 0.0000F,
      0.0000F, 0.0000F, 0.0000F, 0.0000F},
     {2.9188F, 2.8295F, 2.0962F, 1.3169F, 0.7201F, 0.3363F, 0.1288F, 0.0381F, 0.0080F, 0.0011F, 0.0001F, 0.0000F,
      0.0000F, 0.0000F, 0.0000F, 0.0000F},
     {1.6156F, 1.6435F, 1.3957F, 1.0628F, 0.7540F, 0.5000F, 0.3072F, 0.1721F, 0.0859F, 0.0370F, 0.0131F, 0.0035F,
      0.0006F, 0.0001F, 0.0000F, 0.0000F},
     {1.1491F, 1.1940F, 1.0733F, 0.8821F, 0.6901F, 0.5179F, 0.3721F, 0.2540F, 0.1630F, 0.0967F, 0.0518F, 0.0242F,
      0.0094F, 0.0027F, 0.0004F, 0.0000F},
     {0.9349F, 0.9838F, 0.9126F, 0.7810F, 0.6427F, 0.5135F, 0.3982F, 0.2986F, 0.2150F, 0.1470F, 0.0942F, 0.0553F,
      0.0291F, 0.0127F, 0.0038F, 0.0003F},
     {0.8249F, 0.8759F, 0.8292F, 0.7278F, 0.6179F, 0.5127F, 0.4162F, 0.3298F, 0.2537F, 0.1881F, 0.1331F, 0.0885F,
      0.0546F, 0.0297F, 0.0126F, 0.0024F},
     {0.7693F, 0.8225F, 0.7897F, 0.7052F, 0.6114F, 0.5202F, 0.4352F, 0.3575F, 0.2871F, 0.2242F, 0.1687F, 0.1212F,
      0.0825F, 0.0514F, 0.0268F, 0.0086F},
     {0.7465F, 0.8023F, 0.7783F, 0.7035F, 0.6188F, 0.5358F, 0.4578F, 0.3856F, 0.3190F, 0.2580F, 0.2026F, 0.1532F,
      0.1114F, 0.0758F, 0.0453F, 0.0197F},
     {0.7456F, 0.8043F, 0.7860F, 0.7166F, 0.6369F, 0.5584F, 0.4843F, 0.4152F, 0.3507F, 0.2908F, 0.2352F, 0.1845F,
      0.1405F, 0.1017F, 0.0667F, 0.0353F},
     {0.7597F, 0.8214F, 0.8068F, 0.7400F, 0.6625F, 0.5861F, 0.5138F, 0.4461F, 0.3826F, 0.3229F, 0.2669F, 0.2150F,
      0.1692F, 0.1280F, 0.0898F, 0.0540F},
     {0.7838F, 0.8484F, 0.8359F, 0.7696F, 0.6925F, 0.6165F, 0.5447F, 0.4772F, 0.4138F, 0.3539F, 0.2972F, 0.2440F,
      0.1968F, 0.1538F, 0.1133F, 0.0746F},
     {0.8131F, 0.8800F, 0.8684F, 0.8015F, 0.7237F, 0.6471F, 0.5748F, 0.5070F, 0.4432F, 0.3827F, 0.3251F, 0.2709F,
      0.2226F, 0.1782F, 0.1361F, 0.0957F},
     {0.8421F, 0.9108F, 0.8992F, 0.8311F, 0.7520F, 0.6745F, 0.6016F, 0.5333F, 0.4690F, 0.4079F, 0.3497F, 0.2947F,
      0.2455F, 0.2004F, 0.1574F, 0.1160F},
     {0.8649F, 0.9344F, 0.9225F, 0.8534F, 0.7734F, 0.6953F, 0.6221F, 0.5536F, 0.4891F, 0.4279F, 0.3695F, 0.3142F,
      0.2648F, 0.2194F, 0.1762F, 0.1346F},
     {0.8746F, 0.9440F, 0.9321F, 0.8629F, 0.7833F, 0.7057F, 0.6330F, 0.5652F, 0.5015F, 0.4410F, 0.3831F, 0.3284F,
      0.2795F, 0.2346F, 0.1918F, 0.1508F},
     {0.8644F, 0.9329F, 0.9218F, 0.8545F, 0.7770F, 0.7016F, 0.6312F, 0.5655F, 0.5038F, 0.4452F, 0.3891F, 0.3359F,
      0.2886F, 0.2451F, 0.2036F, 0.1638F}}};

}  // namespace

float Sheen::lobe(Vec3 wo, Vec3 wi) const {
    const float alpha = square(std::max(roughness, kLeastRoughness));
    const Vec3 h = glm::normalize(wo + wi);
    const float sine2 = std::max(0.0F, square(h.x) + square(h.y));
    const float d = (2 + 1 / alpha) * std::pow(sine2, 0.5F / alpha) / (2 * kPi);
    // Lambda is finite at the horizon, so the product of the cosines is kept from 0.
    constexpr float kLeastCosine = 1e-4F;
    const float cosO = std::max(wo.z, kLeastCosine), cosI = std::max(wi.z, kLeastCosine);
    return d / ((1 + lambda(cosO, alpha) + lambda(cosI, alpha)) * 4 * cosO * cosI);
}

float Sheen::albedo(float cosTheta) const {
    const auto at = [](float x, size_t& i) {
        const float scaled = std::clamp(x, 0.0F, 1.0F) * (kSteps - 1);
        i = std::min(static_cast<size_t>(scaled), kSteps - 2);
        return scaled - static_cast<float>(i);
    };
    size_t i = 0, k = 0;
    const float u = at(roughness, i), v = at(std::sqrt(cosTheta), k);
    const auto row = [&](size_t r) { return (1 - v) * kAlbedo[r][k] + v * kAlbedo[r][k + 1]; };
    return (1 - u) * row(i) + u * row(i + 1);
}

float Sheen::transmittance(Vec3 wo, Vec3 wi) const {
    if (empty()) return 1;
    return std::max(0.0F, 1 - maxComponent(color) * std::max(albedo(wo.z), albedo(wi.z)));
}

}  // namespace lsde
