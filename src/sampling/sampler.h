// Random numbers that depend on (seed, stage, index) only, never on a thread.
#pragma once

#include <cstdint>

#include "base/math.h"

namespace lsde {

// Which part of a run draws the numbers; stages are independent of each other.
enum class Stage : uint32_t {
    Emission = 1,
    EmissionPilot = 2,
    Camera = 3,
    Reference = 4,
    LightTracer = 5,
    LightTrials = 6,
    Test = 99
};

// One path's stream of dimensions. Two kinds behind one type, so that the walk knows neither:
//   sequence: dimensions 0..kSobolDimensions-1 are an Owen-scrambled Sobol point by 64-bit index (Owen 1995; Burley
//             2020 for the scramble by hash), one sequence for the whole stage: for emission, where path i is index i;
//             beyond them counter-based hashes;
//   pixel:    an own Owen-scrambled Sobol sequence for each pixel (index = sample number), padded beyond its dimensions
//             by independently shuffled and scrambled ones, kSetDimensions at a time (Burley 2020), without end.
class Sampler {
  public:
    static constexpr int kSobolDimensions = 8;
    static constexpr int kSetDimensions = 4;
    static constexpr int kWavelengthDimension = 8;  // of Sobol's; next() does not use it

    static Sampler sequence(uint64_t seed, Stage stage, uint64_t index);
    static Sampler pixel(uint64_t seed, Stage stage, uint32_t x, uint32_t y, uint64_t sampleIndex);

    float next();   // uniform in [0,1), a multiple of 2^-24
    Vec2 next2D();  // two dimensions of one set
    // Of the path's wavelength: a dimension of its own, so that it is stratified with the others and changes none of
    // them. Always the same number; ask before the first fork.
    float wavelengthNumber() const;
    // Skips to dimension d (never back), so that a fixed purpose keeps its dimension whatever was drawn before.
    void skipTo(int dimension);
    // An independent stream for a branch of a split path; the parent goes on unchanged. The branches of a pixel's
    // samples stay stratified among each other where they fork at the same dimension.
    Sampler fork(uint32_t branch) const;

  private:
    uint64_t seedOf(uint64_t dimension) const;

    uint64_t key_ = 0;
    uint64_t index_ = 0;
    uint32_t dimension_ = 0;
    bool perPixel_ = false;
    uint32_t set_ = 0;  // of the padded sets, the one that setIndex_ belongs to
    uint64_t setIndex_ = 0;
};

}  // namespace lsde
