#include "path/ownership.h"

namespace lsde {

namespace {

// The vertex, counted without straight passages, at which the map takes over from the eye; -1: nowhere.
int vertexTakingOver(std::span<const VertexClass> classes, std::span<const uint8_t> takesOver) {
    int vertex = 0, taking = -1;
    bool metDiffuse = false;
    for (size_t i = 0; i < takesOver.size(); ++i) {
        if (takesOver[i] != 0) taking = metDiffuse ? vertex : -1;
        metDiffuse |= classes[i] == VertexClass::Diffuse;
        vertex += classes[i] == VertexClass::Straight ? 0 : 1;
    }
    return taking;
}

}  // namespace

Ownership ownerOf(std::span<const VertexClass> classes, bool deltaLight, std::span<const uint8_t> takesOver) {
    if (const int taking = vertexTakingOver(classes, takesOver); taking >= 0) return {Owner::Photons, taking};
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

void EyeWalkClass::pass(VertexClass c, bool takesOver) {
    if (c == VertexClass::Straight) return;
    onlyEmitters_ |= takesOver;
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
