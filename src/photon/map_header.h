// The header of a photon map as JSON.
#pragma once

#include <string>
#include <string_view>

#include "photon/map_file.h"

namespace lsde {

// What the header says of a class's section, to be held against it.
struct StoredClass {
    bool stored = false;
    uint64_t count = 0;
    Bounds bounds;
};
struct MapDescription {
    MapHeader header;
    StoredClass classes[kPhotonClasses];
};

// The same text for the same content.
std::string toJson(const MapDescription& map);

// Throws Error "\"FIELD\": ..., expected ..." on anything that toJson cannot have written.
MapDescription fromJson(std::string_view text);

}  // namespace lsde
