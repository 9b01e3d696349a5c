// Maps from the unit square to directions and shapes, each with its density. Local frames have z as the pole.
#pragma once

#include "base/math.h"

namespace lsde {

Vec2 squareToDisk(Vec2 u);              // concentric (Shirley & Chiu 1997), unit disc
Vec3 squareToCosineHemisphere(Vec2 u);  // pdfW = cos / pi
inline float cosineHemispherePdf(float cosTheta) { return cosTheta > 0 ? cosTheta * kInvPi : 0; }
// Directions within the cone of half angle acos(cosMax) about +z (all of them: oneMinusCosMax 2); oneMinusCosMax in
// place of cosMax keeps narrow cones exact. pdfW = 1 / (2 pi oneMinusCosMax).
Vec3 squareToCone(Vec2 u, float oneMinusCosMax);
float conePdf(float oneMinusCosMax);
// The other way: the point of [0,1)^2 that is mapped there, to rounding.
Vec2 diskToSquare(Vec2 p);
Vec2 cosineHemisphereToSquare(Vec3 direction);
Vec2 coneToSquare(Vec3 direction, float oneMinusCosMax);
Vec2 squareToTriangle(Vec2 u);  // barycentric (b1, b2), uniform by area (Heitz 2019)
// Visible normals of GGX (Heitz 2018): wo in the local frame, z > 0; returns the half vector.
Vec3 sampleGgxVisibleNormal(Vec3 wo, float alphaX, float alphaY, Vec2 u);

}  // namespace lsde
