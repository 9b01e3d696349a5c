#include "scene/gltf_json.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "base/error.h"

namespace lsde {

namespace {

std::string plural(std::string_view kind) { return fmt::format("{}{}", kind, kind == "mesh" ? "es" : "s"); }

std::string describe(Range r) {
    const bool boundedLo = r.lo > -FLT_MAX, boundedHi = r.hi < FLT_MAX;
    if (boundedLo && boundedHi)
        return fmt::format("a number in {}{:.6g}, {:.6g}{}", r.openLo ? '(' : '[', r.lo, r.hi, r.openHi ? ')' : ']');
    if (boundedLo) return fmt::format("a number {} {:.6g}", r.openLo ? ">" : ">=", r.lo);
    return "a number within a float's range";
}

// The value as a whole number, if it is one that a double holds exactly.
std::optional<int64_t> wholeNumber(const Json& value) {
    constexpr double kExact = 0x1p53;
    if (!value.is_number()) return {};
    const double x = value.get<double>();
    if (std::floor(x) != x || std::fabs(x) > kExact) return {};
    return static_cast<int64_t>(x);
}

}  // namespace

std::string shown(const Json& value) {
    constexpr size_t kLongest = 40;
    // Only a little of a long array is looked at.
    if (value.is_array() && value.size() > kLongest) return fmt::format("an array of {}", value.size());
    if (value.is_object()) return "an object";
    if (value.is_string() && value.get_ref<const std::string&>().size() > kLongest)
        return shown(value.get_ref<const std::string&>().substr(0, kLongest - 3) + "...");
    std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    if (text.size() > 2 * kLongest) text = text.substr(0, 2 * kLongest) + "...";
    return text;
}

JsonObject::JsonObject(const Json& value, std::string where, const std::string& file)
    : value_(&value), where_(std::move(where)), file_(&file) {
    if (!value.is_object()) fail(fmt::format("{}, expected an object", shown(value)));
}

void JsonObject::fail(const std::string& message) const {
    throw Error(fmt::format("{}: {}{}{}", *file_, where_, where_.empty() ? "" : ": ", message));
}

void JsonObject::require(const char* key) const {
    if (!has(key)) fail(fmt::format("{} is missing", key));
}

std::string JsonObject::string(const char* key) const {
    const auto at = value_->find(key);
    if (at == value_->end()) return {};
    if (!at->is_string()) fail(fmt::format("{} {}, expected a string", key, shown(*at)));
    return at->get<std::string>();
}

bool JsonObject::boolean(const char* key, bool fallback) const {
    const auto at = value_->find(key);
    if (at == value_->end()) return fallback;
    if (!at->is_boolean()) fail(fmt::format("{} {}, expected true or false", key, shown(*at)));
    return at->get<bool>();
}

double JsonObject::checkedNumber(const std::string& name, const Json& value, Range range) const {
    if (!value.is_number() || !range.contains(value.get<double>()))
        fail(fmt::format("{} {}, expected {}", name, shown(value), describe(range)));
    return value.get<double>();
}

double JsonObject::number(const char* key, double fallback, Range range) const {
    const auto at = value_->find(key);
    return at == value_->end() ? fallback : checkedNumber(key, *at, range);
}

int64_t JsonObject::integer(const char* key, int64_t fallback, int64_t lo, int64_t hi) const {
    const auto at = value_->find(key);
    if (at == value_->end()) return fallback;
    const std::optional<int64_t> whole = wholeNumber(*at);
    if (!whole || *whole < lo || *whole > hi)
        fail(fmt::format("{} {}, expected a whole number in [{}, {}]", key, shown(*at), lo, hi));
    return *whole;
}

std::vector<double> JsonObject::numbers(const char* key, size_t count, std::vector<double> fallback,
                                        Range range) const {
    const Json* values = array(key);
    if (values == nullptr) return fallback;
    if (values->size() != count) fail(fmt::format("{} has {} numbers, expected {}", key, values->size(), count));
    std::vector<double> out;
    for (size_t i = 0; i < count; ++i) out.push_back(checkedNumber(fmt::format("{}[{}]", key, i), (*values)[i], range));
    return out;
}

size_t JsonObject::checkedReference(const std::string& name, const Json& value, const char* kind, size_t count) const {
    const std::optional<int64_t> index = wholeNumber(value);
    if (!index || *index < 0) fail(fmt::format("{} {}, expected the index of a {}", name, shown(value), kind));
    if (static_cast<uint64_t>(*index) >= count)
        fail(fmt::format("{} {} does not exist ({} {})", kind, *index, count, count == 1 ? kind : plural(kind)));
    return static_cast<size_t>(*index);
}

std::optional<size_t> JsonObject::reference(const char* key, const char* kind, size_t count) const {
    const auto at = value_->find(key);
    if (at == value_->end()) return {};
    return checkedReference(key, *at, kind, count);
}

std::vector<size_t> JsonObject::references(const char* key, const char* kind, size_t count) const {
    std::vector<size_t> out;
    if (const Json* values = array(key))
        for (const Json& value : *values) out.push_back(checkedReference(key, value, kind, count));
    return out;
}

const Json* JsonObject::array(const char* key) const {
    const auto at = value_->find(key);
    if (at == value_->end()) return nullptr;
    if (!at->is_array()) fail(fmt::format("{} {}, expected an array", key, shown(*at)));
    return &*at;
}

size_t JsonObject::size(const char* key) const {
    const Json* values = array(key);
    return values == nullptr ? 0 : values->size();
}

std::optional<JsonObject> JsonObject::object(const char* key) const {
    const auto at = value_->find(key);
    if (at == value_->end()) return {};
    return JsonObject(*at, where_.empty() ? key : where_ + " " + key, *file_);
}

std::optional<JsonObject> JsonObject::extension(const char* name) const {
    const auto extensions = object("extensions");
    if (!extensions || !extensions->has(name)) return {};
    return JsonObject((*value_)["extensions"][name], where_, *file_);
}

std::optional<JsonObject> JsonObject::extras() const {
    const auto at = value_->find("extras");
    if (at == value_->end() || !at->is_object()) return {};
    return JsonObject(*at, where_ + " extras", *file_);
}

std::vector<JsonObject> JsonObject::objects(const char* key, const char* kind, bool byName) const {
    std::vector<JsonObject> out;
    const Json* values = array(key);
    if (values == nullptr) return out;
    out.reserve(values->size());
    for (size_t i = 0; i < values->size(); ++i) {
        JsonObject element((*values)[i], fmt::format("{}{}{} {}", where_, where_.empty() ? "" : " ", kind, i), *file_);
        const std::string name = element.string("name");
        if (byName && !name.empty()) element.where_ = fmt::format("{} {}", kind, shown(name));
        out.push_back(std::move(element));
    }
    return out;
}

}  // namespace lsde
