#include "photon/surface_extent.h"

#include <algorithm>
#include <array>
#include <utility>

#include "photon/kernel.h"

namespace lsde {

namespace {

constexpr int kDirections = 32;
// Below this the estimate rests on too little surface: at the tip of a face it stays too dark.
constexpr float kLeastShare = 0.1F;

struct Direction {
    float x, y;
};

const std::array<Direction, kDirections>& directions() {
    static const std::array<Direction, kDirections> table = [] {
        std::array<Direction, kDirections> d{};
        for (size_t i = 0; i < kDirections; ++i) {
            const float angle = (static_cast<float>(i) + 0.5F) * (2 * kPi / kDirections);
            d[i] = {std::cos(angle), std::sin(angle)};
        }
        return d;
    }();
    return table;
}

// The part of a segment within the slab |z| <= thickness, in the plane. False: none.
bool clipToSlab(Vec3 a, Vec3 b, float thickness, Vec2& from, Vec2& to) {
    float t0 = 0, t1 = 1;
    const float dz = b.z - a.z;
    for (const float side : {-1.0F, 1.0F}) {
        // side z <= thickness
        const float distance = thickness - side * a.z, slope = side * dz;
        if (slope > 0)
            t1 = std::min(t1, distance / slope);
        else if (slope < 0)
            t0 = std::max(t0, distance / slope);
        else if (distance < 0)
            return false;
    }
    if (t0 > t1) return false;
    from = Vec2(a + t0 * (b - a));
    to = Vec2(a + t1 * (b - a));
    return true;
}

// Signed, of the triangle of a, b and the centre.
float twiceArea(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

// Shortens each direction's reach (in radii) to where it meets the segment.
void cut(Vec2 a, Vec2 b, std::array<float, kDirections>& reach) {
    const Vec2 d = b - a;
    const float area = twiceArea(a, b);
    for (size_t i = 0; i < kDirections; ++i) {
        const Direction w = directions()[i];
        const float sideA = w.x * a.y - w.y * a.x, sideB = w.x * b.y - w.y * b.x;
        if ((sideA > 0) == (sideB > 0)) continue;
        const float t = area / (w.x * d.y - w.y * d.x);
        if (t >= 0 && t < reach[i]) reach[i] = t;
    }
}

constexpr int kCellBits = 21;

}  // namespace

SurfaceExtent::SurfaceExtent(std::span<const Segment> creases, float maxRadius)
    : creases_(creases.begin(), creases.end()), cell_(creases.empty() ? 0 : 2 * maxRadius) {
    if (!(cell_ > 0)) {
        cell_ = 0;
        return;
    }
    std::vector<std::pair<uint64_t, uint32_t>> entries;
    std::vector<uint64_t> cells;
    for (uint32_t i = 0; i < creases_.size(); ++i) {
        cells.clear();
        cellsNear(creases_[i], maxRadius, cells);
        for (const uint64_t c : cells) entries.emplace_back(c, i);
    }
    std::sort(entries.begin(), entries.end());
    for (const auto& [cell, crease] : entries) {
        Range& range = cells_.try_emplace(cell, Range{static_cast<uint32_t>(near_.size()), 0}).first->second;
        const auto& [a, b] = creases_[crease];
        near_.push_back({0.5F * (a + b), 0.5F * glm::length(b - a), crease});
        range.end = static_cast<uint32_t>(near_.size());
    }
}

uint64_t SurfaceExtent::cellOf(Vec3 p) const {
    uint64_t key = 0;
    // Cells a million apart share a key: their creases are looked at in vain, nothing worse.
    for (int i = 0; i < 3; ++i)
        key = (key << kCellBits) |
              (static_cast<uint64_t>(static_cast<int64_t>(std::floor(p[i] / cell_))) & ((1 << kCellBits) - 1));
    return key;
}

void SurfaceExtent::cellsNear(const Segment& crease, float maxRadius, std::vector<uint64_t>& out) const {
    const float length = glm::length(crease.b - crease.a);
    const int steps = 1 + static_cast<int>(length / cell_);
    // Points on the crease are at most half a step (half a cell) from a point looked at.
    const float margin = maxRadius + 0.5F * length / static_cast<float>(steps);
    for (int i = 0; i < steps; ++i) {
        const Vec3 p = crease.a + (crease.b - crease.a) * ((static_cast<float>(i) + 0.5F) / static_cast<float>(steps));
        // Twice the margin is at most two cells: three points a side meet every cell between.
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) out.push_back(cellOf(p + margin * Vec3(x, y, z)));
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
}

void SurfaceAround::clear() {
    cuts_ = 0;
    lanes_.clear();
    nearestSquared_ = kInfinity;
}

void SurfaceAround::add(Vec2 a, Vec2 b) {
    const size_t lane = cuts_++ % kLanes;
    if (lane == 0) lanes_.emplace_back();
    Cuts& c = lanes_.back();
    c.ax[lane] = a.x;
    c.ay[lane] = a.y;
    c.bx[lane] = b.x;
    c.by[lane] = b.y;
    c.area[lane] = twiceArea(a, b);
}

void SurfaceExtent::around(Vec3 centre, Vec3 normal, float radius, SurfaceAround& out) const {
    out.clear();
    if (cell_ == 0) return;
    const auto at = cells_.find(cellOf(centre));
    if (at == cells_.end()) return;
    out.frame_ = Frame(normal);
    out.centre_ = centre;
    for (uint32_t i = at->second.begin; i < at->second.end; ++i) {
        const Near& near = near_[i];
        if (lengthSquared(near.middle - centre) > square(radius + near.halfLength)) continue;
        const Segment& crease = creases_[near.crease];
        const Vec3 a = out.frame_.toLocal(crease.a - centre), b = out.frame_.toLocal(crease.b - centre);
        Vec2 from, to;
        if (!clipToSlab(a, b, kPlaneThickness * radius, from, to)) continue;
        // Nearest point of the crease to the centre, along the crease.
        const Vec2 along = to - from;
        const float t = std::clamp(-glm::dot(from, along) / std::max(glm::dot(along, along), 1e-20F), 0.0F, 1.0F);
        const Vec2 nearest = from + t * along;
        const float distanceSquared = glm::dot(nearest, nearest);
        if (!(distanceSquared < square(radius))) continue;
        out.add(from, to);
        out.nearestSquared_ = std::min(out.nearestSquared_, distanceSquared);
    }
}

float SurfaceAround::share(float radius) const {
    if (square(radius) <= nearestSquared_) return 1;
    std::array<float, kDirections> reach;
    reach.fill(1);
    for (size_t i = 0; i < cuts_; ++i) {
        const Cuts& c = lanes_[i / kLanes];
        const size_t lane = i % kLanes;
        cut(Vec2(c.ax[lane], c.ay[lane]) / radius, Vec2(c.bx[lane], c.by[lane]) / radius, reach);
    }
    float sum = 0;
    for (const float x : reach) sum += epanechnikovWithin(x);
    return std::max(kLeastShare, sum / kDirections);
}

bool SurfaceAround::hides(Vec3 p) const {
    const Vec3 q = frame_.toLocal(p - centre_);
    if (square(q.x) + square(q.y) <= nearestSquared_) return false;
    for (const Cuts& c : lanes_) {
        // The segments from the centre to q and from a to b cross.
        int crossing = 0;
        for (size_t i = 0; i < kLanes; ++i) {
            const float toA = q.x * c.ay[i] - q.y * c.ax[i], toB = q.x * c.by[i] - q.y * c.bx[i];
            const float photon = c.area[i] + toA - toB;
            crossing |= static_cast<int>((toA > 0) != (toB > 0)) & static_cast<int>((c.area[i] > 0) != (photon > 0));
        }
        if (crossing != 0) return true;
    }
    return false;
}

}  // namespace lsde
