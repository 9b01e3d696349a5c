#include "path/ownership.h"

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

#include "path/words.h"

using namespace lsde;

namespace {

using Classes = std::vector<VertexClass>;

// A path's vertices, and at which of them the map takes over light that met a Diffuse vertex.
struct Path {
    Classes classes;
    std::vector<uint8_t> takesOver;
};

// MIS weights of light sampling and of BSDF sampling for the same path: any two that add up to one.
constexpr double kSampledLight = 0.25;
constexpr double kSampledBsdf = 1 - kSampledLight;

Classes classesOf(std::string_view letters) {
    Classes out;
    for (const char c : letters)
        out.push_back(c == 'D'   ? VertexClass::Diffuse
                      : c == 'G' ? VertexClass::Glossy
                      : c == 'B' ? VertexClass::Bend
                                 : VertexClass::Straight);
    return out;
}

// The eye's walk up to vertex j: all events beyond it.
EyeWalkClass eyeWalkTo(const Path& path, size_t j) {
    EyeWalkClass walk;
    for (size_t i = path.classes.size(); i-- > j + 1;) walk.pass(path.classes[i], path.takesOver[i] != 0);
    return walk;
}

LightWalkClass lightWalkTo(const Classes& path, size_t j) {
    LightWalkClass walk;
    for (size_t i = 0; i < j; ++i) walk.pass(path[i]);
    return walk;
}

bool onlyStraight(const Classes& path, size_t end) {
    for (size_t i = 0; i < end; ++i)
        if (path[i] != VertexClass::Straight) return false;
    return true;
}

// Photons that the light's walk leaves at vertex j, gathered there by the eye's walk.
bool gathered(const Path& path, size_t j, bool deltaLight) {
    const LightWalkClass light = lightWalkTo(path.classes, j);
    const VertexClass c = path.classes[j];
    const bool stored = c == VertexClass::Diffuse  ? light.causticAtDiffuse()
                        : c == VertexClass::Glossy ? light.causticAtGlossy(deltaLight)
                                                   : false;
    const bool indirect = path.takesOver[j] != 0 && light.metDiffuse();
    const EyeWalkClass eye = eyeWalkTo(path, j);
    return (stored || indirect) && !eye.onlyEmitters() && eye.gathers(c);
}

// A shadow ray from vertex j, through straight passages only.
bool lightSampled(const Path& path, size_t j) {
    const bool scatters = path.classes[j] == VertexClass::Diffuse || path.classes[j] == VertexClass::Glossy;
    const EyeWalkClass eye = eyeWalkTo(path, j);
    return scatters && onlyStraight(path.classes, j) && !eye.onlyEmitters() && eye.samplesLight(path.classes[j]);
}

// The eye's walk arriving at the emitter itself.
double emitterHit(const Path& path, bool deltaLight) {
    if (deltaLight) return 0;
    EyeWalkClass walk;
    for (size_t i = path.classes.size(); i-- > 0;) {
        if (walk.onlyEmitters() && path.classes[i] != VertexClass::Straight) return 0;
        walk.pass(path.classes[i], path.takesOver[i] != 0);
    }
    switch (walk.emitterHit()) {
        case EyeWalkClass::EmitterHit::Full:
            return 1;
        case EyeWalkClass::EmitterHit::Mis:
            return kSampledBsdf;
        case EyeWalkClass::EmitterHit::Dropped:
            break;
    }
    return 0;
}

// How often each technique counts the path, with the vertex of the last one that did.
struct Counted {
    double photons = 0, direct = 0, cameraHit = 0;
    int vertex = -1;
};

Counted count(const Path& path, bool deltaLight) {
    Counted n;
    int vertex = 0;
    for (size_t j = 0; j < path.classes.size(); ++j) {
        if (path.classes[j] == VertexClass::Straight) continue;
        if (gathered(path, j, deltaLight)) {
            n.photons += 1;
            n.vertex = vertex;
        }
        if (lightSampled(path, j)) {
            n.direct += deltaLight ? 1 : kSampledLight;
            n.vertex = vertex;
        }
        ++vertex;
    }
    const double hit = emitterHit(path, deltaLight);
    (hit == kSampledBsdf ? n.direct : n.cameraHit) += hit;
    return n;
}

void checkCountedOnce(const Path& path) {
    for (const bool deltaLight : {false, true}) {
        std::string letters;
        for (const VertexClass c : path.classes) letters += "DGBT"[static_cast<size_t>(c)];
        for (size_t i = 0; i < letters.size(); ++i)
            if (path.takesOver[i] != 0) letters[i] = 'd';
        CAPTURE(letters);
        CAPTURE(deltaLight);
        const Ownership owner = ownerOf(path.classes, deltaLight, path.takesOver);
        const Counted n = count(path, deltaLight);
        REQUIRE(n.photons == (owner.owner == Owner::Photons ? 1 : 0));
        REQUIRE(n.direct == (owner.owner == Owner::DirectLight ? 1 : 0));
        // A delta light has no picture of its own.
        REQUIRE(n.cameraHit == (owner.owner == Owner::CameraHit && !deltaLight ? 1 : 0));
        REQUIRE(n.vertex == owner.vertex);
    }
}

}  // namespace

TEST_CASE("every path is counted exactly once, by its owner") {
    // Straight passages anywhere, before the first vertex and after the last one as well.
    const std::array all{VertexClass::Diffuse, VertexClass::Glossy, VertexClass::Bend, VertexClass::Straight};
    const std::vector<Classes> paths = allSequences<Classes>(all, 7);
    REQUIRE(paths.size() == 21845);
    for (const Classes& path : paths) checkCountedOnce({path, std::vector<uint8_t>(path.size())});
}

TEST_CASE("every path is counted exactly once where the map takes over at some of its diffuse vertices") {
    const std::array all{VertexClass::Diffuse, VertexClass::Glossy, VertexClass::Bend, VertexClass::Straight};
    for (const Classes& path : allSequences<Classes>(all, 6))
        for (uint32_t chosen = 1; chosen < (1U << path.size()); ++chosen) {
            Path p{path, {}};
            bool diffuse = true;
            for (size_t i = 0; i < path.size(); ++i) {
                p.takesOver.push_back(static_cast<uint8_t>(chosen >> i & 1));
                diffuse &= p.takesOver[i] == 0 || path[i] == VertexClass::Diffuse;
            }
            if (diffuse) checkCountedOnce(p);
        }
}

TEST_CASE("paths have the owners of the design") {
    struct Row {
        const char* path;  // light first
        Ownership area, delta;
    };
    const Ownership hit{Owner::CameraHit, -1};
    const auto direct = Ownership{Owner::DirectLight, 0};
    const auto photons = [](int vertex) { return Ownership{Owner::Photons, vertex}; };
    const Row rows[] = {
        {"", hit, hit},
        {"B", hit, hit},
        {"BB", hit, hit},
        {"D", direct, direct},
        {"DD", direct, direct},
        {"DGB", direct, direct},
        {"DBD", direct, direct},
        {"G", direct, direct},
        {"GG", direct, direct},
        {"GBGB", direct, direct},
        {"BD", photons(1), photons(1)},
        {"BBDBD", photons(2), photons(2)},
        {"GD", photons(1), photons(1)},
        {"GBD", photons(2), photons(2)},
        {"BGD", photons(2), photons(2)},
        {"BGDGB", photons(2), photons(2)},
        {"BG", hit, photons(1)},
        {"BBG", hit, photons(2)},
        {"BGG", hit, photons(1)},
        {"BGBG", hit, photons(1)},
        // A pane changes no owner, wherever it stands.
        {"T", hit, hit},
        {"TD", direct, direct},
        {"TTG", direct, direct},
        {"TBD", photons(1), photons(1)},
        {"BTD", photons(1), photons(1)},
        {"TBTGT", hit, photons(1)},
    };
    for (const Row& row : rows) {
        CAPTURE(row.path);
        CHECK(ownerOf(classesOf(row.path), false) == row.area);
        CHECK(ownerOf(classesOf(row.path), true) == row.delta);
    }
}

TEST_CASE("a light walk tells light that came straight from light that met something") {
    const auto after = [](std::string_view letters) {
        const Classes path = classesOf(letters);
        return lightWalkTo(path, path.size());
    };
    CHECK(!after("").metAny());
    CHECK(!after("TT").metAny());
    CHECK(after("B").metAny());
    CHECK(after("TG").metAny());
    CHECK(after("D").metAny());
    CHECK(!after("BG").metDiffuse());
    CHECK(after("BDB").metDiffuse());
}
