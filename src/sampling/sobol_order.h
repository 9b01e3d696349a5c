// An order of Sobol's points in which neighbours follow each other.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace lsde {

// An aligned block of 2^m points of Sobol's sequence along a Z-curve (Morton 1966) over two of its dimensions, without
// sorting: digits of coordinates are linear over GF(2) in those of the index, so this order is as well, and found by
// elimination. Owen's scramble permutes cells within their cell, so it holds for scrambled points. Where digits of the
// two dimensions depend on each other, as many as are independent count, the leading ones first.
class SobolOrder {
  public:
    static constexpr int kMostDigits = 32;

    SobolOrder() = default;  // the sequence's own order
    // digits: m <= kMostDigits; dimensions are below kSobolTableDimensions.
    SobolOrder(int digits, int dimensionX, int dimensionY);

    // Index within the block of its point number k < 2^m along the curve.
    uint64_t index(uint64_t k) const {
        if (natural_) return k;
        uint64_t i = 0;
        for (; k != 0; k &= k - 1) i ^= contribution_[static_cast<size_t>(std::countr_zero(k))];
        return i;
    }

  private:
    bool natural_ = true;
    std::array<uint32_t, kMostDigits> contribution_{};  // to the index, of each digit of k
};

}  // namespace lsde
