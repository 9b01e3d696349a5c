#include "photon/irradiance_cache.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <numeric>

#include "base/hash.h"
#include "base/ray.h"

namespace lsde {

namespace {

enum State : uint8_t { kUnknown, kInTheMaking, kKnown };

// Cosine of the angle between normals up to which one place's irradiance says something of the other's.
constexpr float kSameDirection = 0.95F;
constexpr float kSteepest = 0.32F;  // sine of that angle

// A record stands for its run if its disc holds as many photons as this many runs.
constexpr uint32_t kRunsInDisc = 8;

// Runs of a length that have records, the longest first.
struct RunLength {
    uint32_t blocks;
    // Of the rule's largest disc, photons from which on they are made: below, few of their records would stand for
    // their runs, and shorter ones be made as well.
    uint32_t leastOfRule;
    // Of their records' discs: the denser records are, the cheaper they must be.
    uint32_t mostCount;
};
constexpr std::array<RunLength, 5> kRunLengths = {
    {{256, 131072, 262144}, {64, 32768, 65536}, {16, 2048, 16384}, {4, 512, 2496}, {1, 0, 1008}}};
// Records that could never stand for their runs would be made for nothing; single blocks have them all the same.
static_assert(std::all_of(kRunLengths.begin(), kRunLengths.end(), [](const RunLength& length) {
    const uint32_t needed = kRunsInDisc * kBlockSize * length.blocks;
    return length.mostCount >= needed && (length.blocks == 1 || length.leastOfRule >= needed);
}));

// And for a point that is closer than this share of the disc's radius.
constexpr float kNear = 0.4F;
// If none stands for a point, the irradiance of one as close as this share is better than none.
constexpr float kStillNear = 1.5F * kNear;

// Blocks that may tell of each other: those of a run.
constexpr size_t kNeighbours = 4;

// Records of a run: of its middle photon, and of one on the other side, if the surface is a sheet lit from both. Those
// of the other side follow all of the first: memory that is not asked for is not taken.
constexpr size_t kSides = 2;

constexpr uint16_t kNoPhoton = 0xffff;

// Photons that tell where a record's light came from, about.
constexpr uint32_t kTellDirection = 64;

// Of the photons [first, end) that count, the one nearest to the middle of their blocks' boxes. A record there lies
// evenly among the points for which it stands; at one to a side (the middle one of their order is the first beyond the
// tree's cut) all light that rises or falls would be moved that way. And where that middle lies has little to do with
// how many photons are near it, so that records have no bias though each counts a photon that is there for certain.
template <typename Counts>
std::optional<uint32_t> nearestToMiddle(const PhotonTreeView& photons, uint32_t first, uint32_t end,
                                        const Counts& counts) {
    Bounds box;
    for (uint32_t block = first / kBlockSize; block * kBlockSize < end; ++block) box.grow(boxOf(photons, block));
    const Vec3 middle = box.centre();
    std::optional<uint32_t> nearest;
    float least = kInfinity;
    for (uint32_t i = first; i < end; ++i) {
        const float distanceSquared = lengthSquared(photons.position(i) - middle);
        if (!(distanceSquared < least) || !counts(i)) continue;
        least = distanceSquared;
        nearest = i;
    }
    return nearest;
}

// Where a photon came from, over its cosine with the facet that it met: bounded along the surface.
Vec3 overCosine(const PhotonPayload& p) {
    const Vec3 side = landedSide(p);
    const Vec3 direction = unpackDirection(p.direction);
    const float cosine = glm::dot(direction, side);
    const Vec3 along = direction - cosine * side;
    return side + along / std::max(cosine, glm::length(along) / kMaxShadingWeight);
}

// Uniform on the unit disc.
Vec2 hashedDiscPoint(Vec3 p) {
    const uint64_t h = mix64(mix64(std::bit_cast<uint32_t>(p.x) | uint64_t{std::bit_cast<uint32_t>(p.y)} << 32) +
                             std::bit_cast<uint32_t>(p.z));
    const float radius = std::sqrt(static_cast<float>(h >> 40) * 0x1p-24F);
    const float angle = static_cast<float>(h & 0xffffff) * (0x1p-24F * 2 * kPi);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace

IrradianceCache::IrradianceCache(const PhotonSource& source, const IrradianceRule& rule)
    : source_(source), photons_(source.photons()), smoothCount_(rule.smoothCount) {
    for (const RunLength& length : kRunLengths) {
        if (rule.bandwidth.mostCount < length.leastOfRule) continue;
        const size_t runs = (photons_.blocks.size() + length.blocks - 1) / length.blocks;
        Level& level = levels_.emplace_back();
        level.photonsPerRecord = length.blocks * kBlockSize;
        level.rule = rule.bandwidth;
        level.rule.mostCount = std::min(level.rule.mostCount, length.mostCount);
        const size_t slots = kSides * runs;
        level.offsets = {slots, source.place};
        level.clearances = {slots, source.place};
        level.states = {slots, source.place};
        level.bandwidths = {slots, source.place};
        level.irradiance = {slots * (source.groupCount + 1), source.place};
        level.variances = {slots, source.place};
        level.arriving = {slots, source.place};
    }
}

void IrradianceCache::make(Record& record, const BandwidthRule& rule, std::span<Rgb> irradiance,
                           BandwidthScratch& scratch) const {
    record.bandwidth = consistentBandwidth(source_, record.photon, rule, scratch);
    std::fill(irradiance.begin(), irradiance.end(), Rgb(0));
    record.variance = Rgb(0);
    record.arriving = Vec3(0);
    if (record.bandwidth.count < smoothCount_) return;
    const float radius = record.bandwidth.radius, radiusSquared = square(radius);
    Vec3 arriving(0);
    float asked = 0;  // power of the photons that tell the direction
    const auto ask = [&](const PhotonPayload& p, float weight) {
        const float power = maxComponent(unpackPower(p.power)) * weight;
        arriving += power * overCosine(p);
        asked += power;
    };
    const auto sum = [](std::span<const Rgb> powers) { return std::accumulate(powers.begin(), powers.end(), Rgb(0)); };
    const uint32_t each = 1 + record.bandwidth.count / kTellDirection;
    const Vec3 along = record.bandwidth.along, middle = photons_.position(record.photon);
    const bool byBlocks =
        along == Vec3(0) && record.bandwidth.count >= kLeastOfBlocks &&
        acceptByBlocks(source_, record.photon, queryAt(source_, record.photon), radius, scratch,
                       [&](const BlockSums& sums, float distance) { return distance + sums.radius < radius; });
    if (byBlocks) {
        const uint32_t eachBlock = 1 + each / kBlockSize;
        uint32_t number = 0;
        for (const DensityScratch::Candidate& c : scratch.acceptedBlocks) {
            const uint32_t block = c.index / kBlockSize;
            const BlockSums& sums = (*source_.blocks)[block];
            if (!(c.entrySquared() < radiusSquared)) continue;
            if (!scratch.surface.whole() && scratch.surface.hides(sums.centre)) continue;
            const float weight = epanechnikov(c.distanceSquared + sums.spread, radiusSquared);
            const std::span<const Rgb> powers = source_.blocks->powers(block);
            for (size_t g = 0; g < powers.size(); ++g) irradiance[g] += powers[g] * weight;
            irradiance.back() += sum(powers) * weight;
            record.variance += sums.powerSquared * square(weight);
            // One photon for so many; below one for `each`.
            const auto stands = static_cast<float>(kBlockSize * eachBlock) / static_cast<float>(each);
            if (number++ % eachBlock == 0) ask(photons_.payload[c.index], weight * stands);
        }
    }
    uint32_t number = 0;
    for (const DensityScratch::Candidate& c : scratch.density.accepted) {
        const uint16_t group = source_.groups[c.index];
        if (group >= source_.groupCount) continue;
        const float distanceSquared = elongatedSquared(along, photons_.position(c.index) - middle, c.distanceSquared);
        if (!(std::max(distanceSquared, c.planeSquared) < radiusSquared)) continue;
        if (!scratch.surface.whole() && scratch.surface.hides(photons_.position(c.index))) continue;
        const PhotonPayload& p = photons_.payload[c.index];
        const float weight = epanechnikov(distanceSquared, radiusSquared);
        const Rgb e = rgbPower(p) * weight;
        irradiance[group] += e;
        irradiance.back() += e;
        record.variance += e * e;
        if (number++ % each == 0) ask(p, weight);
    }
    if (asked > 0) record.arriving = arriving / asked;
    const auto scale = static_cast<float>(source_.perPath) / (scratch.surface.share(radius) * stretchOf(along));
    for (Rgb& e : irradiance) e *= scale;
    record.variance *= square(scale);
}

void IrradianceCache::recordOf(Level& level, size_t slot, Record& record, std::vector<Rgb>& spare,
                               BandwidthScratch& scratch) {
    const size_t groups = source_.groupCount + 1;  // and their sum
    const std::atomic_ref<uint8_t> state(level.states[slot]);
    const std::span<Rgb> kept(&level.irradiance[slot * groups], groups);
    uint8_t expected = kUnknown;
    const bool known = state.load(std::memory_order_acquire) == kKnown;
    if (!known && state.compare_exchange_strong(expected, kInTheMaking, std::memory_order_acquire)) {
        make(record, level.rule, kept, scratch);
        level.bandwidths[slot] = record.bandwidth;
        level.variances[slot] = record.variance;
        level.arriving[slot] = record.arriving;
        state.store(kKnown, std::memory_order_release);
    } else if (!known && expected == kInTheMaking) {
        // Another thread is at it; waiting would cost as much as making it here.
        spare.resize(groups);
        make(record, level.rule, spare, scratch);
        record.irradiance = spare;
        return;
    }
    record.bandwidth = level.bandwidths[slot];
    record.variance = level.variances[slot];
    record.arriving = level.arriving[slot];
    record.irradiance = kept;
}

float IrradianceCache::distance(const Record& record, Vec3 p) const {
    return record.bandwidth.distance(p - photons_.position(record.photon));
}

float IrradianceCache::clearanceOf(Level& level, const Place& place) const {
    const std::atomic_ref<float> kept(level.clearances[place.slot]);
    float clearance = kept.load(std::memory_order_relaxed);
    if (clearance == 0) {  // not known yet
        clearance = source_.extent.clearance(photons_.position(place.photon));
        kept.store(clearance, std::memory_order_relaxed);
    }
    return clearance;
}

bool IrradianceCache::sameSurface(const DensityQuery& query, Level& level, const Place& place) const {
    const DensityQuery there = queryAt(source_, place.photon);
    if (there.medium != query.medium || glm::dot(there.sideNormal, query.sideNormal) < kSameDirection) return false;
    const Vec3 away = there.point.position - query.point.position;
    const float distance = glm::length(away), height = std::fabs(glm::dot(away, query.point.ng));
    if (height > kPlaneThickness * source_.maxRadius) return false;
    // A surface that turns by no more than that rises no more steeply; what does is another, before or behind it.
    if (height > kSteepest * distance + surfaceEpsilon(query.point.position, 0)) return false;
    // What lies between them is at most that far from the photon. Records know how far the nearest crease is, so that
    // few are looked for.
    const float beside = 1.01F * (distance + kPlaneThickness * source_.maxRadius);
    if (beside < clearanceOf(level, place)) return true;
    return !source_.extent.separates(query.point.position, query.point.ng, there.point.position, source_.maxRadius);
}

std::optional<IrradianceCache::Place> IrradianceCache::placeOf(Level& level, size_t run, Vec3 sideNormal) const {
    const auto first = static_cast<uint32_t>(run * level.photonsPerRecord);
    const auto end = static_cast<uint32_t>(std::min<uint64_t>(first + level.photonsPerRecord, photons_.count));
    const auto offsetOf = [&](size_t slot, const auto& counts) {
        const std::atomic_ref<uint16_t> kept(level.offsets[slot]);
        uint16_t coded = kept.load(std::memory_order_relaxed);
        if (coded == 0) {  // not known yet
            const std::optional<uint32_t> photon = nearestToMiddle(photons_, first, end, counts);
            coded = photon ? static_cast<uint16_t>(*photon - first + 1) : kNoPhoton;
            kept.store(coded, std::memory_order_relaxed);
        }
        return coded;
    };
    const uint32_t photon = first + offsetOf(run, [](uint32_t) { return true; }) - 1;
    const Vec3 side = landedSide(photons_.payload[photon]);
    if (!(glm::dot(side, sideNormal) < -kSameDirection)) return Place{photon, run};
    const size_t slot = run + level.offsets.size() / kSides;
    const uint16_t other =
        offsetOf(slot, [&](uint32_t i) { return glm::dot(landedSide(photons_.payload[i]), side) < -kSameDirection; });
    if (other == kNoPhoton) return std::nullopt;
    return Place{first + other - 1, slot};
}

// Whether the run's record stands for the query's point. If not, it is the record all the same if it is of the query's
// surface.
bool IrradianceCache::answers(Level& level, size_t run, const DensityQuery& query, Record& record,
                              std::vector<Rgb>& spare, BandwidthScratch& scratch) {
    if (run * level.photonsPerRecord >= photons_.count) return false;
    const std::optional<Place> place = placeOf(level, run, query.sideNormal);
    if (!place || !sameSurface(query, level, *place)) return false;
    record.photon = place->photon;
    record.photonsPerRecord = level.photonsPerRecord;
    recordOf(level, place->slot, record, spare, scratch);
    return record.bandwidth.count >= kRunsInDisc * level.photonsPerRecord &&
           distance(record, query.point.position) < kNear * record.bandwidth.radius;
}

bool IrradianceCache::nearest(const DensityQuery& query, Vec3 p, Record& record, BandwidthScratch& scratch) {
    const size_t block = nearestBlock(photons_, p);
    for (Level& level : levels_)
        if (answers(level, block * kBlockSize / level.photonsPerRecord, query, record, scratch.irradiance, scratch))
            return true;
    // Not all that ends a bandwidth is an edge: where it is chance, a neighbour tells.
    if (record.bandwidth.count >= kRunsInDisc * kBlockSize) return true;
    Record other;
    for (size_t i = 1; i < kNeighbours; ++i)
        if (answers(levels_.back(), block ^ i, query, other, scratch.neighbour, scratch)) {
            record = other;
            return true;
        }
    return record.photonsPerRecord > 0;
}

bool IrradianceCache::tells(const Record& record, Vec3 p) const {
    return record.bandwidth.count >= smoothCount_ && distance(record, p) < kStillNear * record.bandwidth.radius;
}

CachedLight IrradianceCache::at(const DensityQuery& query, bool wantIrradiance, BandwidthScratch& scratch) {
    CachedLight light;
    if (photons_.count == 0) return light;
    const Vec3 p = query.point.position;
    Record record;
    if (!nearest(query, p, record, scratch)) return light;
    const Bandwidth& there = record.bandwidth;
    light.bandwidth.along = there.along;
    light.bandwidth.radius = std::max(0.0F, there.radius - distance(record, p));
    light.bandwidth.count =
        static_cast<uint32_t>(static_cast<float>(there.count) * square(light.bandwidth.radius / there.radius));
    if (!wantIrradiance || light.bandwidth.count < smoothCount_ || light.bandwidth.radius < query.minRadius)
        return light;
    const bool tellsHere = tells(record, p);
    // The next search may be answered by the same spare memory.
    std::vector<Rgb>& mean = scratch.mean;
    mean.assign(record.irradiance.begin(), record.irradiance.end());
    const float spacing = std::sqrt(kInvPi * there.area() * static_cast<float>(record.photonsPerRecord) /
                                    static_cast<float>(there.count + 1));
    const Vec2 offset = std::min(spacing, 0.5F * there.radius) * hashedDiscPoint(p);
    const Frame frame(query.point.ng);
    Record moved;
    const bool tellsMoved =
        nearest(query, p + offset.x * frame.x + offset.y * frame.y, moved, scratch) && tells(moved, p);
    if (!tellsHere && !tellsMoved) return light;
    light.over = there;
    if (tellsMoved) {
        if (!tellsHere || moved.bandwidth.length() > there.length()) light.over = moved.bandwidth;
        const float share = tellsHere ? 0.5F : 0;
        for (size_t g = 0; g < mean.size(); ++g) mean[g] = glm::mix(moved.irradiance[g], mean[g], share);
        record.variance = glm::mix(moved.variance, record.variance, share);
        record.arriving = glm::mix(moved.arriving, record.arriving, share);
    }
    light.irradiance = mean;
    light.variance = record.variance;
    if (query.point.ns != query.point.ng) {
        const Vec3 ns = glm::dot(query.point.ns, query.sideNormal) > 0 ? query.point.ns : -query.point.ns;
        light.shading = std::clamp(glm::dot(ns, record.arriving), 0.0F, kMaxShadingWeight);
    }
    return light;
}

}  // namespace lsde
