// KHR_materials_variants: other materials for the same meshes, chosen by name.
#pragma once

#include <string>
#include <vector>

#include "scene/gltf_json.h"

namespace lsde {

// Names of the file's variants, in order; empty without the extension. Throws Error for one without a name.
std::vector<std::string> readVariants(const JsonObject& root);

// Gives each primitive of a validated file the material that the variant maps it to; the others keep theirs. Throws
// Error naming the variants there are.
void chooseVariant(Json& json, const std::string& file, const std::string& variant);

}  // namespace lsde
