#include "path/ownership.h"

namespace lsde {

Ownership ownerOf(std::span<const VertexClass> classes, bool deltaLight) {
    int vertex = 0, firstGlossy = -1;
    for (const VertexClass c : classes) {
        if (c == VertexClass::Straight) continue;
        if (c == VertexClass::Diffuse) return {vertex == 0 ? Owner::DirectLight : Owner::Photons, vertex};
        if (c == VertexClass::Glossy && firstGlossy < 0) firstGlossy = vertex;
        ++vertex;
    }
    if (firstGlossy == 0) return {Owner::DirectLight, 0};
    if (firstGlossy > 0 && deltaLight) return {Owner::Photons, firstGlossy};
    return {Owner::CameraHit, -1};
}

void LightWalkClass::pass(VertexClass c) {
    metDiffuse_ |= c == VertexClass::Diffuse;
    bends_ += c == VertexClass::Bend ? 1 : 0;
    glossies_ += c == VertexClass::Glossy ? 1 : 0;
}

void EyeWalkClass::pass(VertexClass c) {
    if (c == VertexClass::Straight) return;
    metDiffuse_ |= c == VertexClass::Diffuse;
    last_ = c;
}

EyeWalkClass::EmitterHit EyeWalkClass::emitterHit() const {
    switch (last_) {
        case VertexClass::Diffuse:
            return EmitterHit::Mis;
        case VertexClass::Glossy:  // after a Diffuse the light walk has passed it: photons own the path
            return metDiffuse_ ? EmitterHit::Dropped : EmitterHit::Mis;
        case VertexClass::Bend:
            return metDiffuse_ ? EmitterHit::Dropped : EmitterHit::Full;
        case VertexClass::Straight:
            break;
    }
    return EmitterHit::Full;
}

}  // namespace lsde
