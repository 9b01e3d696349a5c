#include "sampling/cie.h"

namespace lsde {

constexpr std::array<CieRow, kCieRows> kCie{{
#include "data/cie_1931_d65.inc"
}};
static_assert(kCie.front().nm == kCieFirstNm &&
              kCie.back().nm == kCieFirstNm + kCieStepNm * static_cast<int>(kCieRows - 1));

glm::dvec3 cieObserver(double nm) {
    const double at = (nm - kCieFirstNm) / kCieStepNm;
    if (!(at >= 0 && at <= static_cast<double>(kCieRows - 1))) return glm::dvec3(0);
    const size_t i = at < static_cast<double>(kCieRows - 2) ? static_cast<size_t>(at) : kCieRows - 2;
    const CieRow &a = kCie[i], &b = kCie[i + 1];
    return glm::mix(glm::dvec3(a.x, a.y, a.z), glm::dvec3(b.x, b.y, b.z), at - static_cast<double>(i));
}

}  // namespace lsde
