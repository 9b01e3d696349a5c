// What an index finds: photons by number and distance, in a list that keeps its memory from query to query.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

namespace lsde {

// The distance takes the upper half of the 64 bits (little-endian), the index the lower.
struct Neighbour {
    uint32_t index;         // of the photon in the map's order
    float distanceSquared;  // m2, (dx dx + dy dy) + dz dz in float, the same in every index

    friend bool operator==(const Neighbour&, const Neighbour&) = default;
    // Nearest first, ties by index: one comparison, as floats that are not negative are ordered like their bits.
    friend bool operator<(const Neighbour& a, const Neighbour& b) {
        return std::bit_cast<uint64_t>(a) < std::bit_cast<uint64_t>(b);
    }
};

// A vector that keeps its memory and does not initialise new elements, so that a vectorised writer may store past the
// end and then say how much of it counts.
template <typename T>
class ScratchList {
  public:
    // Where the next `count` elements go; valid until the next call.
    T* room(size_t count) {
        if (size_ + count > capacity_) grow(size_ + count);
        return data_.get() + size_;
    }
    void resizeWithin(size_t size) { size_ = size; }  // at most what room() made
    void push(const T& element) {
        *room(1) = element;
        ++size_;
    }
    void clear() { size_ = 0; }

    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T* begin() { return data_.get(); }
    T* end() { return data_.get() + size_; }
    const T* begin() const { return data_.get(); }
    const T* end() const { return data_.get() + size_; }
    T& operator[](size_t i) { return data_[i]; }
    const T& operator[](size_t i) const { return data_[i]; }

  private:
    void grow(size_t wanted) {
        capacity_ = std::max(wanted, 2 * capacity_);
        auto larger = std::make_unique_for_overwrite<T[]>(capacity_);
        std::copy_n(data_.get(), size_, larger.get());
        data_ = std::move(larger);
    }

    std::unique_ptr<T[]> data_;
    size_t size_ = 0, capacity_ = 0;
};
using NeighbourList = ScratchList<Neighbour>;

// Leaves those that accept(index) takes, in their order.
template <typename Accept>
void keepAccepted(NeighbourList& list, Accept&& accept) {
    const Neighbour* const end =
        std::remove_if(list.begin(), list.end(), [&](const Neighbour& n) { return !accept(n.index); });
    list.resizeWithin(static_cast<size_t>(end - list.begin()));
}

// Leaves the k smallest, sorted. All distanceSquared lie in [0, bound).
void keepNearest(NeighbourList& list, size_t k, float bound);

// The k-th smallest (k from 1) of values in [0, bound), which are reordered.
float kthSmallest(std::span<float> values, size_t k, float bound);

}  // namespace lsde
