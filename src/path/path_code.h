// The events of a light path, packed in 64 bits: two bits an event, light first, and their number.
#pragma once

#include <cstdint>
#include <string>

#include "path/event.h"

namespace lsde {

class PathCode {
  public:
    static constexpr int kMaxEvents = 29;

    PathCode() = default;
    explicit PathCode(uint64_t bits) : bits_(bits) {}

    // A code that is full keeps its first 29 events and is flagged.
    void append(Event e) {
        const int n = size();
        if (n == kMaxEvents) {
            bits_ |= kOverflowBit;
            return;
        }
        bits_ |= static_cast<uint64_t>(e) << (2 * n);
        bits_ += uint64_t{1} << kSizeShift;
    }
    int size() const { return static_cast<int>((bits_ >> kSizeShift) & 31); }
    Event at(int i) const { return static_cast<Event>((bits_ >> (2 * i)) & 3); }
    bool overflowed() const { return (bits_ & kOverflowBit) != 0; }
    uint64_t bits() const { return bits_; }
    // Whether append() can have made this code: else a wrong letter, bits past the end, or flagged but not full.
    bool valid() const;
    std::string letters() const;  // e.g. "SSD"; "..." at the end if flagged

    friend bool operator==(PathCode, PathCode) = default;

  private:
    static constexpr int kSizeShift = 58;
    static constexpr uint64_t kOverflowBit = uint64_t{1} << 63;
    uint64_t bits_ = 0;
};

}  // namespace lsde
