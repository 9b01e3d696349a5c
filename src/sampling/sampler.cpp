#include "sampling/sampler.h"

#include <algorithm>

#include "base/hash.h"
#include "sampling/low_discrepancy.h"

namespace lsde {

static_assert(Sampler::kSobolDimensions <= Sampler::kWavelengthDimension);
static_assert(Sampler::kWavelengthDimension < kSobolTableDimensions);
static_assert(Sampler::kSobolDimensions % Sampler::kSetDimensions == 0);  // next2D() counts on it

// SplitMix64's stream that starts at the key.
uint64_t Sampler::seedOf(uint64_t dimension) const { return mix64(key_ + dimension * 0x9e3779b97f4a7c15ULL); }

Sampler Sampler::sequence(uint64_t seed, Stage stage, uint64_t index) {
    Sampler s;
    s.key_ = hashCombine(seed, static_cast<uint64_t>(stage));
    s.index_ = index;
    return s;
}

Sampler Sampler::pixel(uint64_t seed, Stage stage, uint32_t x, uint32_t y, uint64_t sampleIndex) {
    Sampler s;
    s.key_ = hashCombine(hashCombine(seed, static_cast<uint64_t>(stage)), static_cast<uint64_t>(y) << 32 | x);
    s.index_ = sampleIndex;
    s.perPixel_ = true;
    return s;
}

float Sampler::next() {
    const uint32_t dimension = dimension_++;
    const uint64_t seed = seedOf(dimension);
    if (dimension < kSobolDimensions) return toUnitFloat(scrambledSobol(index_, static_cast<int>(dimension), seed));
    if (!perPixel_) return toUnitFloat(static_cast<uint32_t>(mix64(seed ^ index_) >> 32));
    const uint32_t set = dimension / kSetDimensions;
    if (set != set_) {
        set_ = set;
        // The complement of a set's number is no dimension: shuffle and scrambles have different seeds.
        setIndex_ = shuffledIndex(index_, seedOf(~static_cast<uint64_t>(set)));
    }
    return toUnitFloat(scrambledSobol(setIndex_, static_cast<int>(dimension % kSetDimensions), seed));
}

Vec2 Sampler::next2D() {
    // The last dimension of a set has no partner in it.
    if (dimension_ + 1 >= kSobolDimensions && (dimension_ + 1) % kSetDimensions == 0) ++dimension_;
    const float x = next();
    return {x, next()};
}

float Sampler::wavelengthNumber() const {
    // The top bit keeps the seed apart from those of next()'s dimensions, and the lowest ones from those of sets.
    constexpr uint64_t kSeedOfWavelength = uint64_t{1} << 63;
    return toUnitFloat(scrambledSobol(index_, kWavelengthDimension, seedOf(kSeedOfWavelength)));
}

void Sampler::skipTo(int dimension) { dimension_ = std::max(dimension_, static_cast<uint32_t>(dimension)); }

Sampler Sampler::fork(uint32_t branch) const {
    Sampler s = *this;
    // The top bit keeps the keys of branches apart from those of dimensions.
    s.key_ = hashCombine(key_, uint64_t{1} << 63 | static_cast<uint64_t>(dimension_) << 32 | branch);
    s.set_ = 0;
    // The branch starts a shuffled (or hashed) set: points of the first set are taken in the parent's order.
    s.dimension_ = std::max<uint32_t>(dimension_, kSobolDimensions);
    s.dimension_ += (kSetDimensions - s.dimension_ % kSetDimensions) % kSetDimensions;
    return s;
}

}  // namespace lsde
