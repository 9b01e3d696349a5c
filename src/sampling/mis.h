// Multiple importance sampling (Veach & Guibas 1995).
#pragma once

namespace lsde {

// Weight of the technique with density a against one with density b, one sample each, by the power heuristic (beta =
// 2).
inline float powerHeuristic(float a, float b) {
    if (!(a > 0)) return 0;
    const float r = b / a;  // the ratio, not the squares: densities of small lights overflow when squared
    return 1 / (1 + r * r);
}

}  // namespace lsde
