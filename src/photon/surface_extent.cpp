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

constexpr size_t kDeepest = 64;  // nodes: halving 2^32 creases

float distanceSquared(const Bounds& b, Vec3 p) {
    return lengthSquared(glm::max(glm::max(b.lo - p, p - b.hi), Vec3(0)));
}

// Adds the crease as far as it cuts the disc of `radius` about the centre.
template <typename Add>
void cutDisc(const Frame& frame, Vec3 centre, const Segment& crease, float radius, const Add& add) {
    Vec2 from, to;
    if (!clipToSlab(frame.toLocal(crease.a - centre), frame.toLocal(crease.b - centre), kPlaneThickness * radius, from,
                    to))
        return;
    // Nearest point of the crease to the centre, along the crease.
    const Vec2 along = to - from;
    const float t = std::clamp(-glm::dot(from, along) / std::max(glm::dot(along, along), 1e-20F), 0.0F, 1.0F);
    const Vec2 nearest = from + t * along;
    const float nearestSquared = glm::dot(nearest, nearest);
    if (nearestSquared < square(radius)) add(from, to, nearestSquared);
}

}  // namespace

SurfaceExtent::SurfaceExtent(std::span<const Segment> creases) {
    for (const Segment& s : creases) creases_.push_back({s, 0.5F * (s.a + s.b), 0.5F * glm::length(s.b - s.a)});
    if (!creases_.empty()) build(0, static_cast<uint32_t>(creases_.size()));
}

SurfaceExtent::Lanes::Lanes(std::span<const Crease> creases) {
    for (size_t i = 0; i < creases.size(); ++i) {
        const auto& [a, b] = creases[i].segment;
        const Vec3 d = b - a;
        ax[i] = a.x;
        ay[i] = a.y;
        az[i] = a.z;
        dx[i] = d.x;
        dy[i] = d.y;
        dz[i] = d.z;
        inverse[i] = 1 / std::max(lengthSquared(d), 1e-30F);
    }
}

std::array<float, SurfaceExtent::kLanes> SurfaceExtent::Lanes::distancesSquared(Vec3 p) const {
    std::array<float, kLanes> out;
    for (size_t i = 0; i < kLanes; ++i) {
        const float x = p.x - ax[i], y = p.y - ay[i], z = p.z - az[i];
        const float t = std::min(std::max((x * dx[i] + y * dy[i] + z * dz[i]) * inverse[i], 0.0F), 1.0F);
        const float qx = x - t * dx[i], qy = y - t * dy[i], qz = z - t * dz[i];
        out[i] = qx * qx + qy * qy + qz * qz;
    }
    return out;
}

bool SurfaceExtent::Lanes::anyCrosses(Vec3 p, Vec3 normal) const {
    int any = 0;
    for (size_t i = 0; i < kLanes; ++i) {
        const float sideA = (ax[i] - p.x) * normal.x + (ay[i] - p.y) * normal.y + (az[i] - p.z) * normal.z;
        const float sideB = sideA + dx[i] * normal.x + dy[i] * normal.y + dz[i] * normal.z;
        any |= static_cast<int>((sideA > 0) != (sideB > 0));
    }
    return any != 0;
}

void SurfaceExtent::build(uint32_t begin, uint32_t end) {
    const size_t at = nodes_.size();
    nodes_.push_back({{}, begin, end, 0});
    Bounds middles;
    for (uint32_t i = begin; i < end; ++i) {
        nodes_[at].bounds.grow(creases_[i].segment.a);
        nodes_[at].bounds.grow(creases_[i].segment.b);
        middles.grow(creases_[i].middle);
    }
    if (end - begin <= kLanes) {
        nodes_[at].leaf = true;
        nodes_[at].next = static_cast<uint32_t>(lanes_.size());
        lanes_.emplace_back(std::span(creases_).subspan(begin, end - begin));
        return;
    }
    const Vec3 extent = middles.extent();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(creases_.begin() + begin, creases_.begin() + middle, creases_.begin() + end,
                     [axis](const Crease& x, const Crease& y) { return x.middle[axis] < y.middle[axis]; });
    build(begin, middle);
    nodes_[at].next = static_cast<uint32_t>(nodes_.size());
    build(middle, end);
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

template <typename Reaches, typename Visit>
void SurfaceExtent::visitLeaves(const Reaches& reaches, const Visit& visit) const {
    std::array<uint32_t, kDeepest> waiting;
    waiting[0] = 0;
    size_t count = nodes_.empty() ? 0 : 1;
    while (count > 0) {
        const uint32_t at = waiting[--count];
        const Node& node = nodes_[at];
        if (!reaches(node.bounds)) continue;
        if (node.leaf) {
            if (visit(node)) return;
            continue;
        }
        waiting[count++] = node.next;
        waiting[count++] = at + 1;
    }
}

void SurfaceExtent::around(Vec3 centre, Vec3 normal, float radius, SurfaceAround& out) const {
    out.clear();
    if (nodes_.empty()) return;
    out.frame_ = Frame(normal);
    out.centre_ = centre;
    // In the plane the crease is nearer than the radius, and this far off it; and more than rounding.
    const float reach = square(radius) * (1 + square(kPlaneThickness)) * 1.001F;
    const auto cutLeaf = [&](const Node& leaf) {
        const auto distances = lanes_[leaf.next].distancesSquared(centre);
        for (uint32_t i = leaf.begin; i < leaf.end; ++i) {
            const Crease& crease = creases_[i];
            if (distances[i - leaf.begin] > reach ||
                lengthSquared(crease.middle - centre) > square(radius + crease.halfLength))
                continue;
            cutDisc(out.frame_, centre, crease.segment, radius, [&](Vec2 from, Vec2 to, float nearestSquared) {
                out.add(from, to);
                out.nearestSquared_ = std::min(out.nearestSquared_, nearestSquared);
            });
        }
        return false;
    };
    visitLeaves([&](const Bounds& bounds) { return distanceSquared(bounds, centre) <= reach; }, cutLeaf);
}

bool SurfaceExtent::separates(Vec3 centre, Vec3 normal, Vec3 p, float radius) const {
    const Vec3 toP = p - centre, inPlane = toP - glm::dot(toP, normal) * normal;
    const float length = glm::length(inPlane), thickness = kPlaneThickness * radius;
    if (!(length > 0)) return false;
    const Vec3 along = inPlane / length, across = glm::cross(normal, along);
    const auto crosses = [&](const Segment& crease) {
        const float sideA = glm::dot(crease.a - centre, across), sideB = glm::dot(crease.b - centre, across);
        if ((sideA > 0) == (sideB > 0)) return false;
        const Vec3 where = crease.a + sideA / (sideA - sideB) * (crease.b - crease.a) - centre;
        const float distance = glm::dot(where, along);
        return distance > 0 && distance < length && std::fabs(glm::dot(where, normal)) <= thickness;
    };
    Bounds path;
    path.grow(centre);
    path.grow(centre + inPlane);
    const Vec3 beside = 1.001F * thickness * glm::abs(normal) + Vec3(1e-6F * length);
    path = {path.lo - beside, path.hi + beside};
    bool found = false;
    visitLeaves([&](const Bounds& bounds) { return bounds.overlaps(path); },
                [&](const Node& leaf) {
                    if (!lanes_[leaf.next].anyCrosses(centre, across)) return false;
                    const auto creases = std::span(creases_).subspan(leaf.begin, leaf.end - leaf.begin);
                    found = std::any_of(creases.begin(), creases.end(),
                                        [&](const Crease& crease) { return crosses(crease.segment); });
                    return found;
                });
    return found;
}

float SurfaceExtent::clearance(Vec3 p) const {
    float nearest = kInfinity;
    visitLeaves([&](const Bounds& bounds) { return distanceSquared(bounds, p) < nearest; },
                [&](const Node& leaf) {
                    const auto distances = lanes_[leaf.next].distancesSquared(p);
                    for (uint32_t i = 0; i < leaf.end - leaf.begin; ++i) nearest = std::min(nearest, distances[i]);
                    return false;
                });
    return std::sqrt(nearest);
}

template <typename Part>
float SurfaceAround::meanOver(float radius, const Part& part) const {
    if (square(radius) <= nearestSquared_) return part(1);
    std::array<float, kDirections> reach;
    reach.fill(1);
    for (size_t i = 0; i < cuts_; ++i) {
        const Cuts& c = lanes_[i / kLanes];
        const size_t lane = i % kLanes;
        cut(Vec2(c.ax[lane], c.ay[lane]) / radius, Vec2(c.bx[lane], c.by[lane]) / radius, reach);
    }
    float sum = 0;
    for (const float x : reach) sum += part(x);
    return sum / kDirections;
}

float SurfaceAround::share(float radius) const { return std::max(kLeastShare, meanOver(radius, epanechnikovWithin)); }

float SurfaceAround::areaShare(float radius) const {
    return std::max(kLeastShare, meanOver(radius, [](float x) { return x * x; }));
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

bool SurfaceAround::creaseNear(Vec3 p, float distance) const {
    const Vec3 q = frame_.toLocal(p - centre_);
    if (std::sqrt(square(q.x) + square(q.y)) + distance < std::sqrt(nearestSquared_)) return false;
    for (const Cuts& c : lanes_) {
        int any = 0;
        for (size_t i = 0; i < kLanes; ++i) {
            const float dx = c.bx[i] - c.ax[i], dy = c.by[i] - c.ay[i], x = q.x - c.ax[i], y = q.y - c.ay[i];
            const float along = (x * dx + y * dy) / std::max(dx * dx + dy * dy, 1e-30F);
            const float t = std::min(std::max(along, 0.0F), 1.0F);
            any |= static_cast<int>(square(x - t * dx) + square(y - t * dy) <= square(distance));
        }
        if (any != 0) return true;
    }
    return false;
}

}  // namespace lsde
