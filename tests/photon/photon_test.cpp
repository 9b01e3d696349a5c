#include "photon/photon.h"

#include <doctest/doctest.h>

#include <cstring>
#include <limits>

#include "base/error.h"
#include "photon/photons.h"

using namespace lsde;
using test::Random;

namespace {

// Through the chord, which keeps its digits where the cosine loses them.
double angleDeg(Vec3 a, Vec3 b) {
    return 2 * std::asin(0.5 * glm::length(glm::dvec3(a) - glm::dvec3(b))) * 180 / 3.14159265358979;
}

}  // namespace

TEST_CASE("directions and normals come back from 32 and 16 bits nearly as they were") {
    Random random(1);
    double direction = 0, normal = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const Vec3 v = random.onSphere();
        direction = std::max(direction, angleDeg(unpackDirection(packDirection(v)), v));
        normal = std::max(normal, angleDeg(unpackNormal(packNormal(v)), v));
    }
    MESSAGE("largest error: direction " << direction << ", normal " << normal << " degrees");
    CHECK(direction < 0.005);
    CHECK(normal < 1);
}

TEST_CASE("axes are packed exactly, and any bits give a unit vector") {
    for (const Vec3 axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        for (const float sign : {-1.0F, 1.0F}) {
            CHECK(unpackDirection(packDirection(sign * axis)) == sign * axis);
            CHECK(unpackNormal(packNormal(sign * axis)) == sign * axis);
        }
    for (uint32_t bits = 0; bits < 65536; ++bits)
        REQUIRE(glm::length(unpackNormal(static_cast<uint16_t>(bits))) == doctest::Approx(1));
    Random random(2);
    for (int i = 0; i < 100'000; ++i) REQUIRE(glm::length(unpackDirection(random.bits())) == doctest::Approx(1));
}

TEST_CASE("the mean of a power rounded under many keys is the power") {
    for (const Rgb power : {Rgb(1, 1, 1), Rgb(255, 254.5F, 0.01F), Rgb(0.9999F, 0.5F, 1e-3F), Rgb(3e-7F, 1e-7F, 0),
                            Rgb(7e8F, 3e6F, 0), Rgb(1e30F, 3e29F, 1e28F), Rgb(1.1e-35F, 1e-36F, 0)}) {
        constexpr double kKeys = 400'000;
        glm::dvec3 sum(0), squares(0);
        for (uint64_t key = 0; key < static_cast<uint64_t>(kKeys); ++key) {
            const glm::dvec3 stored(unpackPower(packPower(power, key)));
            sum += stored / kKeys;
            squares += stored / kKeys * stored;
        }
        for (int c = 0; c < 3; ++c) {
            const double sigma = std::sqrt(std::max(0.0, squares[c] - sum[c] * sum[c]) / kKeys);
            CAPTURE(power[c]);
            CHECK(std::fabs(sum[c] - static_cast<double>(power[c])) <=
                  4 * sigma + 1e-6 * static_cast<double>(power[c]));
        }
    }
}

TEST_CASE("the largest channel of a power is off by less than a part in 127") {
    Random random(3);
    for (uint64_t key = 0; key < 100'000; ++key) {
        const Rgb power = std::pow(10.0F, random.between(-20, 20)) * random.inCube();
        const float most = maxComponent(power);
        REQUIRE(maxComponent(glm::abs(unpackPower(packPower(power, key)) - power)) <= most / 127);
    }
    CHECK(unpackPower(packPower(Rgb(0), 1)) == Rgb(0));
    const float huge = std::numeric_limits<float>::max();
    CHECK(isFinite(unpackPower(packPower(Rgb(huge), 1))));
}

TEST_CASE("the power stored in a map is the power emitted to 1e-4") {
    Random random(4);
    for (const bool same : {true, false}) {
        glm::dvec3 exact(0), stored(0);
        for (uint64_t key = 0; key < 20'000; ++key) {
            const Rgb power = same ? Rgb(0.7F, 0.31F, 0.013F) : std::exp(random.between(-2, 2)) * random.inCube();
            exact += glm::dvec3(power);
            stored += glm::dvec3(unpackPower(packPower(power, key)));
        }
        const double luminances[] = {glm::dot(exact, {0.2126, 0.7152, 0.0722}),
                                     glm::dot(stored, {0.2126, 0.7152, 0.0722})};
        MESSAGE("relative error of the sum: " << luminances[1] / luminances[0] - 1);
        CHECK(std::fabs(luminances[1] / luminances[0] - 1) < 1e-4);
    }
}

TEST_CASE("photons that are not finite are refused, not stored") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int field = 0; field < 5; ++field) {
        Photon p = test::photonAt(Vec3(0));
        CHECK_NOTHROW(pack(p));
        if (field == 0) p.power.y = nan;
        if (field == 1) p.power.y = kInfinity;
        if (field == 2) p.power.y = -1;
        if (field == 3) p.direction.x = nan;
        if (field == 4) p.ng = Vec3(0);
        CHECK_THROWS_AS(pack(p), Error);
    }
}

TEST_CASE("a photon's wavelength is stored beside its flags, and weighs its power when it is asked for") {
    for (const WavelengthId wavelength :
         {kAllWavelengths, WavelengthId{1}, WavelengthId{2048}, WavelengthId{kWavelengths}})
        for (uint16_t flags = 0; flags < 4; ++flags) {
            Photon p = test::photonAt(Vec3(0));
            p.flags = flags;
            p.wavelength = wavelength;
            const PhotonPayload stored = pack(p).payload;
            CHECK(stored.wavelength == wavelength);
            CHECK(stored.flags == (flags | kLandedOnFront));
            CHECK(rgbPower(stored) == unpackPower(stored.power) * wavelengthWeight(wavelength));
            // As the map's header tells other readers.
            uint16_t bits = 0;
            std::memcpy(&bits, reinterpret_cast<const char*>(&stored) + 22, 2);
            CHECK(bits == (wavelength << 4 | flags | kLandedOnFront));
        }
}

TEST_CASE("photons that differ in their wavelength alone are in order by it") {
    Photon a = test::photonAt(Vec3(0)), b = a;
    b.wavelength = 7;
    CHECK(pack(a) < pack(b));
    CHECK(!(pack(b) < pack(a)));
}
