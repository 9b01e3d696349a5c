#include "sampling/sobol_order.h"

#include "sampling/low_discrepancy.h"

namespace lsde {

namespace {

// A digit of k as a sum of digits of the index (bits of `index`), being solved for them (bits of `k`).
struct Equation {
    uint32_t index = 0;
    uint32_t k = 0;

    Equation& operator^=(Equation b) {
        index ^= b.index;
        k ^= b.k;
        return *this;
    }
};

bool hasDigit(uint32_t digits, int d) { return ((digits >> d) & 1) != 0; }

// A coordinate's digit, 0 the first after the point, as a sum of the index's lowest digits.
uint32_t digitOfCoordinate(int digit, int dimension, int indexDigits) {
    uint32_t sum = 0;
    for (int j = 0; j < indexDigits; ++j)
        if (hasDigit(sobolReversed(uint64_t{1} << j, dimension), digit)) sum |= uint32_t{1} << j;
    return sum;
}

}  // namespace

SobolOrder::SobolOrder(int digits, int dimensionX, int dimensionY) : natural_(false) {
    // Gauss-Jordan: solved[d] has digit d of the index and none that another one has.
    std::array<Equation, kMostDigits> solved{};
    uint32_t solvedDigits = 0;
    for (int digit = 0, known = 0; known < digits; ++digit)
        for (const int dimension : {dimensionX, dimensionY}) {
            if (known == digits) break;
            Equation e{digitOfCoordinate(digit, dimension, digits), uint32_t{1} << (digits - 1 - known)};
            for (int d = 0; d < digits; ++d)
                if (hasDigit(solvedDigits, d) && hasDigit(e.index, d)) e ^= solved[static_cast<size_t>(d)];
            if (e.index == 0) continue;
            const int pivot = std::countr_zero(e.index);
            for (Equation& other : solved)
                if (hasDigit(other.index, pivot)) other ^= e;
            solved[static_cast<size_t>(pivot)] = e;
            solvedDigits |= uint32_t{1} << pivot;
            ++known;
        }
    for (int d = 0; d < digits; ++d)
        for (int k = 0; k < digits; ++k)
            if (hasDigit(solved[static_cast<size_t>(d)].k, k))
                contribution_[static_cast<size_t>(k)] |= uint32_t{1} << d;
}

}  // namespace lsde
