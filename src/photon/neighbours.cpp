#include "photon/neighbours.h"

#include <array>

namespace lsde {

namespace {

// Squared distances of photons on a surface are nearly uniform, so that equal buckets of them all but sort them.
constexpr uint32_t kBuckets = 256;
// More in one bucket: distances are distributed too oddly for buckets to sort.
constexpr uint32_t kFullBucket = 64;

class Buckets {
  public:
    explicit Buckets(float bound) : scale_(std::min(kBuckets / bound, 1e30F)) {}
    uint32_t operator()(float value) const {
        // Through int32_t: a single instruction.
        return std::min(static_cast<uint32_t>(static_cast<int32_t>(value * scale_)), kBuckets - 1);
    }

  private:
    float scale_;
};

void insertionSort(Neighbour* begin, const Neighbour* end) {
    for (Neighbour* i = begin + 1; i < end; ++i) {
        const Neighbour n = *i;
        Neighbour* to = i;
        for (; to > begin && n < to[-1]; --to) *to = to[-1];
        *to = n;
    }
}

void keepNearestBySorting(NeighbourList& list, size_t k) {
    const size_t kept = std::min(k, list.size());
    std::partial_sort(list.begin(), list.begin() + kept, list.end());
    list.resizeWithin(kept);
}

}  // namespace

void keepNearest(NeighbourList& list, size_t k, float bound) {
    const Buckets bucketOf(bound);
    std::array<uint32_t, kBuckets + 1> begins{};  // of the buckets, in the sorted list
    for (const Neighbour& n : list) ++begins[bucketOf(n.distanceSquared) + 1];
    size_t used = 0;  // buckets that hold the k nearest
    for (; used < kBuckets && begins[used] < k; ++used) {
        if (begins[used + 1] > kFullBucket) return keepNearestBySorting(list, k);
        begins[used + 1] += begins[used];
    }
    const size_t candidates = begins[used];
    Neighbour* const sorted = list.room(candidates);
    for (const Neighbour& n : list) {
        const uint32_t bucket = bucketOf(n.distanceSquared);
        if (bucket < used) sorted[begins[bucket]++] = n;
    }
    insertionSort(sorted, sorted + candidates);
    list.resizeWithin(std::min(k, candidates));
    std::copy_n(sorted, list.size(), list.begin());
}

float kthSmallest(std::span<float> values, size_t k, float bound) {
    const Buckets bucketOf(bound);
    std::array<uint32_t, kBuckets> sizes{};
    for (const float v : values) ++sizes[bucketOf(v)];
    uint32_t bucket = 0;  // that of the k-th
    for (; k > sizes[bucket]; ++bucket) k -= sizes[bucket];
    size_t count = 0;
    for (const float v : values)
        if (bucketOf(v) == bucket) values[count++] = v;
    const auto kth = values.begin() + (static_cast<ptrdiff_t>(k) - 1);
    std::nth_element(values.begin(), kth, values.begin() + static_cast<ptrdiff_t>(count));
    return *kth;
}

}  // namespace lsde
