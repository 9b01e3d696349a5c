// A luminaire's measured distribution of light (ANSI/IES LM-63: 1995, 2002, 2019).
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace lsde {

// Luminous intensity by direction, bilinear between the angles measured; dark beyond them. As EXT_lights_ies lays it
// out in a node's frame: both angles 0 look along -Z; the horizontal plane is X/Y, the vertical one X/Z.
class IesProfile {
  public:
    // Of a file's text. Throws Error, without the file's name, which says what is wrong and what was expected. What the
    // extension leaves aside (keywords, TILT, lamps, sizes, watts) does not matter here.
    explicit IesProfile(std::string_view text);

    // In [0,1], of the greatest intensity; of light that leaves in a direction, unit, in the node's frame.
    float relative(Vec3 direction) const;
    float greatest() const { return greatest_; }  // cd
    // Integral of relative() over all directions, in sr.
    float solidAngle() const { return solidAngle_; }
    // The file tilts its lamp, which changes its output: left aside.
    bool tilted() const { return tilted_; }
    // All that relative() depends on, for a hash of the scene.
    std::array<const std::vector<float>*, 3> tables() const { return {&vertical_, &horizontal_, &values_}; }
    int photometry() const { return static_cast<int>(photometry_); }

  private:
    enum class Photometry { C = 1, B = 2, A = 3 };

    float at(float vertical, float horizontal) const;  // degrees
    // Makes up the horizontal angles that symmetry leaves out.
    void completePlanes();
    void mirrorPlanes(float about);  // those on one side of a plane (degrees) to its other side
    float integrate() const;

    Photometry photometry_ = Photometry::C;
    std::vector<float> vertical_, horizontal_;  // degrees, ascending
    std::vector<float> values_;                 // [horizontal * vertical count + vertical], relative
    float greatest_ = 0, solidAngle_ = 0;
    bool tilted_ = false;
};

}  // namespace lsde
