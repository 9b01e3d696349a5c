#include "transport/direct_light.h"

#include "sampling/mis.h"

namespace lsde {

DirectLight sampleDirectLight(const Scene& scene, const LightChoice& lights, const Vertex& vertex,
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
    const Rgb arriving = sample.radiance * v.transmittance * (std::fabs(wi.z) / (pdf * square(f.eta)));
    const float others = light.isDelta() ? 0 : query.bsdfSamples;
    if (diffuse) out.diffuse = arriving * f.diffuse.f * powerHeuristic(pdf, others * f.diffuse.pdfW);
    if (glossy) out.glossy = arriving * f.glossy.f * powerHeuristic(pdf, others * f.glossy.pdfW);
    return out;
}

float directLightPdf(const Scene& scene, const LightChoice& lights, Vec3 from, const Surface& hit, Vec3 wi,
                     float distance) {
    const auto index = static_cast<size_t>(scene.meshes()[hit.mesh].light);
    const auto& area = std::get<AreaLight>(scene.lights()[index].shape);
    return lights.probability(index) * area.pdfToward(from, hit.triangle, wi, distance);
}

float directLightPdf(const Scene& scene, const LightChoice& lights, size_t light, Vec3 wi) {
    return lights.probability(light) * std::get<InfiniteLight>(scene.lights()[light].shape).pdfW(wi);
}

}  // namespace lsde
