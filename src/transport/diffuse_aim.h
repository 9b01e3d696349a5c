// Where light goes on from a diffuse surface: towards what bends light, and anywhere.
#pragma once

#include <vector>

#include "transport/vertex.h"

namespace lsde {

// Light that lit a floor and then finds a glass is as much a caustic as the lamp's own, but few of a floor's directions
// lead there. A share of the directions is drawn from the cones of the casters' bounding spheres, the others from the
// surface's own lobe (a defensive mixture, Hesterberg 1995): the weight is lobe density / mixture density.
class DiffuseAim {
  public:
    // aimedShare in [0, 1): 0: everything is drawn from the lobe.
    DiffuseAim(const Scene& scene, float aimedShare);

    struct Direction {
        BsdfSample sample;   // weight, pdfs and event as of the lobe alone
        float weight = 1;    // lobe density / mixture density, at most 1 / (1 - aimedShare)
        bool aimed = false;  // which part drew it
    };
    // At a Lambertian surface. uChoice chooses the part. False: no light goes on.
    bool sample(const Vertex& v, const DiffuseBsdf& bsdf, float uChoice, Vec2 u, Direction& out) const;
    // Density of a direction (1/sr, world) by the mixture; for tests.
    float pdf(const Vertex& v, const DiffuseBsdf& bsdf, Vec3 direction) const;

  private:
    struct Parts;
    Parts partsAt(const Vertex& v) const;
    float mixturePdf(const Parts& parts, float lobePdf, Vec3 direction) const;

    float aimedShare_;
    std::vector<Sphere> casters_;
};

}  // namespace lsde
