#include "transport/direct_light.h"

#include "base/error.h"
#include "sampling/mis.h"
#include "transport/cone.h"

namespace lsde {

namespace {

constexpr size_t kMostEmitters = 8;
// Of a hemisphere, by the cosine: where emitters may take this share, each walk looks for them.
constexpr float kNearEmitters = 0.125F;

}  // namespace

LightSampler::LightSampler(const Scene& scene, const std::vector<bool>& selected) {
    std::vector<double> weights(scene.lights().size());
    double total = 0;
    size_t count = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        if (!selected[i]) continue;
        weights[i] = luminance(scene.lights()[i].power());
        total += weights[i];
        ++count;
    }
    if (count == 0) throw Error(scene.description().file.string() + ": no light is selected");
    // A fifth of the choice is even, the rest by power.
    for (size_t i = 0; i < weights.size(); ++i)
        if (selected[i])
            weights[i] = 0.2 / static_cast<double>(count) +
                         (total > 0 ? 0.8 * weights[i] / total : 0.8 / static_cast<double>(count));
    choice_ = DiscreteDistribution(weights);
    std::vector<Sphere> emitters;
    for (size_t i = 0; i < weights.size(); ++i)
        if (const auto* area = std::get_if<AreaLight>(&scene.lights()[i].shape); area != nullptr && selected[i])
            emitters.push_back({area->bounds.centre(), area->bounds.radius()});
    onePoint_ = count == 1 && emitters.empty();
    if (!emitters.empty()) emitters_ = groupCasters(std::move(emitters), kMostEmitters);
}

float LightSampler::bsdfSamples(const Vertex& vertex) const {
    const Vec3 normal = vertex.wo.z < 0 ? -vertex.surface.ns : vertex.surface.ns;
    float share = 0;
    for (const Caster& e : emitters_) share += cosineShare(coneTo(e.bounds, vertex.surface.position), normal);
    return std::min(1.0F, share / kNearEmitters);
}

DirectLight sampleDirectLight(const Scene& scene, const LightSampler& lights, const Vertex& vertex,
                              const DirectLightQuery& query, float uLight, Vec2 u, WalkScratch& scratch) {
    DirectLight out;
    const size_t index = lights.choose(uLight);
    const Light& light = scene.lights()[index];
    LightSample sample;
    if (!light.sampleToward(vertex.surface.position, u, sample)) return out;
    const Vec3 wi = vertex.frame.toLocal(sample.wi);
    const float wiNg = glm::dot(sample.wi, vertex.surface.ng), woNg = glm::dot(vertex.woWorld, vertex.surface.ng);
    // The geometric and the shading side must agree, as in scatter().
    if (wiNg * wi.z <= 0 || woNg * vertex.wo.z <= 0) return out;
    const BsdfEval f = evalBsdf(vertex.bsdf, vertex.wo, wi);
    const bool diffuse = query.diffuse && !isBlack(f.diffuse.f);
    const bool glossy = query.glossy && !isBlack(f.glossy.f);
    if (!diffuse && !glossy) return out;
    const Visibility v = visibility(scene, vertex, sample.wi, sample.distance - sample.clearance, scratch);
    if (isBlack(v.transmittance)) return out;
    out.straightPassages = v.straightPassages;
    const float pdf = sample.pdfW * lights.probability(index);
    const Rgb arriving = sample.radiance * v.transmittance * (std::fabs(wi.z) / pdf);
    const float others = light.isDelta() ? 0 : query.bsdfSamples;
    if (diffuse) out.diffuse = arriving * f.diffuse.f * powerHeuristic(pdf, others * f.diffuse.pdfW);
    if (glossy) out.glossy = arriving * f.glossy.f * powerHeuristic(pdf, others * f.glossy.pdfW);
    return out;
}

float directLightPdf(const Scene& scene, const LightSampler& lights, const Surface& hit, Vec3 wi, float distance) {
    const auto index = static_cast<size_t>(scene.meshes()[hit.mesh].light);
    const auto& area = std::get<AreaLight>(scene.lights()[index].shape);
    const float cosine = std::fabs(glm::dot(hit.ng, wi));
    if (!(cosine > 0)) return 0;
    return lights.probability(index) * area.pdfA(hit.triangle) * square(distance) / cosine;
}

}  // namespace lsde
