#include "transport/light_sampler.h"

#include <algorithm>

#include "base/error.h"
#include "transport/cone.h"

namespace lsde {

namespace {

constexpr size_t kMostEmitters = 8;
// Of a hemisphere, by the cosine: where emitters may take this share, each walk looks for them.
constexpr float kNearEmitters = 0.125F;
// Of the choice of a group: by power alone.
constexpr float kByPower = 0.1F;

Sphere boundsOf(const Light& light) {
    if (const auto* area = std::get_if<AreaLight>(&light.shape)) return {area->bounds.centre(), area->bounds.radius()};
    if (const auto* point = std::get_if<PointLight>(&light.shape)) return {point->position, 0};
    return {};
}

float intensityOf(const Light& light) {
    if (const auto* area = std::get_if<AreaLight>(&light.shape))
        return luminance(area->power) / (area->twoSided ? 2 * kPi : kPi);
    if (const auto* point = std::get_if<PointLight>(&light.shape)) return luminance(point->intensity);
    if (const auto* infinite = std::get_if<InfiniteLight>(&light.shape)) return luminance(infinite->integral());
    return luminance(std::get<DirectionalLight>(light.shape).irradiance);
}

// The normal of a flat emitter that shines to one side; else 0.
Vec3 axisOf(const Light& light) {
    const auto* area = std::get_if<AreaLight>(&light.shape);
    if (area == nullptr || area->twoSided) return Vec3(0);
    Vec3 axis(0);
    for (const Triangle& t : area->mesh->triangles) {
        const Vec3 a = area->mesh->positions[t[0]];
        const Vec3 normal =
            glm::normalize(glm::cross(area->mesh->positions[t[1]] - a, area->mesh->positions[t[2]] - a));
        if (axis == Vec3(0)) axis = normal;
        if (!(glm::dot(axis, normal) > 0.999F)) return Vec3(0);
    }
    return axis;
}

// Where light at no place comes from, for the cosine at a surface; 0: all around, or from several sides.
Vec3 comesFrom(const Light& light) {
    if (const auto* directional = std::get_if<DirectionalLight>(&light.shape)) return -directional->direction;
    const auto* sun = std::get_if<SunDisc>(&std::get<InfiniteLight>(light.shape).source);
    return sun != nullptr ? sun->direction : Vec3(0);
}

// Halves the parts across their longest side until there are `limit` of them, or each is one light.
std::vector<std::vector<size_t>> partsByPlace(const Scene& scene, std::vector<size_t> lights, size_t limit) {
    std::vector<std::vector<size_t>> parts;
    if (!lights.empty()) parts.push_back(std::move(lights));
    const auto largest = [&] {
        return std::max_element(parts.begin(), parts.end(),
                                [](const auto& a, const auto& b) { return a.size() < b.size(); });
    };
    while (!parts.empty() && parts.size() < limit && largest()->size() > 1) {
        std::vector<size_t>& part = *largest();
        Bounds centres;
        for (const size_t i : part) centres.grow(boundsOf(scene.lights()[i]).centre);
        const Vec3 extent = centres.extent();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        std::sort(part.begin(), part.end(), [&](size_t a, size_t b) {
            const float x = boundsOf(scene.lights()[a]).centre[axis], y = boundsOf(scene.lights()[b]).centre[axis];
            return x != y ? x < y : a < b;
        });
        const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
        std::vector<size_t> upper(middle, part.end());
        part.erase(middle, part.end());
        parts.push_back(std::move(upper));
    }
    return parts;
}

}  // namespace

LightSampler::LightSampler(const Scene& scene, const std::vector<bool>& selected)
    : groupOf_(scene.lights().size(), kNone), memberOf_(scene.lights().size(), 0) {
    std::vector<double> weights(scene.lights().size());
    std::vector<size_t> placed, directional, infinite;
    std::vector<Sphere> emitters;
    double total = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        if (!selected[i]) continue;
        const Light& light = scene.lights()[i];
        weights[i] = luminance(light.power());
        total += weights[i];
        (std::holds_alternative<DirectionalLight>(light.shape) ? directional
         : std::holds_alternative<InfiniteLight>(light.shape)  ? infinite
                                                               : placed)
            .push_back(i);
        if (std::holds_alternative<AreaLight>(light.shape)) emitters.push_back(boundsOf(light));
    }
    const auto count = static_cast<double>(placed.size() + directional.size() + infinite.size());
    if (count == 0) throw Error(scene.description().file.string() + ": no light is selected");
    // A fifth of the choice by power is even.
    for (double& w : weights) w = 0.2 / count + (total > 0 ? 0.8 * w / total : 0.8 / count);
    onePoint_ = count == 1 && emitters.empty() && infinite.empty();
    const size_t mostPlaced = LightChoice::kMostGroups - 1 - infinite.size();
    for (std::vector<size_t>& part : partsByPlace(scene, std::move(placed), mostPlaced))
        addGroup(scene, std::move(part), weights);
    if (!directional.empty()) addGroup(scene, std::move(directional), weights);
    for (const size_t i : infinite) {
        addGroup(scene, {i}, weights);
        surrounded_ |= std::get<InfiniteLight>(scene.lights()[i].shape).surrounds();
    }
    if (!emitters.empty()) emitters_ = groupCasters(std::move(emitters), kMostEmitters);
}

void LightSampler::addGroup(const Scene& scene, std::vector<size_t> members, const std::vector<double>& weights) {
    Group group;
    std::vector<double> own;
    std::vector<Sphere> spheres;
    for (const size_t i : members) {
        const Light& light = scene.lights()[i];
        groupOf_[i] = static_cast<uint32_t>(groups_.size());
        memberOf_[i] = static_cast<uint32_t>(own.size());
        own.push_back(weights[i]);
        spheres.push_back(boundsOf(light));
        group.intensity += intensityOf(light);
        group.everywhere =
            std::holds_alternative<DirectionalLight>(light.shape) || std::holds_alternative<InfiniteLight>(light.shape);
    }
    group.choice = DiscreteDistribution(own);
    group.byPower = static_cast<float>(group.choice.total());
    group.bounds = groupCasters(std::move(spheres), 1).front().bounds;
    if (members.size() == 1) {
        group.light = &scene.lights()[members.front()];
        group.axis = group.everywhere ? comesFrom(*group.light) : axisOf(*group.light);
    }
    group.members = std::move(members);
    groups_.push_back(std::move(group));
}

// What the group may send to the place: W/m2 of luminance, or more.
float LightSampler::arriving(const Group& group, const LitPlace& place) {
    if (group.everywhere)
        return group.axis == Vec3(0) ? group.intensity
                                     : group.intensity * std::max(0.0F, glm::dot(group.axis, place.normal));
    const Vec3 d = group.bounds.centre - place.position;
    const float nearest2 = square(group.bounds.radius), d2 = std::max(lengthSquared(d), 1e-30F);
    if (d2 <= nearest2) return group.intensity / nearest2;
    const float inverse = 1 / std::sqrt(d2), sine = group.bounds.radius * inverse;
    float value = group.intensity / d2 * std::clamp(glm::dot(d, place.normal) * inverse + sine, 0.0F, 1.0F);
    if (group.axis != Vec3(0)) value *= std::clamp(sine - glm::dot(d, group.axis) * inverse, 0.0F, 1.0F);
    if (group.light != nullptr)
        if (const auto* point = std::get_if<PointLight>(&group.light->shape)) value *= point->falloff(-d * inverse);
    return value;
}

LightChoice LightSampler::at(const LitPlace& place) const {
    LightChoice choice(*this);
    const size_t count = groups_.size();
    if (count == 1) {
        choice.below_[0] = 1;
        return choice;
    }
    float sum = 0;
    for (size_t g = 0; g < count; ++g) sum += choice.below_[g] = arriving(groups_[g], place);
    const bool any = sum > 0 && std::isfinite(sum);
    const float scale = any ? (1 - kByPower) / sum : 0, byPower = any ? kByPower : 1;
    float below = 0;
    for (size_t g = 0; g < count; ++g) {
        below += (any ? choice.below_[g] * scale : 0) + byPower * groups_[g].byPower;
        choice.below_[g] = below;
    }
    choice.below_[count - 1] = 1;
    return choice;
}

float LightSampler::bsdfSamples(const LitPlace& place) const {
    if (surrounded_) return 1;
    float share = 0;
    for (const Caster& e : emitters_) share += cosineShare(coneTo(e.bounds, place.position), place.normal);
    return std::min(1.0F, share / kNearEmitters);
}

size_t LightChoice::choose(float& u) const {
    const auto& groups = lights_.groups_;
    if (groups.size() == 1) return groups[0].members[groups[0].choice.sample(u)];
    size_t g = 0;
    while (g + 1 < groups.size() && u >= below_[g]) ++g;
    const float before = g > 0 ? below_[g - 1] : 0;
    u = std::clamp((u - before) / (below_[g] - before), 0.0F, kOneMinusEpsilon);
    return groups[g].members[groups[g].choice.sample(u)];
}

float LightChoice::probability(size_t light) const {
    const uint32_t g = lights_.groupOf_[light];
    if (g == LightSampler::kNone) return 0;
    const float group = below_[g] - (g > 0 ? below_[g - 1] : 0);
    return group * lights_.groups_[g].choice.pmf(lights_.memberOf_[light]);
}

}  // namespace lsde
