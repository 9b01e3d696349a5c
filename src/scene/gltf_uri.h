// URIs of buffers and images: data within the JSON, or a file in the scene's folder.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lsde {

bool isDataUri(std::string_view uri);

// The bytes of "data:TYPE;base64,DATA". Throws Error saying what is wrong and at which character, without the file's
// name.
std::string decodeDataUri(std::string_view uri);

// The file that a relative URI (percent-encoded or not) names. Throws Error, without the scene file's name, for a
// scheme such as http:, an absolute path, a file that does not exist or is no regular one, and, unless allowOutside,
// one outside the folder, links followed.
std::filesystem::path resolveUri(const std::filesystem::path& folder, std::string_view uri, bool allowOutside);

}  // namespace lsde
