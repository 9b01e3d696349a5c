#include "photon/map_header.h"

#include <fmt/format.h>

#include <limits>

#include "base/error.h"
#include "base/json.h"

namespace lsde {

namespace {

using Json = nlohmann::json;

// For readers without this program.
constexpr const char* kRecord =
    "CLASS.blocks: 16 photons, f32 x[16] y[16] z[16], absent 1e30; CLASS.payload: u64 events, 2 bits each from the "
    "lowest (0 D, 1 G, 2 S), their number in bits 58-62, bit 63: there were more; u32 power, mantissas R G B of 8 bits "
    "from the lowest in units of 2^(e - 136) W, e in the upper 8 bits; u32 direction to the light, octahedral 16 + 16; "
    "u16 normal, octahedral 8 + 8; u16 light; u16 medium; u16 flags in the lowest 4 bits (1: delta light, 2: counts at "
    "glossy surfaces, 4: landed on the normal's side) and wavelength in the others (0: not dispersed; else one of 4095 "
    "in ascending order, equally likely under a density that goes by the sum of the channels' |sensitivity| to D65; "
    "the "
    "power is to be multiplied by the channels' sensitivity over that density)";

// ------------------------------------------------------------------------------------------------------------- writing

Json toJson(const FixedRgb& sum) { return sum.toHex(); }

Json toJson(const std::vector<FixedRgb>& sums) {
    Json out = Json::array();
    for (const FixedRgb& sum : sums) out.push_back(toJson(sum));
    return out;
}

Json toJson(const Ledger& ledger) {
    Json columns = Json::object();
    for (size_t i = 0; i < ledger.columns.size(); ++i)
        columns[std::string(name(static_cast<LedgerColumn>(i)))] = toJson(ledger.columns[i]);
    return {{"columns", columns},
            {"flux", toJson(ledger.flux)},
            {"emittedByLight", toJson(ledger.emittedByLight)},
            {"pathsByLight", ledger.pathsByLight},
            {"landed", ledger.landed},
            {"shadingClamped", ledger.shadingClamped},
            {"unclassified", ledger.unclassified},
            {"maxAimWeight", ledger.maxAimWeight}};
}

Json toJson(const std::array<Dispersion, kPhotonClasses>& dispersion) {
    Json out = Json::object();
    for (size_t c = 0; c < kPhotonClasses; ++c)
        out[std::string(name(static_cast<PhotonClass>(c)))] = dispersion[c].at4TimesPowersOf2;
    return out;
}

Json toJson(const StoredClass& c) {
    Json out = {{"count", c.count}};
    if (c.count > 0)
        out["bounds"] = {{c.bounds.lo.x, c.bounds.lo.y, c.bounds.lo.z}, {c.bounds.hi.x, c.bounds.hi.y, c.bounds.hi.z}};
    return out;
}

// ------------------------------------------------------------------------------------------------------------- reading

[[noreturn]] void fail(const std::string& field, const Json& value, std::string_view expected) {
    throw Error(fmt::format("\"{}\": {:.60}, expected {}", field,
                            value.dump(-1, ' ', true, Json::error_handler_t::replace), expected));
}

const Json& at(const Json& object, const std::string& field) {
    if (!object.is_object()) fail(field, object, "an object around it");
    const auto it = object.find(field);
    if (it == object.end()) throw Error(fmt::format("\"{}\": missing", field));
    return *it;
}

const Json& array(const Json& object, const std::string& field, size_t size = std::numeric_limits<size_t>::max()) {
    const Json& value = at(object, field);
    if (!value.is_array()) fail(field, value, "an array");
    if (size != std::numeric_limits<size_t>::max() && value.size() != size)
        throw Error(fmt::format("\"{}\": {} elements, expected {}", field, value.size(), size));
    return value;
}

uint64_t unsignedOf(const Json& value, const std::string& field) {
    if (!value.is_number_unsigned()) fail(field, value, "a whole number >= 0");
    return value.get<uint64_t>();
}

std::string stringOf(const Json& value, const std::string& field) {
    if (!value.is_string()) fail(field, value, "a string");
    return value.get<std::string>();
}

double numberOf(const Json& value, const std::string& field) {
    if (!value.is_number()) fail(field, value, "a number");
    return value.get<double>();
}

FixedRgb fixedRgbOf(const Json& value, const std::string& field) {
    if (!value.is_array() || value.size() != 3) fail(field, value, "three fixed-point numbers");
    return FixedRgb::fromHex({stringOf(value[0], field), stringOf(value[1], field), stringOf(value[2], field)});
}

std::vector<FixedRgb> fixedRgbsOf(const Json& object, const std::string& field, size_t size) {
    std::vector<FixedRgb> out;
    for (const Json& value : array(object, field, size)) out.push_back(fixedRgbOf(value, field));
    return out;
}

std::vector<std::string> stringsOf(const Json& object, const std::string& field) {
    std::vector<std::string> out;
    for (const Json& value : array(object, field)) out.push_back(stringOf(value, field));
    return out;
}

std::vector<IndexRange> rangesOf(const Json& json, uint64_t totalPaths) {
    std::vector<IndexRange> out;
    for (const Json& value : array(json, "ranges")) {
        if (!value.is_array() || value.size() != 2) fail("ranges", value, "[begin, end]");
        const IndexRange range = {unsignedOf(value[0], "ranges"), unsignedOf(value[1], "ranges")};
        const bool apart = out.empty() || range.begin > out.back().end;  // else they would be one
        if (!apart || range.begin >= range.end || range.end > totalPaths)
            fail("ranges", value, fmt::format("separate ranges of {} paths, in order", totalPaths));
        out.push_back(range);
    }
    return out;
}

Ledger ledgerOf(const Json& json, size_t lights, size_t objects) {
    Ledger ledger(lights, objects);
    const Json& columns = at(json, "columns");
    for (size_t i = 0; i < ledger.columns.size(); ++i) {
        const std::string column(name(static_cast<LedgerColumn>(i)));
        ledger.columns[i] = fixedRgbOf(at(columns, column), column);
    }
    ledger.flux = fixedRgbsOf(json, "flux", ledger.flux.size());
    ledger.emittedByLight = fixedRgbsOf(json, "emittedByLight", lights);
    const Json& paths = array(json, "pathsByLight", lights);
    for (size_t i = 0; i < lights; ++i) ledger.pathsByLight[i] = unsignedOf(paths[i], "pathsByLight");
    const Json& landed = array(json, "landed", ledger.landed.size());
    for (size_t i = 0; i < ledger.landed.size(); ++i) ledger.landed[i] = unsignedOf(landed[i], "landed");
    ledger.shadingClamped = unsignedOf(at(json, "shadingClamped"), "shadingClamped");
    ledger.unclassified = unsignedOf(at(json, "unclassified"), "unclassified");
    ledger.maxAimWeight = numberOf(at(json, "maxAimWeight"), "maxAimWeight");
    return ledger;
}

std::array<Dispersion, kPhotonClasses> dispersionOf(const Json& json) {
    std::array<Dispersion, kPhotonClasses> out;
    for (size_t c = 0; c < kPhotonClasses; ++c) {
        const Json& values = array(json, std::string(name(static_cast<PhotonClass>(c))), Dispersion::kCounts);
        for (size_t i = 0; i < Dispersion::kCounts; ++i) {
            const double value = numberOf(values[i], "dispersion");
            if (!(value >= 0 && value <= 1)) fail("dispersion", values[i], "0 to 1");
            out[c].at4TimesPowersOf2[i] = static_cast<float>(value);
        }
    }
    return out;
}

Vec3 vec3Of(const Json& value) {
    if (!value.is_array() || value.size() != 3) fail("bounds", value, "[x, y, z]");
    Vec3 v;
    for (int i = 0; i < 3; ++i) {
        const double coordinate = numberOf(value[static_cast<size_t>(i)], "bounds");
        if (!(std::fabs(coordinate) <= kMaxPhotonCoordinate)) fail("bounds", value, "coordinates in range");
        v[i] = static_cast<float>(coordinate);
    }
    return v;
}

StoredClass storedClassOf(const Json& json) {
    StoredClass c;
    c.stored = true;
    c.count = unsignedOf(at(json, "count"), "count");
    if (c.count > 0) {
        const Json& bounds = array(json, "bounds", 2);
        c.bounds = {vec3Of(bounds[0]), vec3Of(bounds[1])};
    }
    return c;
}

}  // namespace

std::string toJson(const MapDescription& map) {
    const MapHeader& h = map.header;
    Json ranges = Json::array();
    for (const IndexRange& r : h.ranges) ranges.push_back({r.begin, r.end});
    Json classes = Json::object();
    for (size_t c = 0; c < kPhotonClasses; ++c)
        if (map.classes[c].stored) classes[std::string(name(static_cast<PhotonClass>(c)))] = toJson(map.classes[c]);
    const Json json = {{"sceneHash", h.sceneHash}, {"units", h.units},
                       {"seed", h.seed},           {"totalPaths", h.totalPaths},
                       {"maxDepth", h.maxDepth},   {"store", h.store},
                       {"aimed", h.aimed},         {"lights", h.lights},
                       {"objects", h.objects},     {"dispersion", toJson(h.dispersion)},
                       {"ranges", ranges},         {"ledger", toJson(h.ledger)},
                       {"classes", classes},       {"record", kRecord}};
    return json.dump(1);
}

MapDescription fromJson(std::string_view text) {
    const Json json = Json::parse(text.begin(), text.end(), nullptr, false);
    if (json.is_discarded()) throw Error("is not JSON");
    MapDescription map;
    MapHeader& h = map.header;
    h.sceneHash = stringOf(at(json, "sceneHash"), "sceneHash");
    h.units = stringOf(at(json, "units"), "units");
    if (const std::string expected = MapHeader().units; h.units != expected) fail("units", h.units, expected);
    h.seed = unsignedOf(at(json, "seed"), "seed");
    h.totalPaths = unsignedOf(at(json, "totalPaths"), "totalPaths");
    const uint64_t maxDepth = unsignedOf(at(json, "maxDepth"), "maxDepth");
    if (maxDepth > std::numeric_limits<uint32_t>::max()) fail("maxDepth", maxDepth, "less than 2^32");
    h.maxDepth = static_cast<uint32_t>(maxDepth);
    h.store = stringOf(at(json, "store"), "store");
    if (h.store != "caustic" && h.store != "indirect" && h.store != "all")
        fail("store", h.store, "\"caustic\", \"indirect\" or \"all\"");
    if (!at(json, "aimed").is_boolean()) fail("aimed", at(json, "aimed"), "true or false");
    h.aimed = at(json, "aimed").get<bool>();
    h.lights = stringsOf(json, "lights");
    h.objects = stringsOf(json, "objects");
    h.dispersion = dispersionOf(at(json, "dispersion"));
    h.ranges = rangesOf(json, h.totalPaths);
    h.ledger = ledgerOf(at(json, "ledger"), h.lights.size(), h.objects.size());
    const Json& classes = at(json, "classes");
    if (!classes.is_object()) fail("classes", classes, "an object");
    for (size_t c = 0; c < kPhotonClasses; ++c) {
        const std::string className(name(static_cast<PhotonClass>(c)));
        if (classes.contains(className)) map.classes[c] = storedClassOf(classes[className]);
    }
    if (at(json, "record") != kRecord) fail("record", at(json, "record"), "this version's");
    return map;
}

}  // namespace lsde
