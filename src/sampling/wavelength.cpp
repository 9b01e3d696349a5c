#include "sampling/wavelength.h"

#include <array>
#include <cstddef>
#include <cstdlib>

#include "base/color.h"
#include "sampling/cie.h"

namespace lsde {

namespace {

constexpr int kBins = static_cast<int>(kCieRows - 1) * kCieStepNm;  // of 1 nm, each of even density

using Channels = std::array<double, 3>;

// Of a channel of linear Rec. 709 to D65's light, up to a factor.
Channels sensitivityOf(const CieRow& r) {
    const glm::dvec3 s = r.d65 * rec709FromXyz(glm::dvec3(r.x, r.y, r.z));
    return {s.x, s.y, s.z};
}

std::array<Channels, kCieRows> sensitivities() {
    std::array<Channels, kCieRows> out{};
    Channels sum{};
    for (size_t i = 0; i < kCieRows; ++i) {
        out[i] = sensitivityOf(kCie[i]);
        for (size_t c = 0; c < 3; ++c) sum[c] += out[i][c];
    }
    for (Channels& row : out)
        for (size_t c = 0; c < 3; ++c) row[c] /= sum[c];
    return out;
}

// Linear between rows. nm is counted from the first row.
Channels at(const std::array<Channels, kCieRows>& rows, double nm) {
    auto i = static_cast<size_t>(nm / kCieStepNm);
    if (i > kCieRows - 2) i = kCieRows - 2;
    const double t = nm / kCieStepNm - static_cast<double>(i);
    Channels out{};
    for (size_t c = 0; c < 3; ++c) out[c] = (1 - t) * rows[i][c] + t * rows[i + 1][c];
    return out;
}

double sumOfMagnitudes(const Channels& s) {
    double sum = 0;
    for (const double v : s) sum += v < 0 ? -v : v;
    return sum;
}

struct Entry {
    float nm = 0;
    std::array<float, 3> weight{1, 1, 1};
};
using Table = std::array<Entry, kWavelengths + 1>;

Table wavelengthTable() {
    const std::array<Channels, kCieRows> rows = sensitivities();
    std::array<double, static_cast<size_t>(kBins)> mass{};
    double total = 0;
    for (size_t b = 0; b < mass.size(); ++b) {
        mass[b] = sumOfMagnitudes(at(rows, static_cast<double>(b) + 0.5));
        total += mass[b];
    }
    // Number n stands for the middle of the n-th of equal parts of the mass.
    std::array<Channels, kWavelengths + 1> weights{};
    Table table{};
    Channels mean{};
    size_t bin = 0;
    double below = 0;
    for (size_t n = 1; n < table.size(); ++n) {
        const double target = total * (static_cast<double>(n) - 0.5) / kWavelengths;
        while (below + mass[bin] < target) below += mass[bin++];
        const double nm = static_cast<double>(bin) + (target - below) / mass[bin];
        table[n].nm = static_cast<float>(kCieFirstNm + nm);
        const Channels s = at(rows, nm);
        for (size_t c = 0; c < 3; ++c) {
            weights[n][c] = s[c] / mass[bin];
            mean[c] += weights[n][c] / kWavelengths;
        }
    }
    for (size_t n = 1; n < table.size(); ++n)
        for (size_t c = 0; c < 3; ++c) table[n].weight[c] = static_cast<float>(weights[n][c] / mean[c]);
    return table;
}

const Table& wavelengths() {
    static const Table kTable = wavelengthTable();
    return kTable;
}

}  // namespace

WavelengthId sampleWavelength(float u) { return static_cast<WavelengthId>(1 + static_cast<int>(u * kWavelengths)); }

float wavelengthNm(WavelengthId wavelength) { return wavelengths()[wavelength].nm; }

Rgb wavelengthWeight(WavelengthId wavelength) {
    const std::array<float, 3>& w = wavelengths()[wavelength].weight;
    return {w[0], w[1], w[2]};
}

float wavelengthKernel(WavelengthId a, WavelengthId b, float share) {
    const int reach = static_cast<int>(0.5F * share * kWavelengths);
    // b itself, and b reflected at either end of the numbers.
    const int apart = std::abs(a - b), belowFirst = a + b - 1, beyondLast = 2 * kWavelengths + 1 - a - b;
    const int hits = (apart <= reach ? 1 : 0) + (belowFirst <= reach ? 1 : 0) + (beyondLast <= reach ? 1 : 0);
    return static_cast<float>(hits * kWavelengths) / static_cast<float>(2 * reach + 1);
}

}  // namespace lsde
