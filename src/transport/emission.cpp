#include "transport/emission.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lsde {

namespace {

Vec2 discOffset(const Sphere& s, Vec3 position, const Frame& frame) {
    const Vec3 d = position - s.centre;
    return {glm::dot(d, frame.x), glm::dot(d, frame.y)};
}

// How much of the light's emission goes towards a caster, roughly: mean over a few fixed points of the light.
double usefulness(const Light& light, const Sphere& caster) {
    if (const auto* point = std::get_if<PointLight>(&light.shape)) {
        const Cone cone = coneTo(caster, point->position);
        if (!point->isSpot() || cone.everything) return cone.oneMinusCos;
        // Spots that shine past the caster have no use for it.
        const float between = std::acos(std::clamp(glm::dot(cone.axis, point->axis), -1.0F, 1.0F));
        const float reach = std::acos(1 - cone.oneMinusCos) + std::acos(1 - point->oneMinusCosOuter);
        return between < reach ? cone.oneMinusCos : 0;
    }
    if (std::holds_alternative<DirectionalLight>(light.shape) || std::holds_alternative<InfiniteLight>(light.shape))
        return square(caster.radius);
    const auto& area = std::get<AreaLight>(light.shape);
    constexpr int kPoints = 32;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
        const Vec2 u((static_cast<float>(i) + 0.5F) / kPoints, std::fmod(static_cast<float>(i) * 0.61803399F, 1.0F));
        const EmissionPoint e = area.samplePoint(u, i % 2 == 0 ? 0.25F : 0.75F);
        sum += cosineShare(coneTo(caster, e.position), e.normal);
    }
    return sum / kPoints;
}

// Bounds of each solid: what starts outside of all of them starts in the open.
std::vector<Bounds> solidBounds(const Scene& scene) {
    std::vector<Bounds> solids;
    for (size_t i = 0; i < scene.meshes().size(); ++i) {
        if (scene.meshes()[i].medium == kOutside) continue;
        const Mesh& mesh = scene.description().meshes[i];
        solids.push_back(mesh.bounds());
        // An open sheet (water) holds everything below it.
        if (mesh.openEdges > 0) solids.back().lo.y = -kInfinity;
    }
    return solids;
}

DirectionMap wholeEmission(const PointLight& light) {
    return light.isSpot() ? DirectionMap::within(light.axis, light.oneMinusCosOuter) : DirectionMap::everywhere();
}

// From inside its target a part aims at the whole emission.
DirectionMap directionsOf(const Cone& cone, const DirectionMap& all) {
    return cone.everything ? all : DirectionMap::within(cone.axis, cone.oneMinusCos);
}

PrimaryPoint primaryPoint(Vec2 first, Vec2 second) { return {first.x, first.y, second.x, second.y}; }

// How many of its numbers choose where a light's path starts and goes, and so can be learnt.
int dimensionsOf(const Light& light) { return light.isDelta() ? 2 : 4; }

}  // namespace

EmissionSampler::EmissionSampler(const Scene& scene, const std::vector<bool>& selected, AimShares shares)
    : scene_(scene), shares_(shares) {
    if (shares.whole < 1) findTargets();
    const std::vector<Bounds> solids = solidBounds(scene);
    std::vector<double> weights(scene.lights().size());
    double total = 0, count = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        aims_.push_back(selected[i] ? aimOf(scene.lights()[i], solids) : Aim{});
        if (!selected[i]) continue;
        totalPower_ += scene.lights()[i].power();
        fairPower_ += maxComponent(scene.lights()[i].power()) / aims_.back().parts.pmf(0);
        weights[i] = std::sqrt(static_cast<double>(luminance(scene.lights()[i].power())));
        total += weights[i];
        ++count;
    }
    if (!(total > 0)) throw Error(scene.description().file.string() + ": no light is selected that emits anything");
    // By power the weak ones of many lights would starve, evenly the strong ones, whose caustics show most, would be
    // coarse: by the root of the power, and a tenth of the paths evenly.
    for (size_t i = 0; i < weights.size(); ++i)
        if (selected[i]) weights[i] = 0.9 * weights[i] / total + 0.1 / count;
    choice_ = DiscreteDistribution(weights);
}

// A glass in a stadium is lit by what little of the stadium's light falls near it, and that comes back through it: the
// surroundings at all scales between the glass and the scene get as many paths each.
void EmissionSampler::findTargets() {
    constexpr float kFirst = 2, kStep = 4, kLargest = 0.25F;
    for (const Caster& caster : scene_.casters()) targets_.push_back(caster.bounds);
    casters_ = targets_.size();
    if (casters_ == 0 || !(shares_.around > 0)) return;
    const Sphere all = groupCasters(targets_, 1).front().bounds;
    for (float radius = kFirst * all.radius; radius < kLargest * scene_.boundingSphere().radius; radius *= kStep)
        targets_.push_back({all.centre, radius});
}

// The whole emission first, then the casters by their use to the light, with a floor for each that has any, then their
// surroundings evenly.
DiscreteDistribution EmissionSampler::partsOf(const Light& light) const {
    std::vector<double> parts{1};
    double useful = 0, around = 0;
    for (size_t i = 0; i < targets_.size(); ++i) {
        parts.push_back(usefulness(light, targets_[i]));
        if (i < casters_)
            useful += parts.back();
        else if (parts.back() > 0)
            ++around;
    }
    const double aroundShare = around > 0 ? shares_.around : 0;
    const double casterShare = useful > 0 ? 1 - static_cast<double>(shares_.whole) - shares_.around : 0;
    for (size_t i = 1; i < parts.size(); ++i)
        if (parts[i] > 0)
            parts[i] = i <= casters_ ? casterShare * (0.9 * parts[i] / useful + 0.1 / static_cast<double>(casters_))
                                     : aroundShare / around;
    parts[0] = 1 - aroundShare - casterShare;
    return DiscreteDistribution(parts);
}

EmissionSampler::Aim EmissionSampler::aimOf(const Light& light, const std::vector<Bounds>& solids) const {
    Aim out;
    out.parts = partsOf(light);
    out.firstShared = dimensionsOf(light) == 4;
    if (const auto* point = std::get_if<PointLight>(&light.shape)) out.media = scene_.mediaAt(point->position);
    if (const auto* area = std::get_if<AreaLight>(&light.shape))
        out.mayStartInside =
            std::any_of(solids.begin(), solids.end(), [&](const Bounds& s) { return s.overlaps(area->bounds); });
    return out;
}

void EmissionSampler::learn(std::span<const AimTrial> trials) {
    std::vector<std::vector<std::vector<PrimaryDensity::Trial>>> of(aims_.size());  // [light][part]
    for (size_t light = 0; light < aims_.size(); ++light) of[light].resize(aims_[light].parts.size());
    for (const AimTrial& t : trials) of[t.light][t.part].push_back(t.trial);
    for (size_t light = 0; light < aims_.size(); ++light) {
        aims_[light].learnt.assign(of[light].size(), {});
        // The whole emission stays as it is: it bounds the weights of all that was learnt wrongly.
        for (size_t part = 1; part < of[light].size(); ++part)
            aims_[light].learnt[part] =
                PrimaryDensity(std::move(of[light][part]), dimensionsOf(scene_.lights()[light]));
    }
}

EmissionSampler::Draw EmissionSampler::draw(const Aim& aim, size_t part, PrimaryPoint& u) {
    Draw drawn{part, 1};
    if (!aim.learnt.empty()) u = aim.learnt[part].sample(u, drawn.learnt);
    return drawn;
}

template <typename Numbers>
float EmissionSampler::learntDensity(const Aim& aim, size_t part, Draw drawn, Numbers&& numbers) {
    if (part == drawn.part) return drawn.learnt;
    return aim.learnt.empty() || aim.learnt[part].even() ? 1 : aim.learnt[part].pdf(numbers());
}

float EmissionSampler::aimedConePdf(const Aim& aim, Vec3 position, Vec3 direction, const DirectionMap& all,
                                    const PrimaryPoint& u, Draw drawn) const {
    float pdf = 0;
    for (size_t i = 1; i < aim.parts.size(); ++i) {
        if (!(aim.parts.pmf(i) > 0)) continue;
        const Cone cone = coneTo(targets_[i - 1], position);
        if (i != drawn.part && !within(cone, direction)) continue;
        const float learnt = learntDensity(aim, i, drawn, [&] {
            const Vec2 square = directionsOf(cone, all).square(direction);
            return aim.firstShared ? primaryPoint({u[0], u[1]}, square) : primaryPoint(square, Vec2(0));
        });
        pdf += aim.parts.pmf(i) * learnt * (cone.everything ? all.pdf(direction) : conePdf(cone.oneMinusCos));
    }
    return pdf;
}

float EmissionSampler::aimedDiscPdf(const Aim& aim, const Frame& frame, Vec3 position, const PrimaryPoint& u,
                                    Draw drawn) const {
    float pdf = 0;
    for (size_t i = 1; i < aim.parts.size(); ++i) {
        const Sphere& s = targets_[i - 1];
        const Vec2 d = discOffset(s, position, frame);
        if (i != drawn.part && glm::dot(d, d) > square(s.radius)) continue;
        const float learnt = learntDensity(aim, i, drawn, [&] {
            const Vec2 disc = diskToSquare(d / s.radius);
            return aim.firstShared ? primaryPoint({u[0], u[1]}, disc) : primaryPoint(disc, Vec2(0));
        });
        pdf += aim.parts.pmf(i) * learnt / (kPi * square(s.radius));
    }
    return pdf;
}

bool EmissionSampler::sampleArea(const AreaLight& light, const Aim& aim, Sampler& sampler,
                                 LightPathStart& start) const {
    const Vec2 uPosition = sampler.next2D();
    start.u = primaryPoint(uPosition, sampler.next2D());
    const Draw drawn = draw(aim, start.part, start.u);
    sampler.skipTo(5);
    const EmissionPoint e = light.samplePoint({start.u[0], start.u[1]}, sampler.next());
    const DirectionMap all = DirectionMap::lambert(e.normal);
    Cone cone;
    if (start.part > 0) cone = coneTo(targets_[start.part - 1], e.position);
    const Vec3 direction = directionsOf(cone, all).direction({start.u[2], start.u[3]});
    const float whole = all.pdf(direction);
    if (!(whole > 0)) return false;
    const float mixture = aim.parts.pmf(0) * whole + aimedConePdf(aim, e.position, direction, all, start.u, drawn);
    start.ray = {offsetOrigin(e.position, e.normal, direction, e.epsilon), direction, kInfinity};
    start.power = e.radiance * (glm::dot(direction, e.normal) / (e.pdfA * mixture));
    start.aimWeight = whole / mixture;
    return true;
}

bool EmissionSampler::samplePoint(const PointLight& light, const Aim& aim, Sampler& sampler,
                                  LightPathStart& start) const {
    start.u = primaryPoint(sampler.next2D(), Vec2(0));
    const Draw drawn = draw(aim, start.part, start.u);
    const DirectionMap all = wholeEmission(light);
    Cone cone;
    if (start.part > 0) cone = coneTo(targets_[start.part - 1], light.position);
    const Vec3 direction = directionsOf(cone, all).direction({start.u[0], start.u[1]});
    const float falloff = light.falloff(direction);
    if (!(falloff > 0)) return false;
    const float whole = all.pdf(direction);
    const float mixture = aim.parts.pmf(0) * whole + aimedConePdf(aim, light.position, direction, all, start.u, drawn);
    start.ray = {light.position, direction, kInfinity};
    start.power = light.intensity * (falloff / mixture);
    start.aimWeight = whole / mixture;
    return true;
}

float EmissionSampler::startOnDisc(const Sphere& scene, const Frame& frame, const Aim& aim, Draw drawn,
                                   LightPathStart& start) const {
    const size_t first = aim.firstShared ? 2 : 0;
    const Vec2 u = squareToDisk({start.u[first], start.u[first + 1]});
    const Sphere& disc = start.part > 0 ? targets_[start.part - 1] : scene;
    const Vec3 inPlane = disc.centre + disc.radius * (u.x * frame.x + u.y * frame.y);
    // Back to a plane before the whole scene.
    const float back = glm::dot(inPlane - scene.centre, frame.z) + 1.01F * scene.radius;
    start.ray = {inPlane - back * frame.z, frame.z, kInfinity};
    const Densities d = discDensities(scene, frame, inPlane, aim, start.u, drawn);
    start.aimWeight = d.whole / d.mixture;
    return d.whole > 0 ? d.mixture : kInfinity;
}

void EmissionSampler::sampleDirectional(const DirectionalLight& light, const Aim& aim, Sampler& sampler,
                                        LightPathStart& start) const {
    start.u = primaryPoint(sampler.next2D(), Vec2(0));
    const Draw drawn = draw(aim, start.part, start.u);
    start.power = light.irradiance / startOnDisc(light.scene, Frame(light.direction), aim, drawn, start);
}

void EmissionSampler::sampleInfinite(const InfiniteLight& light, const Aim& aim, Sampler& sampler,
                                     LightPathStart& start) const {
    const Vec2 uDirection = sampler.next2D();
    start.u = primaryPoint(uDirection, sampler.next2D());
    const Draw drawn = draw(aim, start.part, start.u);
    float pdfW = 0;
    const Vec3 towards = light.sample({start.u[0], start.u[1]}, pdfW);
    start.power = light.radiance(towards) / (pdfW * startOnDisc(light.scene, Frame(-towards), aim, drawn, start));
}

bool EmissionSampler::sample(Sampler& sampler, LightPathStart& start) const {
    // The choice has dimension 4: the first four, whose strata matter most, are left to position and direction.
    Sampler choice = sampler;
    choice.skipTo(4);
    float u = choice.next();
    start.light = choice_.sample(u);
    start.reserved = reserveWavelength(scene_, sampler);
    const Aim& aim = aims_[start.light];
    start.part = aim.parts.sample(u);
    const Light& light = scene_.lights()[start.light];
    start.media = aim.media;
    bool emits = true;
    if (const auto* area = std::get_if<AreaLight>(&light.shape))
        emits = sampleArea(*area, aim, sampler, start);
    else if (const auto* point = std::get_if<PointLight>(&light.shape))
        emits = samplePoint(*point, aim, sampler, start);
    else if (const auto* infinite = std::get_if<InfiniteLight>(&light.shape))
        sampleInfinite(*infinite, aim, sampler, start);
    else
        sampleDirectional(std::get<DirectionalLight>(light.shape), aim, sampler, start);
    if (!emits || isBlack(start.power)) return false;
    start.power /= choice_.pmf(start.light);
    if (aim.mayStartInside) start.media = scene_.mediaAt(start.ray.origin);
    sampler.skipTo(6);
    return true;
}

int EmissionSampler::aimingDimension() const {
    float withPosition = 0;
    for (size_t i = 0; i < aims_.size(); ++i)
        if (aims_[i].firstShared) withPosition += choice_.pmf(i);
    return withPosition >= 0.5F ? 2 : 0;
}

EmissionSampler::Densities EmissionSampler::directionDensities(size_t index, Vec3 position, Vec3 normal, Vec3 direction,
                                                               Vec2 uPosition) const {
    const auto* point = std::get_if<PointLight>(&scene_.lights()[index].shape);
    const DirectionMap all = point != nullptr ? wholeEmission(*point) : DirectionMap::lambert(normal);
    const Aim& aim = aims_[index];
    Densities d;
    d.whole = all.pdf(direction);
    d.mixture = aim.parts.pmf(0) * d.whole +
                aimedConePdf(aim, position, direction, all, primaryPoint(uPosition, Vec2(0)), {0, 1});
    return d;
}

EmissionSampler::Densities EmissionSampler::discDensities(const Sphere& scene, const Frame& frame, Vec3 position,
                                                          const Aim& aim, const PrimaryPoint& u, Draw drawn) const {
    const Vec2 offset = discOffset(scene, position, frame);
    Densities d;
    d.whole = glm::dot(offset, offset) <= square(scene.radius) ? 1 / (kPi * square(scene.radius)) : 0;
    d.mixture = aim.parts.pmf(0) * d.whole + aimedDiscPdf(aim, frame, position, u, drawn);
    return d;
}

EmissionSampler::Densities EmissionSampler::discDensities(size_t light, Vec3 position, Vec3 direction,
                                                          Vec2 uDirection) const {
    const auto& shape = scene_.lights()[light].shape;
    const auto* directional = std::get_if<DirectionalLight>(&shape);
    const Sphere& scene = directional != nullptr ? directional->scene : std::get<InfiniteLight>(shape).scene;
    const Frame frame(directional != nullptr ? directional->direction : direction);
    return discDensities(scene, frame, position, aims_[light], primaryPoint(uDirection, Vec2(0)), {0, 1});
}

}  // namespace lsde
