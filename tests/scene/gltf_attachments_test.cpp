// Cameras and lights on the nodes of a file.
#include <doctest/doctest.h>

#include "scene/gltf_file.h"
#include "support/near.h"

using namespace lsde;
using namespace lsde::test;

namespace {

GltfFile lightFile(const Json& light, const Json& node = Json::object()) {
    GltfFile file = triangleFile();
    file.json["extensions"] = {{"KHR_lights_punctual", {{"lights", {light}}}}};
    Json holder = node;
    holder["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    file.node(holder);
    return file;
}

GltfFile cameraFile(const Json& camera, const Json& node = Json::object()) {
    GltfFile file = triangleFile();
    file.add("cameras", camera);
    Json holder = node;
    holder["camera"] = 0;
    file.node(holder);
    return file;
}

const Json kPerspective = {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}};

}  // namespace

TEST_CASE("lights are placed by their nodes, whose scale changes neither direction nor power") {
    const Json spot = {{"type", "spot"},
                       {"name", "lamp"},
                       {"color", {1, 0.5, 0}},
                       {"intensity", 6},
                       {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}};
    for (const double scale : {1.0, 5.0, -3.0}) {
        // Turned by 90 degrees about x: -Z becomes +Y... and then about y by its parent: still up.
        GltfFile file = lightFile(
            spot,
            {{"translation", {1, 2, 3}}, {"rotation", {kRootHalf, 0, 0, kRootHalf}}, {"scale", {scale, scale, scale}}});
        const SceneDescription scene = load(file);
        REQUIRE(scene.lights.size() == 1);
        const PunctualLight& l = scene.lights[0];
        CHECK(l.name == "lamp");
        CHECK(l.kind == PunctualKind::Spot);
        CHECK(l.intensity == Rgb(6, 3, 0));
        checkNear(l.position, {1, 2, 3});
        checkNear(l.direction, {0, 1, 0});
        CHECK(l.innerConeAngle == 0.25F);
        CHECK(l.outerConeAngle == 0.5F);
    }
    GltfFile nested = lightFile({{"type", "directional"}}, {{"translation", {1, 0, 0}}, {"name", "sun"}});
    nested["/scenes/0/nodes"] = {0, 2};
    nested.add("nodes", {{"children", {1}}, {"rotation", {0, kRootHalf, 0, kRootHalf}}, {"scale", {2, 2, 2}}});
    const PunctualLight sun = load(nested).lights.at(0);
    CHECK(sun.name == "sun");
    checkNear(sun.position, {0, 0, -2});
    checkNear(sun.direction, {-1, 0, 0});
}

TEST_CASE("lights with impossible values are refused") {
    const auto said = [](const Json& light) { return refusalOf(lightFile(light)); };
    const auto spot = [&](double inner, double outer) {
        return said({{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}});
    };
    CHECK(spot(0.2, 0.3).empty());
    CHECK(contains(spot(0.3, 0.3), "light 0 spot: innerConeAngle 0.3, expected a number in [0, 0.3)"));
    CHECK(contains(spot(0.5, 0.3), "innerConeAngle 0.5"));
    CHECK(contains(spot(0, 2), "outerConeAngle 2"));
    CHECK(contains(said({{"type", "spot"}}), "light 0: spot is missing"));
    CHECK(contains(said({{"type", "point"}, {"intensity", -1}}), "light 0: intensity -1, expected a number >= 0"));
    CHECK(contains(said({{"type", "point"}, {"name", "lamp"}, {"color", {1, 1, 7}}}), "light \"lamp\": color[2] 7"));
    CHECK(contains(said({{"type", "point"}, {"range", 0}}), "light 0: range 0, expected a number > 0"));
    CHECK(contains(said(Json::object()), "light 0: type is missing"));
    CHECK(warnsOnce(load(lightFile({{"type", "point"}, {"range", 3}})), "a light's range is ignored"));
    const SceneDescription unknown = load(lightFile({{"type", "tube"}}));
    CHECK(unknown.lights.empty());
    CHECK(warnsOnce(unknown, "light 0: light of unknown type \"tube\" left out"));
    CHECK(contains(refusalOf(lightFile({{"type", "spot"}, {"spot", Json::object()}},
                                       {{"matrix", std::vector<int>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}}})),
                   "node 1: its matrix is singular"));
}

TEST_CASE("cameras look down their node's -Z, orthonormal whatever the scales above") {
    const CameraDescription c = load(cameraFile(kPerspective, {{"name", "eye"},
                                                               {"translation", {1, 2, 3}},
                                                               {"rotation", {0, kRootHalf, 0, kRootHalf}},
                                                               {"scale", {2, -3, 4}}}))
                                    .cameras.at(0);
    CHECK(c.name == "eye");
    CHECK(c.kind == CameraKind::Perspective);
    CHECK(c.yfov == 0.5F);
    CHECK(c.aspectRatio == 0);
    CHECK(!c.resolution);
    checkNear(c.position, {1, 2, 3});
    checkNear(c.back, {1, 0, 0});
    checkNear(c.up, {0, 1, 0});
    checkNear(c.right, {0, 0, -1});
    // A parent that mirrors x mirrors the picture.
    GltfFile mirrored = cameraFile(kPerspective);
    mirrored["/scenes/0/nodes"] = {0, 2};
    mirrored.add("nodes", {{"children", {1}}, {"scale", {-2, 2, 2}}});
    checkNear(load(mirrored).cameras.at(0).right, {-1, 0, 0});
}

TEST_CASE("orthographic and thin-lens cameras and their extras are read") {
    Json ortho = {{"type", "orthographic"},
                  {"name", "plan"},
                  {"orthographic", {{"xmag", 3}, {"ymag", -2}, {"znear", 0}, {"zfar", 10}}}};
    const CameraDescription plan = load(cameraFile(ortho)).cameras.at(0);
    CHECK(plan.kind == CameraKind::Orthographic);
    CHECK(plan.name == "plan");
    CHECK(plan.xmag == 3);
    CHECK(plan.ymag == 2);
    checkNear(plan.up, {0, -1, 0});  // a negative half size mirrors the picture
    Json lens = kPerspective;
    lens["extras"] = {{"resolution", {640, 480}}, {"lsde", {{"lensRadius", 0.02}, {"focusDistance", 3}}}};
    const CameraDescription thin = load(cameraFile(lens)).cameras.at(0);
    CHECK(thin.kind == CameraKind::ThinLens);
    CHECK(thin.lensRadius == 0.02F);
    CHECK(thin.focusDistance == 3);
    CHECK(thin.resolution == std::array<int, 2>{640, 480});
}

TEST_CASE("cameras with impossible values are refused, used or not") {
    const auto said = [](const char* pointer, const Json& value) {
        GltfFile file = cameraFile(kPerspective);
        file["/nodes/1"].erase("camera");
        file[pointer] = value;
        return refusalOf(file);
    };
    CHECK(contains(said("/cameras/0/type", "fisheye"), "camera 0: type \"fisheye\", expected \"perspective\""));
    CHECK(contains(said("/cameras/0/perspective/yfov", 0),
                   "camera 0 perspective: yfov 0, expected a number in (0, 3.14159)"));
    CHECK(
        contains(said("/cameras/0/perspective/aspectRatio", -1), "aspectRatio -1, expected a number in [0.02, 1000]"));
    CHECK(contains(said("/cameras/0/perspective", 1), "camera 0 perspective: 1, expected an object"));
    CHECK(contains(said("/cameras/0/extras", {{"resolution", {640}}}),
                   "camera 0 extras: resolution has 1 numbers, expected 2"));
    CHECK(contains(said("/cameras/0/extras", {{"resolution", {640, 0}}}),
                   "resolution[1] 0, expected a number in [1, 65536]"));
    CHECK(contains(said("/cameras/0/extras", {{"resolution", {640, 1.5}}}),
                   "resolution [640,1.5], expected whole numbers"));
    CHECK(contains(said("/cameras/0/extras", {{"resolution", {65536, 65536}}}),
                   "resolution [65536,65536], limit 268435456 pixels"));
    CHECK(contains(said("/cameras/0/extras", {{"lsde", {{"lensRadius", -1}, {"focusDistance", 1}}}}),
                   "lensRadius -1, expected a number >= 0"));
    CHECK(contains(said("/cameras/0/extras", {{"lsde", {{"lensRadius", 1}}}}),
                   "camera 0 extras lsde: focusDistance is missing"));
    const Json flat = {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 1}, {"ymag", 0}, {"znear", 0}, {"zfar", 1}}}};
    CHECK(contains(refusalOf(cameraFile(flat)), "camera 0 orthographic: xmag 1, ymag 0, expected other than 0"));
}

TEST_CASE("a camera or light beyond the limit of coordinates is refused") {
    for (const GltfFile& file : {cameraFile(kPerspective, {{"translation", {0, 2e9, 0}}}),
                                 lightFile({{"type", "point"}}, {{"translation", {0, 2e9, 0}}})})
        CHECK(contains(refusalOf(file), "node 1: its camera or light is at 0 2e+09 0 m, limit 1e+09 m"));
}
