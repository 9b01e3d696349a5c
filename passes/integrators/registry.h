// The table of methods.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "passes/integrator.h"

namespace lsde {

std::span<const IntegratorEntry> integrators();
// Throws UsageError that lists the names there are.
const IntegratorEntry& integratorByName(const std::string& name);

// One for each file of this folder.
std::unique_ptr<Integrator> makeEyeIntegrator(const IntegratorInput& input, bool photons);
std::unique_ptr<Integrator> makeLightIntegrator(const IntegratorInput& input);

}  // namespace lsde
