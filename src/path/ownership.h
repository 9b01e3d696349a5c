// Which technique owns which light path: the one place that decides (see "Who owns a path" in the design).
//
// Vertices V1, V2, ... are counted from the light, straight passages (T) left out; X = Bend or Glossy.
//   no vertex, or Bend only                          the camera path that hits the emitter
//   V1 Diffuse; or V1 Glossy and no Diffuse follows  direct light at V1 (MIS; delta lights: sampled light alone)
//   V1..V(j-1) in X, Vj the first Diffuse            the photon estimate at Vj
//   V1 Bend, some Glossy, no Diffuse                 the camera path hits the emitter; under a delta light the Glossy
//                                                    vertex nearest to the light gathers photons
// Where the map also holds light that met a Diffuse vertex (class indirect), it owns that light at diffuse lobes: of
// those, the vertex nearest to the eye gathers what met any Diffuse before it, and the eye's path ends there.
#pragma once

#include <cstdint>
#include <span>

#include "path/event.h"

namespace lsde {

enum class Owner : uint8_t { CameraHit, DirectLight, Photons };

// Who owns a path, and the vertex at which the owner joins light and eye path.
struct Ownership {
    Owner owner = Owner::CameraHit;
    int vertex = -1;  // counted from the light without straight passages, V1 = 0; -1: none (CameraHit)

    friend bool operator==(const Ownership&, const Ownership&) = default;
};

// From the whole path, light first. The specification that the walks below are tested against. A delta light is never
// hit: the paths from one that only bend, or meet nothing, carry no light.
// takesOver[i] != 0: the event at vertex i is a diffuse lobe's, and the map holds indirect light there. Empty: nowhere.
Ownership ownerOf(std::span<const VertexClass> classes, bool deltaLight, std::span<const uint8_t> takesOver = {});

// The light side, event by event: what may be stored where the walk arrives.
class LightWalkClass {
  public:
    void pass(VertexClass c);
    bool metDiffuse() const { return metDiffuse_; }
    bool metAny() const { return bends_ + glossies_ > 0 || metDiffuse_; }
    // A photon arriving at a Diffuse lobe: L X+ D.
    bool causticAtDiffuse() const { return !metDiffuse_ && bends_ + glossies_ > 0; }
    // A photon arriving at a Glossy lobe from a delta light: L B+ G.
    bool causticAtGlossy(bool deltaLight) const { return deltaLight && !metDiffuse_ && bends_ > 0 && glossies_ == 0; }

  private:
    bool metDiffuse_ = false;
    int bends_ = 0;
    int glossies_ = 0;
};

// The eye side, event by event: which estimates are made where the walk arrives.
class EyeWalkClass {
  public:
    // takesOver: the map owns what the lobe passed gets from light that met a Diffuse vertex.
    void pass(VertexClass c, bool takesOver = false);
    // Nothing but an emitter that is reached straight counts any more: direct light of the vertex passed, by MIS.
    bool onlyEmitters() const { return onlyEmitters_; }
    // Whether light is sampled at a lobe of this class at the vertex reached.
    bool samplesLight(VertexClass lobe) const {
        return lobe == VertexClass::Diffuse || (lobe == VertexClass::Glossy && !metDiffuse_);
    }
    // Whether photons are gathered there, and of which lights: at Diffuse lobes all caustic photons; at Glossy lobes
    // before the first Diffuse those of delta lights that met only Bends.
    bool gathers(VertexClass lobe) const {
        return lobe == VertexClass::Diffuse || (lobe == VertexClass::Glossy && !metDiffuse_);
    }
    // What a hit of an emitter counts: Full, weighted by MIS against light sampled at the last vertex, or Dropped.
    enum class EmitterHit : uint8_t { Full, Mis, Dropped };
    EmitterHit emitterHit() const;

  private:
    bool metDiffuse_ = false;
    bool onlyEmitters_ = false;
    VertexClass last_ = VertexClass::Straight;  // Straight: none yet
};

}  // namespace lsde
