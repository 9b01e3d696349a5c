#include "scene/environment_map.h"

#include <array>
#include <numbers>

#include "base/error.h"

namespace lsde {

namespace {

// Integral over a row of texels (angles from +Y, in units of rows) of sine times the weight that bilinear interpolation
// gives to the row above, the row itself and the one below: Gauss' three-point rule on either half.
std::array<double, 3> rowWeights(int row, int rows) {
    constexpr std::array<double, 3> kNodes{0.1127016653792583, 0.5, 0.8872983346207417};
    constexpr std::array<double, 3> kWeights{5.0 / 18, 8.0 / 18, 5.0 / 18};
    const double height = std::numbers::pi / rows;
    std::array<double, 3> out{};
    for (size_t i = 0; i < 3; ++i) {
        const double fromEdge = 0.5 * kNodes[i], weight = 0.5 * kWeights[i] * height;
        const double upper = weight * std::sin((row + fromEdge) * height);
        const double lower = weight * std::sin((row + 1 - fromEdge) * height);
        out[0] += upper * (0.5 - fromEdge);
        out[1] += (upper + lower) * (0.5 + fromEdge);
        out[2] += lower * (0.5 - fromEdge);
    }
    return out;
}

int rowOf(float v, int rows) { return std::clamp(static_cast<int>(v * static_cast<float>(rows)), 0, rows - 1); }

}  // namespace

EnvironmentMap::EnvironmentMap(RgbImage image, float turn) : image_(std::move(image)), turn_(turn) {
    const int width = image_.width, height = image_.height;
    std::vector<float> luminances(image_.pixels.size());
    glm::dvec3 sum(0);
    for (int y = 0; y < height; ++y) {
        cosines_.push_back(std::cos(std::numbers::pi * y / height));
        const auto weights = rowWeights(y, height);
        for (int x = 0; x < width; ++x) {
            glm::dvec3 texelSum(0);
            for (size_t k = 0; k < weights.size(); ++k) {
                const int row = y - 1 + static_cast<int>(k);
                texelSum += weights[k] * (0.125 * glm::dvec3(texel(x - 1, row)) + 0.75 * glm::dvec3(texel(x, row)) +
                                          0.125 * glm::dvec3(texel(x + 1, row)));
            }
            texelSum *= 2 * std::numbers::pi / width;
            sum += texelSum;
            luminances[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
                luminance(Rgb(texelSum));
        }
    }
    cosines_.push_back(-1);
    integral_ = Rgb(sum);
    texels_ = Distribution2D(luminances, width, height);
    if (texels_.empty()) throw Error("all pixels are black, expected an environment that shines");
}

Rgb EnvironmentMap::texel(int x, int y) const {
    const int column = x < 0 ? x + image_.width : x >= image_.width ? x - image_.width : x;
    return image_.at(column, std::clamp(y, 0, image_.height - 1));
}

Vec2 EnvironmentMap::toPicture(Vec3 d) const {
    float u = 0.5F - (std::atan2(d.x, d.z) - turn_) / (2 * kPi);
    u -= std::floor(u);
    // The angle by its tangent: its cosine alone is coarse near the poles.
    return {std::min(u, kOneMinusEpsilon), std::atan2(std::hypot(d.x, d.z), d.y) * kInvPi};
}

Rgb EnvironmentMap::radiance(Vec3 direction) const {
    const Vec2 uv = toPicture(direction);
    const Vec2 at(uv.x * static_cast<float>(image_.width) - 0.5F, uv.y * static_cast<float>(image_.height) - 0.5F);
    const Vec2 corner = glm::floor(at), f = at - corner;
    const int x = static_cast<int>(corner.x), y = static_cast<int>(corner.y);
    return (1 - f.y) * ((1 - f.x) * texel(x, y) + f.x * texel(x + 1, y)) +
           f.y * ((1 - f.x) * texel(x, y + 1) + f.x * texel(x + 1, y + 1));
}

float EnvironmentMap::densityPerArea(size_t row) const {
    return static_cast<float>(1 / (2 * std::numbers::pi * image_.height * (cosines_[row] - cosines_[row + 1])));
}

Vec3 EnvironmentMap::sample(Vec2 u, float& pdfW) const {
    float density = 0;
    const Vec2 uv = texels_.sample(u, density);
    const int row = rowOf(uv.y, image_.height);
    const auto r = static_cast<size_t>(row);
    pdfW = density * densityPerArea(r);
    const double down = static_cast<double>(uv.y) * image_.height - row;
    const double cosine = cosines_[r] + down * (cosines_[r + 1] - cosines_[r]);
    const auto sine = static_cast<float>(std::sqrt(std::max(0.0, 1 - cosine * cosine)));
    const float azimuth = 2 * kPi * (0.5F - uv.x) + turn_;
    return {sine * std::sin(azimuth), static_cast<float>(cosine), sine * std::cos(azimuth)};
}

float EnvironmentMap::pdfW(Vec3 direction) const {
    const Vec2 uv = toPicture(direction);
    const int row = rowOf(uv.y, image_.height);
    return texels_.pdf({uv.x, std::min(uv.y, kOneMinusEpsilon)}) * densityPerArea(static_cast<size_t>(row));
}

}  // namespace lsde
