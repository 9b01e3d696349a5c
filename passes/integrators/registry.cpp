#include "passes/integrators/registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace lsde {

namespace {

bool hasDeltaLight(const Scene& scene) {
    return std::any_of(scene.lights().begin(), scene.lights().end(), [](const Light& l) { return l.isDelta(); });
}

bool hasCaster(const Scene& scene) {
    return std::any_of(scene.meshes().begin(), scene.meshes().end(), [](const MeshInfo& m) { return m.caster; });
}

std::string nothing(const Scene&) { return {}; }

std::string pathTracerMisses(const Scene& scene) {
    if (!hasDeltaLight(scene) || !hasCaster(scene)) return {};
    return "the path tracer cannot make LS+D.*E under point, spot and directional lights: their caustics are missing "
           "(use render, or --integrator light)";
}

std::string lightTracerMisses(const Scene& scene) {
    if (!hasCaster(scene)) return "the light tracer cannot make LE: sources seen by the camera are missing";
    return "the light tracer cannot make L.*S+E and LE: what the camera sees in mirrors and through glass, and the "
           "sources "
           "themselves, are missing";
}

const std::vector<IntegratorEntry>& table() {
    static const std::vector<IntegratorEntry> kTable{
        {"photon", "multi-pass photon mapping: direct light, specular recursion, photon estimate of LS+D, continuation",
         "L[DS]*E", true, true, [](const IntegratorInput& i) { return makeEyeIntegrator(i, true); }, nothing},
        {"path", "unidirectional path tracing with multiple importance sampling", "L[DS]*E", false, true,
         [](const IntegratorInput& i) { return makeEyeIntegrator(i, false); }, pathTracerMisses},
        {"light", "light tracing: light paths connected to the camera at every non-specular surface", "L[DS]*DE", false,
         false, makeLightIntegrator, lightTracerMisses},
    };
    return kTable;
}

}  // namespace

std::span<const IntegratorEntry> integrators() { return table(); }

const IntegratorEntry& integratorByName(const std::string& name) {
    std::string names;
    for (const IntegratorEntry& entry : table()) {
        if (entry.name == name) return entry;
        names += (names.empty() ? "" : ", ") + entry.name;
    }
    throw UsageError(fmt::format("--integrator {}: does not exist, expected one of: {}", name, names));
}

}  // namespace lsde
