// Energy of the maps against fluxes computed by other means.
#include <doctest/doctest.h>

#include "passes/pictures.h"

using namespace lsde;
using namespace lsde::test;

namespace {

PhotonMap emit(const std::string& scene, uint64_t photons, bool aim = true, bool all = false) {
    EmitSettings s;
    s.photons = photons;
    s.aim = aim;
    s.store = all ? Store::All : Store::Caustic;
    RunContext run(0, 1);
    return emitPhotons(sceneOf(scene), s, run);
}

double watts(const PhotonMap& map, const FixedRgb& sum) {
    return sum.toDouble(1) / static_cast<double>(map.header.emittedPaths());
}

double flux(const PhotonMap& map, PhotonClass c, const std::string& object) {
    const auto& objects = map.header.objects;
    for (size_t o = 0; o < objects.size(); ++o)
        if (objects[o] == object)
            return watts(map, map.header.ledger.flux[static_cast<size_t>(c) * objects.size() + o]);
    return -1;
}

// Power of the stored photons on the floor within r of the axis.
double storedWithin(const PhotonMap& map, float r) {
    const PhotonTreeView photons = map.photons(PhotonClass::Caustic);
    double sum = 0;
    for (uint32_t i = 0; i < photons.count; ++i) {
        const Vec3 p = photons.position(i);
        if (std::fabs(p.y) < 1e-3F && std::hypot(p.x, p.z) <= r) sum += unpackPower(photons.payload[i].power).y;
    }
    return sum / static_cast<double>(map.header.emittedPaths());
}

}  // namespace

// Analytic sphere, numpy, 6 million rays: standard errors are below 3e-4 of each.
TEST_CASE("the caustic of a glass ball under a lamp carries the flux of an analytic sphere") {
    for (const bool aim : {true, false}) {
        CAPTURE(aim);
        const PhotonMap map = emit("glass-sphere", aim ? 500000 : 2000000, aim);
        const double tolerance = aim ? 0.003 : 0.006;
        CHECK(flux(map, PhotonClass::Caustic, "floor") == doctest::Approx(4.7302).epsilon(tolerance));
        CHECK(storedWithin(map, 1) == doctest::Approx(4.4729).epsilon(tolerance));
        CHECK(storedWithin(map, 0.25F) == doctest::Approx(2.7150).epsilon(2 * tolerance));
        CHECK(flux(map, PhotonClass::Direct, "floor") == doctest::Approx(29.393).epsilon(0.01));
    }
}

TEST_CASE("so does that of a point light") {
    for (const bool aim : {true, false}) {
        CAPTURE(aim);
        // The scene's ball is coarser than the analytic one.
        const PhotonMap map = emit("point-glass-small", aim ? 500000 : 4000000, aim);
        CHECK(flux(map, PhotonClass::Caustic, "floor") == doctest::Approx(4.8963).epsilon(aim ? 0.006 : 0.015));
        CHECK(storedWithin(map, 1) == doctest::Approx(4.6247).epsilon(aim ? 0.006 : 0.015));
    }
}

TEST_CASE("the ledger's columns sum to what was emitted, exactly, and the columns that are zero on average are zero") {
    for (const char* scene : {"glass-sphere-small", "cornell-small", "water-glass-overlap", "rough-metal-area",
                              "bent-normals", "lights", "prism-small"})
        for (const bool all : {false, true}) {
            CAPTURE(scene);
            CAPTURE(all);
            const PhotonMap map = emit(scene, 60000, true, all);
            const Ledger& ledger = map.header.ledger;
            CHECK(ledger.balance() == FixedRgb());
            const double emitted = watts(map, ledger[LedgerColumn::Emitted]);
            // Sampling is stratified and of bounded weight: far within what independent paths would scatter.
            CHECK(std::fabs(watts(map, ledger[LedgerColumn::Sampling])) < 0.01 * emitted);
            CHECK(std::fabs(watts(map, ledger[LedgerColumn::Roulette])) < 0.03 * emitted);
        }
}

TEST_CASE("what is stored is what landed") {
    const PhotonMap map = emit("glass-sphere-small", 200000);
    double stored = 0;
    const PhotonTreeView photons = map.photons(PhotonClass::Caustic);
    for (uint32_t i = 0; i < photons.count; ++i) stored += unpackPower(photons.payload[i].power).y;
    double landed = 0;
    for (const std::string& object : map.header.objects) landed += flux(map, PhotonClass::Caustic, object);
    CHECK(stored / static_cast<double>(map.header.emittedPaths()) == doctest::Approx(landed).epsilon(1e-4));
}
