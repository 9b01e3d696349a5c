// Radiance pictures, written here byte by byte.
#include "image/hdr.h"

#include <doctest/doctest.h>

#include <fstream>
#include <random>

#include "base/error.h"
#include "store/fixture.h"

using namespace lsde;

namespace {

const std::string kHeader = "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n";

std::string sized(int width, int height) {
    return kHeader + "-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
}

std::string bytes(std::initializer_list<int> values) {
    std::string out;
    for (const int v : values) out += static_cast<char>(v);
    return out;
}

class Written {
  public:
    explicit Written(const std::string& content) { std::ofstream(file(), std::ios::binary) << content; }
    std::filesystem::path file() const { return folder_.path() / "sky.hdr"; }

  private:
    test::TemporaryFolder folder_;
};

RgbImage readBack(const std::string& content) { return readHdr(Written(content).file()); }

std::string hdrRefusal(const std::string& content, int64_t maxPixels = 1 << 20) {
    const Written written(content);
    try {
        readHdr(written.file(), maxPixels);
    } catch (const Error& e) {
        const std::string message = e.what();
        CHECK(message.starts_with(written.file().string() + ": "));
        return message.substr(written.file().string().size() + 2);
    }
    return "accepted";
}

// A row of eight pixels by channels: red a run of 8, green 8 literal values, blue both, exponents a run.
std::string packedRow() {
    return bytes({2, 2, 0, 8, 136, 128, 8, 1, 2, 3, 4, 5, 6, 7, 8, 133, 64, 3, 9, 10, 11, 136, 136});
}

}  // namespace

TEST_CASE("flat pixels are mantissas times a power of two, and an exponent of 0 is black") {
    const RgbImage image =
        readBack(sized(2, 2) + bytes({128, 64, 0, 129, 1, 2, 3, 136, 255, 255, 255, 0, 200, 100, 50, 126}));
    CHECK(image.at(0, 0) == Rgb(1, 0.5F, 0));
    CHECK(image.at(1, 0) == Rgb(1, 2, 3));
    CHECK(image.at(0, 1) == Rgb(0));
    CHECK(image.at(1, 1) == Rgb(200, 100, 50) / 1024.0F);
}

TEST_CASE("runs by channel and runs of whole pixels are unpacked") {
    const RgbImage packed = readBack(sized(8, 2) + packedRow() + packedRow());
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 8; ++x)
            CHECK(packed.at(x, y) == Rgb(128, static_cast<float>(x + 1), x < 5 ? 64.0F : static_cast<float>(x + 4)));
    const RgbImage old = readBack(sized(6, 1) + bytes({5, 6, 7, 136, 1, 1, 1, 4, 9, 9, 9, 136}));
    for (int x = 0; x < 5; ++x) CHECK(old.at(x, 0) == Rgb(5, 6, 7));
    CHECK(old.at(5, 0) == Rgb(9));
    // A second count in a row counts in units of 256.
    const RgbImage longRun = readBack(sized(260, 1) + bytes({5, 6, 7, 136, 1, 1, 1, 3, 1, 1, 1, 1}));
    for (int x = 0; x < 260; ++x) CHECK(longRun.at(x, 0) == Rgb(5, 6, 7));
}

TEST_CASE("the exposure is divided out") {
    const std::string pixel = bytes({8, 8, 8, 136});
    CHECK(readBack("#?RGBE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\nEXPOSURE= 4\n\n-Y 1 +X 1\n" + pixel).at(0, 0) ==
          Rgb(1));
}

TEST_CASE("what is no Radiance picture, or a damaged one, is refused and says why") {
    CHECK(hdrRefusal("") == "not a Radiance picture: expected \"#?\" at its beginning");
    CHECK(hdrRefusal("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n") == "the header is cut short");
    CHECK(hdrRefusal("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd") ==
          "FORMAT=32-bit_rle_xyze, expected FORMAT=32-bit_rle_rgbe");
    CHECK(hdrRefusal("#?RADIANCE\n\n-Y 1 +X 1\nabcd") == "no FORMAT line, expected FORMAT=32-bit_rle_rgbe");
    CHECK(hdrRefusal(kHeader + "+Y 1 +X 1\nabcd") == "resolution \"+Y 1 +X 1\", expected -Y HEIGHT +X WIDTH");
    CHECK(hdrRefusal(kHeader + "-Y 0 +X 1\nabcd") == "resolution \"-Y 0 +X 1\", expected -Y HEIGHT +X WIDTH");
    CHECK(hdrRefusal(sized(2000, 2000) + "abcd") == "2000x2000 pixels, expected at most 1048576");
    CHECK(hdrRefusal(sized(1000, 1000) + "abcd") == "row 0 is cut short");
    CHECK(hdrRefusal(sized(2, 2) + bytes({1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4})) == "row 1 is cut short");
    CHECK(hdrRefusal(sized(8, 1) + bytes({2, 2, 0, 9, 137, 1})) == "row 0 holds 9 pixels, expected 8");
    CHECK(hdrRefusal(sized(8, 1) + bytes({2, 2, 0, 8, 137, 1})) == "row 0: a run of 9 pixels at 0, expected 1 to 8");
    CHECK(hdrRefusal(sized(8, 1) + bytes({2, 2, 0, 8, 0, 1})) == "row 0: a run of 0 pixels at 0, expected 1 to 8");
    CHECK(hdrRefusal(sized(2, 1) + bytes({1, 1, 1, 1, 9, 9, 9, 9})) == "row 0: repeats 1 pixels at 0 of 2");
    CHECK(hdrRefusal("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=0\n\n") == "EXPOSURE=0, expected a number > 0");
}

TEST_CASE("no damage to a Radiance picture does worse than a refusal") {
    const std::string sound = sized(8, 4) + packedRow() + packedRow() + packedRow() + packedRow();
    REQUIRE(hdrRefusal(sound) == "accepted");
    std::mt19937 random(3);
    const Written written(sound);
    for (int i = 0; i < 500; ++i) {
        std::string damaged = sound.substr(0, i % 2 == 0 ? sound.size() : random() % sound.size());
        for (int k = 0; k < 3 && !damaged.empty(); ++k)
            damaged[random() % damaged.size()] = static_cast<char>(random());
        std::ofstream(written.file(), std::ios::binary | std::ios::trunc) << damaged;
        try {
            readHdr(written.file(), 1 << 16);
        } catch (const Error&) {
        }
    }
}
