#include "passes/layers.h"

#include <fmt/format.h>

#include "base/error.h"

namespace lsde {

namespace {

// A partition of all paths: lit straight (or a source seen), through S at the source and seen directly or through S,
// and whatever met two diffuse events.
const LayerRequest kBuiltIn[] = {
    {"direct", "L(S*|DS*)E"},
    {"caustic", "LS+DS*E"},
    {"indirect", "LS*DS*D[DS]*E"},
};

const char* kReserved[] = {"albedo", "normal", "depth", "unclassified"};

// States that follow those of the mask by one of the events.
uint64_t statesAfter(const PathExpr& e, uint64_t states, std::initializer_list<Event> events) {
    uint64_t after = 0;
    for (int s = 0; s < e.states(); ++s) {
        if (((states >> s) & 1) == 0) continue;
        for (const Event event : events) after |= uint64_t{1} << e.next(static_cast<uint8_t>(s), event);
    }
    return after;
}

// States that are among those of the mask or follow them by any number of the events.
uint64_t statesFrom(const PathExpr& e, uint64_t states, std::initializer_list<Event> events) {
    uint64_t reached = 0;
    for (uint64_t frontier = states; frontier != 0; frontier = statesAfter(e, frontier, events) & ~reached)
        reached |= frontier;
    return reached;
}

constexpr uint64_t kStart = 1;
constexpr std::initializer_list<Event> kBends = {Event::Specular, Event::Glossy};
constexpr std::initializer_list<Event> kScatters = {Event::Diffuse, Event::Glossy};
constexpr std::initializer_list<Event> kAnyEvent = {Event::Diffuse, Event::Specular, Event::Glossy};

}  // namespace

LayerRequest parseLayerRequest(const std::string& text, int number) {
    const size_t at = text.rfind('=');
    LayerRequest r{fmt::format("path{}", number), text.substr(0, at)};
    if (at != std::string::npos) r.name = text.substr(at + 1);
    if (r.name.empty() || r.name.find_first_not_of(
                              "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-") != std::string::npos)
        throw UsageError(
            fmt::format("--paths {}: layer name \"{}\": expected one or more of A-Z a-z 0-9 _ -", text, r.name));
    for (const char* reserved : kReserved)
        if (r.name == reserved)
            throw UsageError(
                fmt::format("--paths {}: the name \"{}\" is that of a built-in layer that is not light", text, r.name));
    return r;
}

RenderLayers::RenderLayers(const std::vector<LayerRequest>& requests, const std::optional<std::string>& only) {
    std::vector<PathLayer> layers;
    for (const LayerRequest& builtIn : kBuiltIn) {
        const bool replaced = std::any_of(requests.begin(), requests.end(),
                                          [&](const LayerRequest& r) { return r.name == builtIn.name; });
        if (!replaced) layers.push_back({builtIn.name, PathExpr(builtIn.expression)});
    }
    for (const LayerRequest& r : requests) layers.push_back({r.name, PathExpr(r.expression)});
    if (only) {
        only_ = static_cast<int>(layers.size());
        layers.push_back({kOnlyLayer, PathExpr(*only)});
        const PathExpr& e = layers.back().expression;
        causticStates_ = statesFrom(e, statesAfter(e, kStart, kBends), kBends);
        indirectStates_ = statesFrom(e, statesAfter(e, statesFrom(e, kStart, kAnyEvent), kScatters), kAnyEvent);
    }
    filter_ = PathFilter(std::move(layers));
}

bool RenderLayers::wants(uint64_t photonStates) const {
    if (only_ < 0) return true;
    const uint64_t landed = statesAfter(only(), photonStates, kScatters);
    for (int s = 0; s < only().states(); ++s)
        if (((landed >> s) & 1) != 0 && only().alive(static_cast<uint8_t>(s))) return true;
    return false;
}

std::vector<std::string> RenderLayers::filmLayers() const {
    std::vector<std::string> names{""};
    for (const PathLayer& layer : filter_.layers()) names.push_back(layer.name);
    names.insert(names.end(), {"albedo", "normal", "depth", "unclassified"});
    return names;
}

void SampleSums::addFull(Rgb value) {
    if (isFinite(value))
        layer[0] += value;
    else
        ++notFinite;
}

void SampleSums::contribute(const RenderLayers& layers, Rgb value, const LightPathState& light,
                            const EyePathState& eye) {
    if (!layers.hasOnly()) addFull(value);
    contributeToLayers(layers, value, light, eye);
}

void SampleSums::contributeToLayers(const RenderLayers& layers, Rgb value, const LightPathState& light,
                                    const EyePathState& eye) {
    if (!isFinite(value)) {
        notFinite += layers.hasOnly() ? 1 : 0;  // else it has been counted
        return;
    }
    uint32_t accepted = layers.filter().accepted(light, eye);
    if (!layers.counts(accepted)) return;
    if (layers.hasOnly()) layer[0] += value;
    for (size_t i = 1; accepted != 0; ++i, accepted >>= 1)
        if ((accepted & 1) != 0) layer[i] += value;
}

void SampleSums::addTo(Film& film, int x, int y) {
    for (int i = 0; i < film.layers(); ++i) {
        Rgb& value = layer[static_cast<size_t>(i)];
        if (isBlack(value)) continue;
        film.add(x, y, i, value);
        value = Rgb(0);
    }
}

}  // namespace lsde
