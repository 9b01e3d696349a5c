// A closed room whose walls emit 1 and reflect half: radiance is 2 everywhere, in every direction, whatever lossless
// bodies are in it.
#include <doctest/doctest.h>

#include "passes/pictures.h"

using namespace lsde;
using namespace lsde::test;

TEST_CASE("a white furnace is uniform, with and without glass and a mirror in it, by camera and by photons") {
    for (const char* scene : {"furnace", "furnace-glass"})
        for (const char* integrator : {"path", "photon"}) {
            CAPTURE(scene);
            CAPTURE(integrator);
            const Estimate e = estimate(scene, settingsFor(integrator, 32, 64, 100000), 8, 4);
            for (size_t i = 0; i < e.mean.size(); ++i) {
                CAPTURE(i);
                CHECK(std::fabs(e.mean[i] - 2) < 5 * e.error[i] + 0.004);
            }
        }
}

TEST_CASE("light tracing in the white furnace sees what the walls scatter") {
    // Walls emit 1 of the 2; the rest is scattered: the light tracer connects that, not the source itself.
    const Estimate e = estimate("furnace", settingsFor("light", 32, 256), 8, 4);
    for (size_t i = 0; i < e.mean.size(); ++i) CHECK(std::fabs(e.mean[i] - 1) < 5 * e.error[i] + 0.002);
}
