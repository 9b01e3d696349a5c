#include "photon/dispersion.h"

#include <algorithm>
#include <cmath>

namespace lsde {

namespace {

// Fewer that do not overlap say little, and the largest are bounded by where there is light at all.
constexpr size_t kLeastDiscs = 4;
constexpr size_t kDiscs = 64;

}  // namespace

float Dispersion::at(float count) const {
    const float x = std::clamp(std::log2(count / kLeastCount), 0.0F, static_cast<float>(kCounts - 1));
    const auto lower = std::min(static_cast<size_t>(x), kCounts - 2);
    return glm::mix(at4TimesPowersOf2[lower], at4TimesPowersOf2[lower + 1], x - static_cast<float>(lower));
}

Dispersion larger(const Dispersion& a, const Dispersion& b) {
    Dispersion out;
    for (size_t i = 0; i < Dispersion::kCounts; ++i)
        out.at4TimesPowersOf2[i] = std::max(a.at4TimesPowersOf2[i], b.at4TimesPowersOf2[i]);
    return out;
}

Dispersion measureDispersion(std::span<const std::vector<PackedPhoton>> parts, ThreadPool& pool) {
    std::vector<PackedPhoton> all;
    for (size_t part = 0; part < parts.size(); ++part)
        for (PackedPhoton p : parts[part]) {
            p.payload.light = static_cast<uint16_t>(part);
            all.push_back(p);
        }
    const PhotonTree tree = buildPhotonTree(std::move(all), pool);
    const KdIndex index(view(tree));
    NeighbourList found;
    std::vector<double> numbers(parts.size());
    Dispersion out;
    for (size_t i = 0; i < Dispersion::kCounts; ++i) {
        const size_t expected = static_cast<size_t>(Dispersion::kLeastCount) << i, disc = expected * parts.size();
        if (tree.count < kLeastDiscs * disc) {
            // Beyond what is known: as before.
            if (i > 0) out.at4TimesPowersOf2[i] = out.at4TimesPowersOf2[i - 1];
            continue;
        }
        double squares = 0;
        for (size_t d = 0; d < kDiscs; ++d) {
            const auto centre = static_cast<uint32_t>((d * tree.count + tree.count / 2) / kDiscs);
            index.nearest(view(tree).position(centre), static_cast<uint32_t>(disc), kInfinity, found);
            std::fill(numbers.begin(), numbers.end(), -static_cast<double>(expected));
            for (const Neighbour& n : found) numbers[tree.payload[n.index].light] += 1;
            for (const double n : numbers) squares += square(n);
        }
        const double mean = squares / static_cast<double>(kDiscs * (parts.size() - 1));
        out.at4TimesPowersOf2[i] = static_cast<float>(std::min(1.0, mean / static_cast<double>(expected)));
    }
    return out;
}

}  // namespace lsde
