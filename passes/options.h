// Options that several commands share, and what their values may be.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "passes/scene_source.h"

namespace lsde {

struct CommonOptions {
    int threads = 0;
    uint64_t seed = 0;
    bool quiet = false;
    std::string logLevel = "info";
    bool force = false;
    std::string json;
    SceneSettings scene;
    EnvironmentSettings environment;
    bool withSky = false;
    SkySettings sky;
};

// scene: the command reads one.
void addCommon(CLI::App& app, CommonOptions& o, bool scene);

// Finite numbers alone: what is not a number passes each of CLI11's own bounds.
CLI::Validator numberFrom(double least, double most);
CLI::Validator positiveNumber();
CLI::Validator notEmpty();

// "A,B" -> A, B.
std::vector<std::string> splitNames(const std::string& list);
// `count` numbers from 0 to 65536; throws UsageError "OPTION TEXT: expected EXPECTED".
std::vector<int> parseInts(const std::string& option, const std::string& text, char separator, size_t count,
                           const char* expected);

}  // namespace lsde
