// A point of a path where light meets a surface.
#pragma once

#include "bsdf/bsdf.h"
#include "scene/scene.h"

namespace lsde {

struct Vertex {
    Surface surface;
    Bsdf bsdf;
    Frame frame;                 // about the shading normal, front side
    Vec3 woWorld{0};             // unit, back along the path
    Vec3 wo{0};                  // the same in the frame
    MediaStack before;           // on wo's side
    MediaStack behind;           // on the other side
    MediumId medium = kOutside;  // dominant one on wo's side
    float distance = 0;          // m travelled to get here
    bool interface = false;      // bounds a solid
    bool disperses = false;      // what it scatters depends on the wavelength

    // The solids around light on wo's side, or around what goes through the surface.
    const MediaStack& media(bool through) const { return through && interface ? behind : before; }
    // Whether a direction (world) is on the other side than wo.
    bool isThrough(Vec3 wi) const { return glm::dot(wi, surface.ng) * glm::dot(woWorld, surface.ng) < 0; }
    // The shading normal on wo's side.
    Vec3 shadingNormal() const { return wo.z < 0 ? -surface.ns : surface.ns; }
    // The geometric normal on wo's side.
    Vec3 sideNormal() const { return glm::dot(surface.ng, woWorld) < 0 ? -surface.ng : surface.ng; }
};

}  // namespace lsde
