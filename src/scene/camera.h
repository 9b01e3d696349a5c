// Cameras: rays through points of the picture, and back.
#pragma once

#include <optional>

#include "base/ray.h"
#include "scene/description.h"

namespace lsde {

struct CameraRay {
    Ray ray;
    float spread = 0;  // m of footprint (short side of a pixel) per metre of travel
    float width = 0;   // m of footprint at the origin (orthographic)
};

// Where and with what importance a point is seen (for light tracing). A camera without area sees it by one direction.
struct CameraConnection {
    Vec3 direction{0};     // unit, from the point to the camera
    float distance = 0;    // m
    Vec2 pixel{0};         // position in the picture
    float importance = 0;  // power arriving at the point, times f cos, times this, is the pixel's radiance sum (1/m2)
};

class Camera {
  public:
    Camera(const CameraDescription& description, int width, int height);

    // A ray through pixel position p (pixels, top left corner at 0,0; centres at .5). `lens` in [0,1)^2, thin lens
    // only.
    CameraRay ray(Vec2 p, Vec2 lens) const;
    // The point's connection through the lens position drawn by `lens`; none if it is outside the picture.
    std::optional<CameraConnection> connect(Vec3 point, Vec2 lens) const;

    int width() const { return width_; }
    int height() const { return height_; }

    // Only the pixels [x0, x1) x [y0, y1) are wanted: the film's size; pixel positions stay those of the whole picture.
    void crop(int x0, int y0, int x1, int y1);
    int filmX() const { return filmX_; }
    int filmY() const { return filmY_; }
    int filmWidth() const { return filmWidth_; }
    int filmHeight() const { return filmHeight_; }

    Mat4 worldToCamera() const;
    const CameraDescription& description() const { return description_; }

  private:
    Vec3 toWorld(Vec3 v) const { return v.x * description_.right + v.y * description_.up + v.z * description_.back; }

    CameraDescription description_;
    int width_, height_;
    int filmX_ = 0, filmY_ = 0, filmWidth_, filmHeight_;
    float halfX_, halfY_;  // half size of the picture at distance 1 (perspective) or in metres (orthographic)
};

// A picture's size: `size` if given, else the camera's extras.resolution, else 1280 wide at its aspect ratio.
std::array<int, 2> pictureSize(const CameraDescription& camera, std::optional<std::array<int, 2>> size);

}  // namespace lsde
