#include "bsdf/bsdf.h"

#include "bsdf/fresnel.h"

namespace lsde {

namespace {

template <typename... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;  // clang 16 does not deduce aggregates by itself

// One of the lobes, by its power.
bool sampleDelta(const DeltaLobes& lobes, float uLobe, BsdfSample& sample) {
    const float first = maxComponent(lobes.lobe[0].weight);
    const float second = lobes.count > 1 ? maxComponent(lobes.lobe[1].weight) : 0;
    if (lobes.count == 0 || !(first + second > 0)) return false;
    const float p = first / (first + second);
    sample = lobes.lobe[uLobe < p ? 0 : 1];
    // The same for the way back: reflectance and tint are, from either side.
    const float chosen = uLobe < p ? p : 1 - p;
    choose(sample, chosen, chosen);
    return true;
}

Rgb interfaceAlbedo(float eta, Rgb tint) {
    const float f0 = fresnelDielectric(1, eta).reflectance;
    return Rgb(f0) + (1 - f0) * tint;
}

}  // namespace

BsdfEval evalBsdf(const Bsdf& bsdf, Vec3 wo, Vec3 wi, Asked asked) {
    return std::visit(
        Overloaded{[&](const DiffuseBsdf& b) { return b.eval(wo, wi); },
                   [&](const MetalRoughBsdf& b) { return b.eval(wo, wi, asked); },
                   [&](const TransmissiveBsdf& b) { return b.eval(wo, wi); },
                   [&](const LayeredBsdf& b) { return b.eval(wo, wi, asked); }, [](const auto&) { return BsdfEval{}; }},
        bsdf);
}

bool sampleBsdf(const Bsdf& bsdf, Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) {
    if (wo.z == 0) return false;
    return std::visit(Overloaded{[&](const DiffuseBsdf& b) { return b.sample(wo, u, sample); },
                                 [&](const MetalRoughBsdf& b) { return b.sample(wo, uLobe, u, sample); },
                                 [&](const TransmissiveBsdf& b) { return b.sample(wo, uLobe, u, sample); },
                                 [&](const LayeredBsdf& b) { return b.sample(wo, uLobe, u, sample); },
                                 [&](const auto&) { return sampleDelta(deltaLobes(bsdf, wo), uLobe, sample); }},
                      bsdf);
}

DeltaLobes deltaLobes(const Bsdf& bsdf, Vec3 wo) {
    DeltaLobes out;
    if (wo.z == 0 || !hasDelta(bsdf)) return out;
    const auto reflection = [&](const auto& b) {
        out.lobe[0] = b.reflect(wo);
        out.count = 1;
    };
    const auto both = [&](const auto& b) { out.count = b.lobes(wo, out.lobe.data()); };
    std::visit(Overloaded{[&](const MirrorBsdf& b) { reflection(b); }, [&](const MetalRoughBsdf& b) { reflection(b); },
                          [&](const DielectricBsdf& b) { both(b); }, [&](const ThinDielectricBsdf& b) { both(b); },
                          [&](const TransmissiveBsdf& b) { both(b); }, [&](const LayeredBsdf& b) { both(b); },
                          [](const auto&) {}},
               bsdf);
    return out;
}

bool sampleNonDelta(const Bsdf& bsdf, Vec3 wo, float uLobe, Vec2 u, BsdfSample& sample) {
    if (wo.z == 0) return false;
    return std::visit(Overloaded{[&](const DiffuseBsdf& b) { return b.sample(wo, u, sample); },
                                 [&](const MetalRoughBsdf& b) { return b.sampleNonDelta(wo, uLobe, u, sample); },
                                 [&](const TransmissiveBsdf& b) { return b.sampleNonDelta(wo, uLobe, u, sample); },
                                 [&](const LayeredBsdf& b) { return b.sampleNonDelta(wo, uLobe, u, sample); },
                                 [](const auto&) { return false; }},
                      bsdf);
}

bool hasDelta(const Bsdf& bsdf) {
    return std::visit(Overloaded{[](const BlackBsdf&) { return false; }, [](const DiffuseBsdf&) { return false; },
                                 [](const MetalRoughBsdf& b) { return b.hasGlossy() && b.glossyIsDelta(); },
                                 [](const TransmissiveBsdf& b) { return b.isDelta(); },
                                 [](const LayeredBsdf& b) { return b.hasDelta(); }, [](const auto&) { return true; }},
                      bsdf);
}

bool hasDiffuseLobe(const Bsdf& bsdf) {
    return std::visit(
        Overloaded{[](const DiffuseBsdf&) { return true; }, [](const MetalRoughBsdf& b) { return b.hasDiffuse(); },
                   [](const TransmissiveBsdf& b) { return b.hasDiffuse(); },
                   [](const LayeredBsdf& b) { return b.hasDiffuse(); }, [](const auto&) { return false; }},
        bsdf);
}

bool hasGlossyLobe(const Bsdf& bsdf) {
    return std::visit(Overloaded{[](const MetalRoughBsdf& b) { return b.hasGlossy() && !b.glossyIsDelta(); },
                                 [](const TransmissiveBsdf& b) { return !b.isDelta(); },
                                 [](const LayeredBsdf& b) { return b.hasGlossy(); }, [](const auto&) { return false; }},
                      bsdf);
}

bool glossyLobePasses(const Bsdf& bsdf) {
    const auto* b = std::get_if<TransmissiveBsdf>(&bsdf);
    return b != nullptr && !b->isDelta();
}

VertexClass glossyClass(const Bsdf& bsdf) {
    const auto classOfRoughness = [](float roughness) {
        if (roughness >= kGlossyRoughness) return VertexClass::Diffuse;
        return roughness == 0 ? VertexClass::Bend : VertexClass::Glossy;
    };
    return std::visit(Overloaded{[&](const MetalRoughBsdf& b) { return classOfRoughness(b.widestRoughness()); },
                                 [&](const TransmissiveBsdf& b) { return classOfRoughness(b.roughness); },
                                 [&](const LayeredBsdf& b) { return classOfRoughness(b.glossyRoughness()); },
                                 [](const auto&) { return VertexClass::Diffuse; }},
                      bsdf);
}

VertexClass classOf(const Bsdf& bsdf, const BsdfSample& sample) {
    if (sample.delta) return sample.straight ? VertexClass::Straight : VertexClass::Bend;
    return sample.event == Event::Glossy ? glossyClass(bsdf) : VertexClass::Diffuse;
}

Rgb straightTransmittance(const Bsdf& bsdf, float cosTheta) {
    return std::visit(Overloaded{[&](const ThinDielectricBsdf& b) { return b.transmittance(cosTheta); },
                                 [&](const TransmissiveBsdf& b) { return b.straightTransmittance(cosTheta); },
                                 [](const auto&) { return Rgb(0); }},
                      bsdf);
}

Rgb albedo(const Bsdf& bsdf) {
    return std::visit(Overloaded{[](const BlackBsdf&) { return Rgb(0); }, [](const DiffuseBsdf& b) { return b.albedo; },
                                 [](const MirrorBsdf& b) { return b.f0; },
                                 [](const DielectricBsdf& b) { return interfaceAlbedo(b.eta, b.tint); },
                                 [](const ThinDielectricBsdf& b) { return interfaceAlbedo(b.ior, b.tint); },
                                 [](const MetalRoughBsdf& b) { return b.albedo(); },
                                 [](const TransmissiveBsdf& b) { return b.albedo(); },
                                 [](const LayeredBsdf& b) { return b.albedo(); }},
                      bsdf);
}

}  // namespace lsde
