// Alpha as glTF means it: how much of what lies behind it a surface covers. Light that it does not cover passes without
// an event: unbent, untinted, and no letter of its path.
#pragma once

#include <vector>

#include "scene/material.h"
#include "scene/mesh.h"
#include "scene/texture.h"

namespace lsde {

// In [0,1], at the barycentric weights u, v of the triangle's second and third vertex: the alpha of base colour, its
// texture and the vertex colours (glTF 2.0, section 3.9.4); of MASK 0 or 1.
float coverage(const Mesh& mesh, const Material& material, const std::vector<Texture>& textures, uint32_t triangle,
               float u, float v);

// Whether coverage() may be below 1: exporters mark much as BLEND that is opaque all over.
bool coversPartly(const Mesh& mesh, const Material& material, const std::vector<Texture>& textures);

}  // namespace lsde
