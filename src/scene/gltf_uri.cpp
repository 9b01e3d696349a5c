#include "scene/gltf_uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/error.h"
#include "scene/gltf_json.h"

namespace lsde {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDataScheme = "data:";

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// "%20" to " ". A percent sign that no two digits follow stands for itself: exporters write such names.
std::string percentDecoded(std::string_view uri) {
    std::string out;
    for (size_t i = 0; i < uri.size(); ++i) {
        const bool encoded =
            uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 && hexDigit(uri[i + 2]) >= 0;
        out += encoded ? static_cast<char>(16 * hexDigit(uri[i + 1]) + hexDigit(uri[i + 2])) : uri[i];
        if (encoded) i += 2;
    }
    return out;
}

// "http:", "c:": a letter, then letters, digits, + - or ., then a colon (RFC 3986, section 3.1).
bool hasScheme(std::string_view uri) {
    const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto inScheme = [&](char c) {
        return isLetter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
    };
    const auto end = std::find_if_not(uri.begin(), uri.end(), inScheme);
    return !uri.empty() && isLetter(uri.front()) && end != uri.end() && *end == ':';
}

constexpr std::array<int, 256> base64Values() {
    std::array<int, 256> values{};
    values.fill(-1);
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < kDigits.size(); ++i) values[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
    return values;
}

std::string decodeBase64(std::string_view text) {
    static constexpr std::array<int, 256> kValues = base64Values();
    if (text.size() % 4 != 0)
        throw Error(fmt::format("base64 data of {} characters, expected a multiple of 4", text.size()));
    size_t digits = text.size();
    while (digits > 0 && text.size() - digits < 2 && text[digits - 1] == '=') --digits;
    std::string out;
    out.reserve(digits / 4 * 3 + 2);
    uint32_t bits = 0;
    for (size_t i = 0; i < digits; ++i) {
        const int value = kValues[static_cast<unsigned char>(text[i])];
        if (value < 0)
            throw Error(fmt::format("base64 data with {} at character {}", shown(std::string(1, text[i])), i));
        bits = (bits << 6) | static_cast<uint32_t>(value);
        // Each digit after the first of four completes a byte.
        if (i % 4 != 0) out += static_cast<char>(bits >> (6 - 2 * (i % 4)));
    }
    return out;
}

bool isWithin(const fs::path& folder, const fs::path& path) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace

bool isDataUri(std::string_view uri) { return uri.starts_with(kDataScheme); }

std::string decodeDataUri(std::string_view uri) {
    constexpr std::string_view kBase64 = ";base64";
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(kBase64))
        throw Error(fmt::format("uri {}, expected data:TYPE;base64,DATA", shown(std::string(uri))));
    return decodeBase64(uri.substr(comma + 1));
}

fs::path resolveUri(const fs::path& folder, std::string_view uri, bool allowOutside) {
    const std::string name = percentDecoded(uri);
    const std::string uriShown = shown(std::string(uri));
    if (hasScheme(uri) || hasScheme(name))
        throw Error(fmt::format("uri {}: refused, expected a relative path or data:", uriShown));
    if (name.empty() || name.front() == '/' || name.front() == '\\' || name.find('\0') != std::string::npos)
        throw Error(fmt::format("uri {}: refused, expected a relative path", uriShown));
    std::error_code error;
    fs::path path = fs::weakly_canonical(folder / name, error);
    // Outside before missing: a refusal must not tell what is there.
    const fs::path home = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder);
    if (error || (!allowOutside && !isWithin(home, path)))
        throw Error(
            fmt::format("uri {}: outside the scene's folder, expected --allow-outside or a file within it", uriShown));
    if (!fs::exists(path, error)) throw Error(fmt::format("uri {}: no such file", uriShown));
    if (!fs::is_regular_file(path, error)) throw Error(fmt::format("uri {}: not a regular file", uriShown));
    return path;
}

}  // namespace lsde
