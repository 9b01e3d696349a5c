#include "scene/media_stack.h"

#include <algorithm>

namespace lsde {

bool MediaStack::contains(MediumId m) const {
    return std::find(entries_.begin(), entries_.begin() + size_, m) != entries_.begin() + size_;
}

bool MediaStack::enter(MediumId m) {
    if (size_ == kMaxDepth) return false;
    entries_[size_++] = m;
    return true;
}

void MediaStack::leave(MediumId m) {
    const auto end = entries_.begin() + size_;
    const auto at = std::find(entries_.begin(), end, m);
    if (at == end) return;
    std::copy(at + 1, end, at);
    entries_[--size_] = 0;
}

MediumId MediaStack::dominant(std::span<const Medium> media) const {
    MediumId best = kOutside;
    for (int i = 0; i < size_; ++i) {
        const MediumId m = entries_[static_cast<size_t>(i)];
        if (best == kOutside || media[m].priority > media[best].priority) best = m;
    }
    return best;
}

void cross(Crossing& crossing, MediumId m, bool entering) {
    if (entering) {
        crossing.before.leave(m);
        if (!crossing.after.contains(m)) crossing.after.enter(m);
    } else {
        if (!crossing.before.contains(m)) crossing.before.enter(m);
        crossing.after.leave(m);
    }
}

}  // namespace lsde
