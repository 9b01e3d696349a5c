// Rows and columns near one of them.
#pragma once

#include <algorithm>

namespace lsde {

// Whole numbers, both ends included.
struct IntRange {
    int first, last;

    int count() const { return std::max(0, last - first + 1); }
    // Those of them up to `reach` from the centre.
    IntRange around(int centre, int reach) const {
        return {std::max(first, centre - reach), std::min(last, centre + reach)};
    }
};

}  // namespace lsde
