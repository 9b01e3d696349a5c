// Objects of a glTF file's JSON, read with checks of type and range. Every Error names file, object, value and what was
// expected, so that the code that reads a property need not.
#pragma once

#include <cfloat>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"

namespace lsde {

using Json = nlohmann::json;

// Numbers that a property may have. The default keeps them within a float.
struct Range {
    double lo = -FLT_MAX, hi = FLT_MAX;
    bool openLo = false, openHi = false;  // the bound itself is not allowed

    bool contains(double x) const { return (openLo ? x > lo : x >= lo) && (openHi ? x < hi : x <= hi); }
};
inline constexpr Range kAnyNumber{};
inline constexpr Range kUnitInterval{0, 1};
inline constexpr Range kNotNegative{0, FLT_MAX};
inline constexpr Range kPositive{0, FLT_MAX, true};

// A value as an error line shows it: JSON in ASCII, cut after some 40 characters.
std::string shown(const Json& value);

class JsonObject {
  public:
    // `where` is how errors call the object ("mesh 2"); empty for the file's root. Throws Error if it is no object.
    // Both the value and the file's name must outlive this.
    JsonObject(const Json& value, std::string where, const std::string& file);

    const Json& json() const { return *value_; }
    const std::string& where() const { return where_; }
    const std::string& file() const { return *file_; }
    // Throws Error "FILE: WHERE: MESSAGE".
    [[noreturn]] void fail(const std::string& message) const;

    bool has(const char* key) const { return value_->contains(key); }
    // Throws Error if the property is missing.
    void require(const char* key) const;

    std::string string(const char* key) const;  // empty if absent
    bool boolean(const char* key, bool fallback) const;
    double number(const char* key, double fallback, Range range = kAnyNumber) const;
    // Whole numbers; 3.0 counts as one.
    int64_t integer(const char* key, int64_t fallback, int64_t lo, int64_t hi) const;
    // An array of exactly `count` numbers, `fallback` if absent.
    std::vector<double> numbers(const char* key, size_t count, std::vector<double> fallback,
                                Range range = kAnyNumber) const;

    // A property that is the index of one of `count` objects called `kind` ("mesh").
    std::optional<size_t> reference(const char* key, const char* kind, size_t count) const;
    std::vector<size_t> references(const char* key, const char* kind, size_t count) const;

    std::optional<JsonObject> object(const char* key) const;      // called "WHERE KEY"
    std::optional<JsonObject> extension(const char* name) const;  // of `extensions`, called as the object itself
    // `extras`, which may be of any type: none unless it is an object.
    std::optional<JsonObject> extras() const;
    // The elements of an array of objects, called "WHERE KIND 0" or, if named and `byName`, "KIND "NAME"". Empty if
    // absent.
    std::vector<JsonObject> objects(const char* key, const char* kind, bool byName = false) const;
    // Number of elements of an array. 0 if absent.
    size_t size(const char* key) const;

  private:
    const Json* array(const char* key) const;  // nullptr if absent
    double checkedNumber(const std::string& name, const Json& value, Range range) const;
    size_t checkedReference(const std::string& name, const Json& value, const char* kind, size_t count) const;

    const Json* value_;
    std::string where_;
    const std::string* file_;
};

}  // namespace lsde
