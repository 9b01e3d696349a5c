// Directions as a map from the unit square, and back.
#pragma once

#include "sampling/warp.h"
#include "transport/cone.h"

namespace lsde {

// Evenly within a cone about an axis (all directions: a cone of 1 - cos = 2), or by the cosine to it.
struct DirectionMap {
    Frame frame;
    float oneMinusCos = 2;  // of the cone's half angle
    bool cosine = false;

    static DirectionMap everywhere() { return {Frame(Vec3(0, 0, 1)), 2, false}; }
    static DirectionMap lambert(Vec3 normal) { return {Frame(normal), 1, true}; }
    static DirectionMap within(Vec3 axis, float oneMinusCos) { return {Frame(axis), oneMinusCos, false}; }

    Vec3 direction(Vec2 u) const {
        return frame.toWorld(cosine ? squareToCosineHemisphere(u) : squareToCone(u, oneMinusCos));
    }
    Vec2 square(Vec3 direction) const {
        const Vec3 local = frame.toLocal(direction);
        return cosine ? cosineHemisphereToSquare(local) : coneToSquare(local, oneMinusCos);
    }
    float pdf(Vec3 direction) const {  // 1/sr
        if (cosine) return cosineHemispherePdf(glm::dot(direction, frame.z));
        const bool inside = oneMinusCos >= 2 || lsde::within({frame.z, oneMinusCos, false}, direction);
        return inside ? conePdf(oneMinusCos) : 0;
    }
};

}  // namespace lsde
