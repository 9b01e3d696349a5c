// Rays through the picture and back.
#include "scene/camera.h"

#include <doctest/doctest.h>

#include "support/random.h"
#include "support/statistics.h"

using namespace lsde;
using namespace lsde::test;

namespace {

CameraDescription cameraOf(CameraKind kind) {
    CameraDescription c;
    c.kind = kind;
    c.position = {1, 2, 3};
    c.back = glm::normalize(Vec3(0.3F, 0.5F, 1));
    c.right = glm::normalize(glm::cross(Vec3(0, 1, 0), c.back));
    c.up = glm::cross(c.back, c.right);
    c.yfov = 0.7F;
    c.xmag = 2;
    c.ymag = 1;
    if (kind == CameraKind::ThinLens) {
        c.lensRadius = 0.2F;
        c.focusDistance = 4;
    }
    return c;
}

constexpr CameraKind kKinds[] = {CameraKind::Perspective, CameraKind::Orthographic, CameraKind::ThinLens};

}  // namespace

TEST_CASE("connecting a point of a ray finds the ray's pixel, direction and distance, for every kind of camera") {
    Random random(1);
    for (const CameraKind kind : kKinds) {
        const Camera camera(cameraOf(kind), 80, 40);
        for (int i = 0; i < 2000; ++i) {
            const Vec2 p(80 * random.uniform(), 40 * random.uniform()), lens = random.uniform2D();
            const float t = 0.1F + 20 * random.uniform();
            const CameraRay ray = camera.ray(p, lens);
            CHECK(glm::length(ray.ray.direction) == doctest::Approx(1).epsilon(1e-6));
            const auto c = camera.connect(ray.ray.at(t), lens);
            REQUIRE(c);
            CHECK(glm::length(c->pixel - p) < 2e-3F);
            CHECK(glm::length(c->direction + ray.ray.direction) < 1e-5F);
            CHECK(c->distance == doctest::Approx(t).epsilon(1e-4));
        }
    }
}

TEST_CASE("the picture's middle looks ahead, its top left corner up and to the left") {
    const Camera camera(cameraOf(CameraKind::Perspective), 80, 40);
    const CameraDescription& d = camera.description();
    CHECK(glm::length(camera.ray({40, 20}, {}).ray.direction + d.back) < 1e-6F);
    const Vec3 corner = camera.ray({0, 0}, {}).ray.direction;
    CHECK(glm::dot(corner, d.right) < 0);
    CHECK(glm::dot(corner, d.up) > 0);
    // yfov spans the height, pixels are square.
    const Vec3 top = camera.ray({40, 0}, {}).ray.direction, left = camera.ray({0, 20}, {}).ray.direction;
    CHECK(std::atan2(glm::dot(top, d.up), -glm::dot(top, d.back)) == doctest::Approx(0.35));
    CHECK(-glm::dot(left, d.right) / -glm::dot(left, d.back) == doctest::Approx(2 * std::tan(0.35)));
}

TEST_CASE("what lies behind the camera or outside the picture is not connected, and no pixel lies on the far border") {
    for (const CameraKind kind : kKinds) {
        const Camera camera(cameraOf(kind), 7, 5);
        const CameraDescription& d = camera.description();
        CHECK(!camera.connect(d.position + 2.0F * d.back, {0.5F, 0.5F}));
        CHECK(!camera.connect(d.position, {0.5F, 0.5F}));
        CHECK(!camera.connect(d.position - 2.0F * d.back + 50.0F * d.right, {0.5F, 0.5F}));
        Random random(2);
        for (int i = 0; i < 20000; ++i) {
            const auto c = camera.connect(
                d.position - 3.0F * d.back + (6 * random.uniform() - 3) * d.right + (4 * random.uniform() - 2) * d.up,
                {0.5F, 0.5F});
            if (c) CHECK((c->pixel.x >= 0 && c->pixel.x < 7 && c->pixel.y >= 0 && c->pixel.y < 5));
        }
    }
}

TEST_CASE("importance makes light traced to the camera the mean radiance of its pixels") {
    // A Lambertian plane that fills the view, of radiance 1: each pixel's sum over its points, of area times radiance
    // times the cosine times the importance, must be 1.
    for (const CameraKind kind : kKinds) {
        const Camera camera(cameraOf(kind), 4, 2);
        const CameraDescription& d = camera.description();
        const Vec3 normal = glm::normalize(d.back + 0.4F * d.right);
        const Vec3 centre = d.position - 5.0F * d.back;
        const Frame frame(normal);
        constexpr float kSize = 30;
        Random random(3);
        std::array<Mean, 8> pixels;
        for (int i = 0; i < 200000; ++i) {
            const Vec3 p = centre + kSize * ((random.uniform() - 0.5F) * frame.x + (random.uniform() - 0.5F) * frame.y);
            const auto c = camera.connect(p, random.uniform2D());
            for (size_t pixel = 0; pixel < 8; ++pixel) {
                const bool here = c && static_cast<size_t>(c->pixel.x) + 4 * static_cast<size_t>(c->pixel.y) == pixel;
                pixels[pixel].add(here ? square(kSize) * c->importance * glm::dot(normal, c->direction) : 0);
            }
        }
        for (const Mean& m : pixels) {
            CAPTURE(static_cast<int>(kind));
            CHECK(m.agrees(1));
        }
    }
}

TEST_CASE("a thin lens is sharp at its focus and spreads over its disc") {
    const Camera camera(cameraOf(CameraKind::ThinLens), 80, 40);
    const CameraDescription& d = camera.description();
    Random random(4);
    const Vec2 p(10, 30);
    const CameraRay central = camera.ray(p, {0.5F, 0.5F});
    const Vec3 focus = central.ray.at(4 / -glm::dot(central.ray.direction, d.back));
    float farthest = 0;
    for (int i = 0; i < 1000; ++i) {
        const CameraRay r = camera.ray(p, random.uniform2D());
        const Vec3 toFocus = focus - r.ray.origin;
        CHECK(glm::length(glm::cross(toFocus, r.ray.direction)) < 1e-5F);
        CHECK(std::fabs(glm::dot(r.ray.origin - d.position, d.back)) < 1e-6F);
        farthest = std::max(farthest, glm::length(r.ray.origin - d.position));
    }
    CHECK(farthest <= 0.2001F);
    CHECK(farthest > 0.19F);
}

TEST_CASE("a pixel's footprint is the distance between its neighbours' rays") {
    for (const CameraKind kind : {CameraKind::Perspective, CameraKind::Orthographic}) {
        const Camera camera(cameraOf(kind), 80, 40);
        const CameraRay a = camera.ray({40, 20}, {}), b = camera.ray({40, 21}, {});
        constexpr float kTravel = 7;
        CHECK(a.width + kTravel * a.spread ==
              doctest::Approx(glm::length(a.ray.at(kTravel) - b.ray.at(kTravel))).epsilon(1e-3));
    }
}

TEST_CASE("the world-to-camera matrix takes the position to zero and the axes to themselves") {
    const Camera camera(cameraOf(CameraKind::Perspective), 80, 40);
    const CameraDescription& d = camera.description();
    const Mat4 m = camera.worldToCamera();
    CHECK(glm::length(Vec3(m * Vec4(d.position, 1))) < 1e-6F);
    CHECK(glm::length(Vec3(m * Vec4(d.position + 2.0F * d.right + 3.0F * d.up - 4.0F * d.back, 1)) - Vec3(2, 3, -4)) <
          1e-5F);
}

TEST_CASE("a picture's size is that given, else the camera's, else 1280 wide at its aspect ratio") {
    CameraDescription c = cameraOf(CameraKind::Perspective);
    CHECK(pictureSize(c, {}) == std::array<int, 2>{1280, 720});
    c.aspectRatio = 2;
    CHECK(pictureSize(c, {}) == std::array<int, 2>{1280, 640});
    CHECK(pictureSize(cameraOf(CameraKind::Orthographic), {}) == std::array<int, 2>{1280, 640});
    c.resolution = {30, 20};
    CHECK(pictureSize(c, {}) == std::array<int, 2>{30, 20});
    CHECK(pictureSize(c, std::array<int, 2>{7, 8}) == std::array<int, 2>{7, 8});
}

TEST_CASE("a crop changes the film, not the rays") {
    Camera camera(cameraOf(CameraKind::Perspective), 80, 40);
    const Vec3 before = camera.ray({20, 10}, {}).ray.direction;
    camera.crop(10, 5, 30, 20);
    CHECK(camera.filmX() == 10);
    CHECK(camera.filmY() == 5);
    CHECK(camera.filmWidth() == 20);
    CHECK(camera.filmHeight() == 15);
    CHECK(camera.ray({20, 10}, {}).ray.direction == before);
}
