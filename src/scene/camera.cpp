#include "scene/camera.h"

#include "sampling/warp.h"

namespace lsde {

Camera::Camera(const CameraDescription& description, int width, int height)
    : description_(description), width_(width), height_(height), filmWidth_(width), filmHeight_(height) {
    const float pictureAspect = static_cast<float>(width) / static_cast<float>(height);
    if (description.kind == CameraKind::Orthographic) {
        halfX_ = description.xmag;
        halfY_ = description.ymag;
    } else {
        halfY_ = std::tan(0.5F * description.yfov);
        // yfov spans the picture's height, as in glTF viewers; pixels stay square whatever the file's aspect ratio.
        halfX_ = halfY_ * pictureAspect;
    }
}

void Camera::crop(int x0, int y0, int x1, int y1) {
    filmX_ = x0;
    filmY_ = y0;
    filmWidth_ = x1 - x0;
    filmHeight_ = y1 - y0;
}

CameraRay Camera::ray(Vec2 p, Vec2 lens) const {
    const float x = (2 * p.x / static_cast<float>(width_) - 1) * halfX_;
    const float y = (1 - 2 * p.y / static_cast<float>(height_)) * halfY_;
    const float pixel = 2 * std::min(halfX_ / static_cast<float>(width_), halfY_ / static_cast<float>(height_));
    CameraRay out;
    if (description_.kind == CameraKind::Orthographic) {
        out.ray.origin = description_.position + x * description_.right + y * description_.up;
        out.ray.direction = -description_.back;
        out.width = pixel;
        return out;
    }
    const Vec3 throughCentre(x, y, -1);
    Vec3 origin(0);
    Vec3 direction = throughCentre;
    if (description_.kind == CameraKind::ThinLens) {
        const Vec2 onLens = description_.lensRadius * squareToDisk(lens);
        origin = Vec3(onLens, 0);
        direction = description_.focusDistance * throughCentre - origin;
    }
    out.ray.origin = description_.position + toWorld(origin);
    out.ray.direction = glm::normalize(toWorld(direction));
    out.spread = pixel / glm::length(throughCentre);
    return out;
}

std::optional<CameraConnection> Camera::connect(Vec3 point, Vec2 lens) const {
    const Vec3 d = point - description_.position;
    Vec3 local(glm::dot(d, description_.right), glm::dot(d, description_.up), glm::dot(d, description_.back));
    if (!(local.z < 0)) return {};
    CameraConnection out;
    Vec2 picture;  // at distance 1, or metres
    if (description_.kind == CameraKind::Orthographic) {
        picture = Vec2(local.x, local.y);
        out.direction = description_.back;
        out.distance = -local.z;
        // A pixel collects the light that leaves along -back from its area: importance is one over that area.
        out.importance = static_cast<float>(width_) * static_cast<float>(height_) / (4 * halfX_ * halfY_);
    } else {
        Vec3 origin(0);
        if (description_.kind == CameraKind::ThinLens) origin = Vec3(description_.lensRadius * squareToDisk(lens), 0);
        const Vec3 fromLens = local - origin;
        const float focus = description_.kind == CameraKind::ThinLens ? description_.focusDistance : 1;
        const Vec3 atFocus = origin + fromLens * (focus / -fromLens.z);
        picture = Vec2(atFocus) / focus;
        out.distance = glm::length(fromLens);
        out.direction = -toWorld(fromLens) / out.distance;
        // Pixel's solid angle at the lens: A cos^3 with A its area at distance 1 (Pharr et al. 2023, section 5.4.1).
        const float cosTheta = -fromLens.z / out.distance;
        const float pixelArea = 4 * halfX_ * halfY_ / (static_cast<float>(width_) * static_cast<float>(height_));
        out.importance = 1 / (pixelArea * cosTheta * cosTheta * cosTheta * square(out.distance));
    }
    out.pixel = Vec2(0.5F * (picture.x / halfX_ + 1) * static_cast<float>(width_),
                     0.5F * (1 - picture.y / halfY_) * static_cast<float>(height_));
    // Asked of the rounded position: one just inside the border may round onto it.
    const bool inside = out.pixel.x >= 0 && out.pixel.x < static_cast<float>(width_) && out.pixel.y >= 0 &&
                        out.pixel.y < static_cast<float>(height_);
    if (!inside) return {};
    return out;
}

Mat4 Camera::worldToCamera() const {
    const CameraDescription& c = description_;
    Mat4 m(1.0F);
    for (int i = 0; i < 3; ++i) {
        m[i][0] = c.right[i];
        m[i][1] = c.up[i];
        m[i][2] = c.back[i];
    }
    m[3] = Vec4(-glm::dot(c.right, c.position), -glm::dot(c.up, c.position), -glm::dot(c.back, c.position), 1);
    return m;
}

std::array<int, 2> pictureSize(const CameraDescription& camera, std::optional<std::array<int, 2>> size) {
    if (size) return *size;
    if (camera.resolution) return *camera.resolution;
    float aspect = camera.aspectRatio;
    if (camera.kind == CameraKind::Orthographic) aspect = camera.xmag / camera.ymag;
    if (!(aspect > 0)) aspect = 16.0F / 9;
    return {1280, std::max(1, static_cast<int>(std::lround(1280 / aspect)))};
}

}  // namespace lsde
