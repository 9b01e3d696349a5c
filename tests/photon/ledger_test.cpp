#include "photon/ledger.h"

#include <doctest/doctest.h>

#include "photon/photons.h"

using namespace lsde;

namespace {

Ledger randomLedger(uint32_t seed) {
    test::Random random(seed);
    Ledger ledger(2, 3);
    for (int c = 1; c < kLedgerColumns; ++c) {
        const FixedRgb power(random.inCube());
        ledger.columns[static_cast<size_t>(c)] = power;
        ledger[LedgerColumn::Emitted] += power;
    }
    for (FixedRgb& f : ledger.flux) f = FixedRgb(random.inCube());
    ledger.emittedByLight[1] = FixedRgb(random.inCube());
    ledger.pathsByLight[1] = random.bits();
    ledger.landed = {1, seed, 3};
    ledger.unclassified = seed;
    ledger.maxAimWeight = random.uniform();
    return ledger;
}

}  // namespace

TEST_CASE("merged ledgers are the same sums in any order, and keep their balance") {
    Ledger forwards(2, 3), backwards(2, 3);
    for (uint32_t i = 0; i < 10; ++i) {
        forwards.merge(randomLedger(i));
        backwards.merge(randomLedger(9 - i));
    }
    CHECK(forwards.columns == backwards.columns);
    CHECK(forwards.flux == backwards.flux);
    CHECK(forwards.emittedByLight == backwards.emittedByLight);
    CHECK(forwards.pathsByLight == backwards.pathsByLight);
    CHECK(forwards.landed == std::array<uint64_t, 3>{10, 45, 30});
    CHECK(forwards.unclassified == 45);
    CHECK(forwards.maxAimWeight == backwards.maxAimWeight);
    CHECK(forwards.balance() == FixedRgb());
}

TEST_CASE("power that went nowhere shows in the balance") {
    Ledger ledger = randomLedger(1);
    ledger[LedgerColumn::Escaped] -= FixedRgb(Rgb(0, 1e-9F, 0));
    CHECK(ledger.balance() == FixedRgb(Rgb(0, 1e-9F, 0)));
}
