#include "path/path_code.h"

namespace lsde {

bool PathCode::valid() const {
    const int n = size();
    if (n > kMaxEvents || (overflowed() && n < kMaxEvents)) return false;
    for (int i = 0; i < n; ++i)
        if (static_cast<int>(at(i)) >= kEventCount) return false;
    const uint64_t events = bits_ & ((uint64_t{1} << kSizeShift) - 1);
    return (events >> (2 * n)) == 0;
}

std::string PathCode::letters() const {
    std::string out;
    for (int i = 0; i < size(); ++i) out += "DGS"[static_cast<size_t>(at(i))];
    if (overflowed()) out += "...";
    return out;
}

}  // namespace lsde
