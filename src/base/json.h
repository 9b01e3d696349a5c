// JSON, compiled once: its class is so large that each file that used it would compile most of it anew.
#pragma once

#include <nlohmann/json.hpp>

extern template class nlohmann::basic_json<>;
