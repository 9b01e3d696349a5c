#include "scene/light.h"

#include "sampling/spherical_triangle.h"
#include "sampling/warp.h"
#include "scene/coverage.h"

namespace lsde {

namespace {

struct Corners {
    Vec3 a, b, c;
};

Corners corners(const Mesh& mesh, uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
}

Vec3 scaledNormal(const Corners& c) { return glm::cross(c.b - c.a, c.c - c.a); }

// Of a point on the triangle: weights of b and c.
Vec2 barycentric(const Corners& c, Vec3 p) {
    const Vec3 n = scaledNormal(c);
    const float inverse = 1 / lengthSquared(n);
    return {glm::dot(glm::cross(p - c.a, c.c - c.a), n) * inverse,
            glm::dot(glm::cross(c.b - c.a, p - c.a), n) * inverse};
}

// Whether all of it emits alike.
bool isEven(const AreaLight& light) {
    return !light.material->emissiveTexture && light.material->alphaMode == AlphaMode::Opaque;
}

// Mean luminance of a triangle's emission: the factor, times the texture's mean over a fixed grid of points.
double meanLuminance(const AreaLight& light, uint32_t triangle) {
    if (isEven(light)) return luminance(light.material->emission);
    constexpr int kGrid = 8;
    double sum = 0;
    int count = 0;
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; i + j < kGrid; ++j, ++count)
            sum += luminance(light.emitted(triangle, (static_cast<float>(i) + 1.0F / 3) / kGrid,
                                           (static_cast<float>(j) + 1.0F / 3) / kGrid));
    // A texture that is black at all of these points may still shine between them: a floor keeps it in the sample.
    return sum / count + 0.01 * luminance(light.material->emission);
}

Rgb meanRadiance(const AreaLight& light, uint32_t triangle) {
    if (isEven(light)) return light.material->emission;
    constexpr int kGrid = 32;
    Rgb sum(0);
    int count = 0;
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; i + j < kGrid; ++j, ++count)
            sum += light.emitted(triangle, (static_cast<float>(i) + 1.0F / 3) / kGrid,
                                 (static_cast<float>(j) + 1.0F / 3) / kGrid);
    return sum / static_cast<float>(count);
}

}  // namespace

AreaLight::AreaLight(const Mesh& m, const Material& mat, const std::vector<Texture>& tex)
    : mesh(&m), material(&mat), textures(&tex), twoSided(mat.doubleSided), bounds(m.bounds()) {
    std::vector<double> weights;
    glm::dvec3 sum(0);  // of many small parts
    for (uint32_t t = 0; t < m.triangles.size(); ++t) {
        const float area = 0.5F * glm::length(scaledNormal(corners(m, t)));
        areas.push_back(area);
        weights.push_back(area * meanLuminance(*this, t));
        sum += meanRadiance(*this, t) * area;
    }
    power = Rgb(sum) * (kPi * (twoSided ? 2.0F : 1.0F));
    triangles = DiscreteDistribution(weights);
}

Rgb AreaLight::radiance(uint32_t triangle, float u, float v) const {
    const TextureRef& ref = material->emissiveTexture;
    if (!ref) return material->emission;
    const auto& uvs = mesh->texCoords[ref.texCoord];
    Vec2 uv(0);
    if (!uvs.empty()) uv = interpolated(uvs, mesh->triangles[triangle], u, v);
    return material->emission * Vec3((*textures)[static_cast<size_t>(ref.texture)].sample(ref.transform(uv), true));
}

Rgb AreaLight::emitted(uint32_t triangle, float u, float v) const {
    return radiance(triangle, u, v) * coverage(*mesh, *material, *textures, triangle, u, v);
}

LightSample AreaLight::sampleToward(Vec3 p, Vec2 u) const {
    const auto t = static_cast<uint32_t>(triangles.sample(u.x));
    const Corners c = corners(*mesh, t);
    const Vec3 normal = glm::normalize(scaledNormal(c));
    const float height = glm::dot(normal, p - c.a);
    if (!(twoSided ? height != 0 : height > 0)) return {};
    LightSample s;
    Vec2 b;
    if (const auto seen = SphericalTriangle::seen(c.a - p, c.b - p, c.c - p)) {
        s.wi = seen->sample(u);
        s.distance = -height / glm::dot(normal, s.wi);
        b = barycentric(c, p + s.distance * s.wi);
        s.pdfW = triangles.pmf(t) / seen->solidAngle();
    } else {
        b = squareToTriangle(u);
        const Vec3 d = (1 - b.x - b.y) * c.a + b.x * c.b + b.y * c.c - p;
        s.distance = glm::length(d);
        s.wi = d / s.distance;
        s.pdfW = pdfA(t) * square(s.distance) / std::fabs(glm::dot(normal, s.wi));
    }
    if (!(s.distance > 0)) return {};
    s.radiance = emitted(t, b.x, b.y);
    s.clearance = surfaceEpsilon(largestCoordinates(c.a, c.b, c.c), s.distance) / std::fabs(glm::dot(normal, s.wi));
    return s;
}

float AreaLight::pdfToward(Vec3 p, uint32_t triangle, Vec3 wi, float distance) const {
    const Corners c = corners(*mesh, triangle);
    if (const auto seen = SphericalTriangle::seen(c.a - p, c.b - p, c.c - p))
        return triangles.pmf(triangle) / seen->solidAngle();
    const float cosine = std::fabs(glm::dot(glm::normalize(scaledNormal(c)), wi));
    return cosine > 0 ? pdfA(triangle) * square(distance) / cosine : 0;
}

EmissionPoint AreaLight::samplePoint(Vec2 u, float uSide) const {
    const auto t = static_cast<uint32_t>(triangles.sample(u.x));
    const Vec2 b = squareToTriangle(u);
    const Corners c = corners(*mesh, t);
    EmissionPoint e;
    e.position = (1 - b.x - b.y) * c.a + b.x * c.b + b.y * c.c;
    e.normal = glm::normalize(scaledNormal(c));
    e.radiance = emitted(t, b.x, b.y);
    e.pdfA = pdfA(t);
    e.epsilon = surfaceEpsilon(largestCoordinates(c.a, c.b, c.c), 0);
    if (twoSided) {
        if (uSide < 0.5F) e.normal = -e.normal;
        e.pdfA *= 0.5F;
    }
    return e;
}

float PointLight::falloff(Vec3 direction) const {
    if (profile != nullptr)
        return profile->relative({glm::dot(direction, right), glm::dot(direction, up), -glm::dot(direction, axis)});
    if (!isSpot()) return 1;
    const float oneMinusCos = 0.5F * lengthSquared(direction - axis);
    if (oneMinusCos <= oneMinusCosInner) return 1;
    return square(std::max(0.0F, (oneMinusCosOuter - oneMinusCos) / (oneMinusCosOuter - oneMinusCosInner)));
}

Rgb PointLight::power() const {
    if (profile != nullptr) return intensity * profile->solidAngle();
    if (!isSpot()) return intensity * (4 * kPi);
    // 2 pi times the integral of the falloff over the cosine: 1 within the inner cone, the square of a ramp beyond.
    return intensity * (2 * kPi * (oneMinusCosInner + (oneMinusCosOuter - oneMinusCosInner) / 3));
}

LightSample PointLight::sampleToward(Vec3 p) const {
    LightSample s;
    const Vec3 d = position - p;
    const float d2 = lengthSquared(d);
    if (!(d2 > 0)) return {};
    s.distance = std::sqrt(d2);
    s.wi = d / s.distance;
    s.radiance = intensity * (falloff(-s.wi) / d2);
    s.pdfW = 1;
    return s;
}

Rgb Light::power() const {
    if (const auto* area = std::get_if<AreaLight>(&shape)) return area->power;
    if (const auto* point = std::get_if<PointLight>(&shape)) return point->power();
    if (const auto* infinite = std::get_if<InfiniteLight>(&shape)) return infinite->power();
    return std::get<DirectionalLight>(shape).power();
}

bool Light::sampleToward(Vec3 p, Vec2 u, LightSample& sample) const {
    if (const auto* area = std::get_if<AreaLight>(&shape)) {
        sample = area->sampleToward(p, u);
    } else if (const auto* point = std::get_if<PointLight>(&shape)) {
        sample = point->sampleToward(p);
    } else if (const auto* infinite = std::get_if<InfiniteLight>(&shape)) {
        sample.distance = kInfinity;
        sample.wi = infinite->sample(u, sample.pdfW);
        sample.radiance = infinite->radiance(sample.wi);
    } else {
        const auto& sun = std::get<DirectionalLight>(shape);
        sample = {-sun.direction, kInfinity, sun.irradiance, 1};
    }
    return sample.pdfW > 0 && !isBlack(sample.radiance);
}

}  // namespace lsde
