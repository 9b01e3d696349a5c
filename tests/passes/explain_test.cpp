// Why a scene shows no caustic, each reason in a scene of its own, and what is said of one that does.
#include "passes/explain.h"

#include <doctest/doctest.h>

#include "base/json.h"
#include "passes/emit.h"
#include "support/scenes.h"

using namespace lsde;
using namespace lsde::test;

namespace {

Explanation explained(const SceneBuilder& builder) {
    RunContext run(1, 1);
    return explainByPilot(*builder.build(), run);
}

bool says(const Explanation& e, const std::string& part) { return e.text.find(part) != std::string::npos; }

struct Parts {
    Material ball = glass(1.5F);
    CausticSwitches ballSwitches, floorSwitches;
    bool lamp = true, lampUp = false, lid = false, floor = true;
};

// A ball over a floor, under a lamp that shines down.
SceneBuilder scene(const Parts& p) {
    SceneBuilder builder;
    if (p.floor) builder.add(plate({0, 0, 0}, 3), lambert(Rgb(0.7F)), "floor").switches = p.floorSwitches;
    builder.add(sphere({0, 1, 0}, 0.5F, 3), p.ball, "ball").switches = p.ballSwitches;
    if (p.lamp) builder.add(plate({0, 4, 0}, 0.3F, p.lampUp), emitter(Rgb(10)), "lamp");
    if (p.lid) builder.add(box({-0.5F, 3, -0.5F}, {0.5F, 4.5F, 0.5F}), lambert(Rgb(0.1F)), "lid");
    return builder;
}

}  // namespace

TEST_CASE("of a scene with a caustic it is told which light makes it, by what, where, and how much") {
    const Explanation e = explained(scene({}));
    CHECK(e.reason == NoCaustics::ThereAre);
    CHECK(e.noCaustics.empty());
    CHECK(e.lights == std::vector<std::string>{"lamp"});
    CHECK(e.casters == std::vector<std::string>{"ball"});
    CHECK(e.receivers == std::vector<std::string>{"floor"});
    CHECK(says(e, "Light of \"lamp\" falls by way of \"ball\" on \"floor\" as caustics (LS+D): "));
    // The lamp's power is pi L A; the ball takes about r^2 / d^2 of it, and hardly any of that is not refracted down.
    CHECK(e.emitted.x == doctest::Approx(10 * kPi * 0.36F));
    CHECK(e.caustic.x / e.emitted.x == doctest::Approx(0.25 / 9).epsilon(0.1));
    CHECK(e.json()["reason"] == "thereAre");
    CHECK(e.json()["receivers"][0] == "floor");
}

TEST_CASE("the flux told by a few paths is that of the map") {
    const auto built = scene({}).build();
    RunContext run(1, 1);
    EmitSettings settings;
    settings.photons = 200'000;
    const PhotonMap map = emitPhotons(*built, settings, run);
    const Explanation byMap = explain(*built, allLights(*built), map.header.ledger, map.header.emittedPaths());
    CHECK(explainByPilot(*built, run).caustic.x == doctest::Approx(byMap.caustic.x).epsilon(0.02));
}

TEST_CASE("no light") {
    Parts p;
    p.lamp = false;
    const Explanation e = explained(scene(p));
    CHECK(e.reason == NoCaustics::NoLight);
    CHECK(says(e, "no caustics here: the scene has no lights (--sky and --environment FILE add one)"));
}

TEST_CASE("nothing specular") {
    Parts p;
    p.ball = lambert(Rgb(0.5F));
    const Explanation e = explained(scene(p));
    CHECK(e.reason == NoCaustics::NothingSpecular);
    CHECK(says(e, "nothing in the scene is specular"));
}

TEST_CASE("metal or glass rougher than the split is named with its roughness") {
    Parts p;
    p.ball = glass(1.5F);
    p.ball.roughness = 0.26F;
    CHECK(says(explained(scene(p)), "the smoothest glass, \"ball\", has roughness 0.26"));
    p.ball = metal(0.3F);
    const Explanation e = explained(scene(p));
    CHECK(e.reason == NoCaustics::TooRough);
    CHECK(says(e, "nothing is smoother than roughness 0.25"));
    CHECK(says(e, "the smoothest metal, \"ball\", has roughness 0.3"));
    p.ball = metal(0.2F);
    CHECK(explained(scene(p)).reason == NoCaustics::ThereAre);
}

TEST_CASE("what is never aimed at is named") {
    Parts p;
    p.ballSwitches.casts = false;
    CHECK(says(explained(scene(p)), "Light is not aimed at what has extras.lsde.castsCaustics false: \"ball\"."));
}

TEST_CASE("the lamp faces away, the spot shines past") {
    Parts p;
    p.lampUp = true;
    const Explanation e = explained(scene(p));
    CHECK(e.reason == NoCaustics::FacesAway);
    CHECK(says(e, "no light shines towards what is specular"));
    p.lamp = false;
    SceneBuilder past = scene(p);
    past.spot({2, 3, 0}, {2, 0, 0}, Rgb(10), 5, 10);
    CHECK(explained(past).reason == NoCaustics::FacesAway);
}

TEST_CASE("something keeps the light from what is specular") {
    Parts p;
    p.lid = true;
    const Explanation e = explained(scene(p));
    CHECK(e.reason == NoCaustics::NotReached);
    CHECK(says(e, "something keeps the light from all that is specular"));
}

TEST_CASE("light comes off what is specular, but meets nothing diffuse") {
    Parts p;
    p.floor = false;
    const Explanation e = explained(scene(p));
    CHECK(e.reason == NoCaustics::LandsNowhere);
    CHECK(says(e, "meets no diffuse surface"));
}

TEST_CASE("where the caustic would fall nothing may receive it") {
    Parts p;
    p.floorSwitches.receives = false;
    const Explanation e = explained(scene(p));
    CHECK(e.reason == NoCaustics::ReceivesNot);
    CHECK(says(e, "extras.lsde.receivesCaustics is false wherever they would fall: on \"floor\""));
}

TEST_CASE("a floor that is seen from behind receives as well") {
    SceneBuilder builder;
    builder.add(plate({0, 0, 0}, 3, false), lambert(Rgb(0.7F)), "floor");
    builder.add(sphere({0, 1, 0}, 0.5F, 3), glass(1.5F), "ball");
    builder.point({0, 4, 0}, Rgb(10));
    const Explanation e = explained(builder);
    CHECK(e.reason == NoCaustics::ThereAre);
    CHECK(says(e, "A light without size is seen itself neither straight, nor in mirrors or through glass: \"point\"."));
}

TEST_CASE("glass without a volume is told to bend nothing") {
    Parts p;
    p.ball = thinWall(Rgb(1));
    CHECK(says(explained(scene(p)),
               "Glass without KHR_materials_volume is a thin wall, which light passes unbent: \"ball\"."));
}

TEST_CASE("many lights are told by their number") {
    SceneBuilder builder = scene({});
    for (int i = 0; i < 5; ++i)
        builder.add(plate({static_cast<float>(i) - 2, 5, 1}, 0.1F, false), emitter(Rgb(10)),
                    "lamp " + std::to_string(i));
    CHECK(says(explained(builder), "\"lamp\", \"lamp 0\", \"lamp 1\" and 3 more"));
}
