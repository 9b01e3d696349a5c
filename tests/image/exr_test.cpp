#include "image/exr.h"

#include <ImfChannelList.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfThreading.h>
#include <ImfTiledOutputFile.h>
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <bit>
#include <csignal>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

#include "store/fixture.h"

namespace fs = std::filesystem;
using namespace lsde;
using test::contentOf;
using test::errorOf;
using test::TemporaryFolder;

namespace {

const fs::path kData = LSDE_TEST_DATA;

// All kinds of channels that a rendering has, with noise in them.
ImageFile testImage(int width = 37, int height = 21) {
    ImageFile image;
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    image.width = width;
    image.height = height;
    for (const char* channel :
         {"R", "G", "B", "caustic.R", "caustic.G", "caustic.B", "normal.X", "normal.Y", "normal.Z", "depth.Z"}) {
        auto& values = image.channels[channel];
        values.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
        for (float& v : values) v = normal(random);
    }
    return image;
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](float x, float y) { return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y); });
}

double sum(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

std::string exrRefusal(const fs::path& path, int64_t maxPixels = int64_t{1} << 28) {
    const std::string message = errorOf([&] { readExr(path, maxPixels); });
    CHECK_MESSAGE(message.find('\n') == std::string::npos, message);
    return message.starts_with(path.string() + ": ") ? message.substr(path.string().size() + 2)
                                                     : "(no path) " + message;
}

Imf::Header header(int width, int height) {
    Imf::Header h(width, height);
    h.channels().insert("R", Imf::Channel(Imf::FLOAT));
    return h;
}

// A file with one channel of type T, value x + 100 y, as scan lines or in tiles of 16x8.
template <typename T>
void writeForeign(const fs::path& path, Imf::PixelType type, int width, int height, bool tiled) {
    std::vector<T> values;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) values.push_back(static_cast<T>(x + 100 * y));
    Imf::Header h(width, height);
    h.channels().insert("R", Imf::Channel(type));
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice::Make(type, values.data(), h.dataWindow()));
    if (!tiled) {
        Imf::OutputFile file(path.c_str(), h);
        file.setFrameBuffer(buffer);
        file.writePixels(height);
        return;
    }
    h.setTileDescription(Imf::TileDescription(16, 8));
    Imf::TiledOutputFile file(path.c_str(), h);
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
}

}  // namespace

TEST_CASE("every channel and attribute comes back from an EXR") {
    const TemporaryFolder folder;
    const ImageFile image = testImage();
    ExrMetadata metadata;
    metadata.text = {{"software", "lsde"}, {"paths.caustic", "L[DS]*S+DE"}, {"empty", ""}};
    metadata.numbers = {{"samplesPerPixel", 64}, {"exposure", 0.1F}};
    metadata.whiteLuminance = 1.0F;
    metadata.worldToCamera = {1, 0, 0, 0, 0, 0.5F, 0, 0, 0, 0, 1, 0, 7, 8, -9, 1};
    writeExr(folder / "file.exr", image, metadata);
    CHECK(folder.names() == std::vector<std::string>{"file.exr"});

    const ImageFile back = readExr(folder / "file.exr");
    CHECK(back.width == image.width);
    CHECK(back.height == image.height);
    REQUIRE(back.channels.size() == image.channels.size());
    for (const auto& [name, values] : image.channels) CHECK_MESSAGE(sameBits(back.channels.at(name), values), name);
    CHECK(back.layerNames() == std::vector<std::string>{"", "caustic"});
    const std::map<std::string, std::string> expected = {{"software", "lsde"},
                                                         {"paths.caustic", "L[DS]*S+DE"},
                                                         {"empty", ""},
                                                         {"samplesPerPixel", "64"},
                                                         {"exposure", "0.1"},
                                                         {"whiteLuminance", "1"},
                                                         {"worldToCamera", "1 0 0 0 0 0.5 0 0 0 0 1 0 7 8 -9 1"},
                                                         {"chromaticities", "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329"},
                                                         {"dataWindow", "0 0 36 20"},
                                                         {"displayWindow", "0 0 36 20"}};
    for (const auto& [name, text] : expected) CHECK_MESSAGE(back.attributes.at(name) == text, name);
    for (const char* name : {"capDate", "owner", "utcOffset", "comments"}) CHECK_FALSE(back.attributes.contains(name));
}

TEST_CASE("values that are not finite, denormal or signed zeros are kept bit by bit") {
    const TemporaryFolder folder;
    using Limits = std::numeric_limits<float>;
    ImageFile image;
    image.width = 8;
    image.height = 1;
    image.channels["R"] = {Limits::quiet_NaN(),  std::bit_cast<float>(0xffc12345U),
                           Limits::infinity(),   -Limits::infinity(),
                           Limits::denorm_min(), -0.0F,
                           Limits::max(),        Limits::lowest()};
    writeExr(folder / "file.exr", image, {});
    CHECK(sameBits(readExr(folder / "file.exr").channels.at("R"), image.channels.at("R")));
}

TEST_CASE("the same image gives the same bytes, for any number of threads") {
    const TemporaryFolder folder;
    const ImageFile image = testImage(200, 150);
    writeExr(folder / "a.exr", image, {});
    writeExr(folder / "b.exr", image, {}, 3);
    const bool same = readExr(folder / "b.exr").channels == image.channels;
    Imf::setGlobalThreadCount(0);
    CHECK(same);
    CHECK(contentOf(folder / "a.exr") == contentOf(folder / "b.exr"));
}

TEST_CASE("a picture by another program has the sums that another reader finds") {
    // Sums in double precision of what the OpenEXR 3.5.3 wheel for Python reads.
    const ImageFile sphere = readExr(kData / "reference/glass-sphere.exr");
    CHECK(sphere.width == 64);
    CHECK(sphere.height == 64);
    for (const char* channel : {"R", "G", "B"})
        CHECK(sum(sphere.channels.at(channel)) == doctest::Approx(358.53466886644634).epsilon(1e-12));
    const ImageFile masks = readExr(kData / "reference/glass-sphere.masks.exr");
    CHECK(sum(masks.channels.at("caustic")) == 114);
    CHECK(sum(masks.channels.at("floor")) == 2192);
}

TEST_CASE("half, float and uint channels are read, from scan lines and from tiles") {
    const TemporaryFolder folder;
    const fs::path path = folder / "file.exr";
    for (const bool tiled : {false, true})
        for (const Imf::PixelType type : {Imf::UINT, Imf::HALF, Imf::FLOAT}) {
            if (type == Imf::UINT) writeForeign<uint32_t>(path, type, 37, 19, tiled);
            if (type == Imf::HALF) writeForeign<half>(path, type, 37, 19, tiled);
            if (type == Imf::FLOAT) writeForeign<float>(path, type, 37, 19, tiled);
            const ImageFile image = readExr(path);
            REQUIRE(image.width == 37);
            REQUIRE(image.height == 19);
            CAPTURE(tiled);
            CAPTURE(type);
            const auto& values = image.channels.at("R");
            CHECK(values[0] == 0);
            CHECK(values[36] == 36);
            CHECK(values[37 * 18 + 36] == 1836);
            CHECK(sum(values) == 37 * 19 * (18 + 900));
        }
}

TEST_CASE("a picture whose windows agree may begin anywhere") {
    const TemporaryFolder folder;
    const Imath::Box2i window({-5, 7}, {-2, 8});
    Imf::Header h(window, window);
    h.channels().insert("R", Imf::Channel(Imf::FLOAT));
    const std::vector<float> values = {1, 2, 3, 4, 5, 6, 7, 8};
    {
        Imf::OutputFile file((folder / "file.exr").c_str(), h);
        Imf::FrameBuffer buffer;
        buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, values.data(), window));
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    }
    CHECK(readExr(folder / "file.exr").channels.at("R") == values);
}

TEST_CASE("what is no EXR is refused by name") {
    const TemporaryFolder folder;
    const fs::path path = folder / "file.exr";
    CHECK(exrRefusal(path) == "cannot be opened: No such file or directory");
    CHECK(exrRefusal(folder.path()) == "is a folder, expected a file");
    test::put(path, "");
    CHECK(exrRefusal(path) == "is not an OpenEXR file: 0 bytes");
    test::put(path, "{\"asset\": {}}");
    CHECK(exrRefusal(path) == "is not an OpenEXR file");
}

TEST_CASE("kinds of EXR that are not taken are refused by what they are") {
    const TemporaryFolder folder;
    const fs::path path = folder / "file.exr";
    {
        Imf::Header h = header(4, 4);
        h.displayWindow() = Imath::Box2i({0, 0}, {9, 4});
        Imf::OutputFile file(path.c_str(), h);
    }
    CHECK(exrRefusal(path) == "data window 0 0 3 3, expected the display window, 0 0 9 4");
    {
        Imf::Header h = header(4, 4);
        h.channels().insert("BY", Imf::Channel(Imf::HALF, 2, 2));
        Imf::OutputFile file(path.c_str(), h);
    }
    CHECK(exrRefusal(path) == "channel \"BY\" is sub-sampled 2x2, expected 1x1");
    {
        Imf::Header h = header(4, 4);
        h.setType(Imf::DEEPSCANLINE);
        h.compression() = Imf::ZIPS_COMPRESSION;
        Imf::DeepScanLineOutputFile file(path.c_str(), h);
    }
    CHECK(exrRefusal(path) == "is a deep OpenEXR file, expected flat pixels");
    for (const Imf::Compression lossy : {Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        Imf::Header h = header(4, 4);
        h.compression() = lossy;
        { Imf::OutputFile file(path.c_str(), h); }
        CHECK(exrRefusal(path) == "is compressed by DWA, which is lossy, expected any other compression");
    }
    {
        std::vector<Imf::Header> headers(2, header(4, 4));
        headers[0].setName("left");
        headers[1].setName("right");
        for (Imf::Header& h : headers) h.setType(Imf::SCANLINEIMAGE);
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
    }
    CHECK(exrRefusal(path) == "is a multi-part OpenEXR file, expected a single part");
    { Imf::OutputFile file(path.c_str(), header(4, 4)); }
    CHECK(exrRefusal(path) == "truncated: parts of the picture are missing");
}

TEST_CASE("sizes are checked before memory is taken") {
    const TemporaryFolder folder;
    const fs::path path = folder / "file.exr";
    writeForeign<float>(path, Imf::FLOAT, 20, 10, false);
    CHECK(exrRefusal(path, 199) == "20x10 pixels, expected at most 199");
    CHECK(readExr(path, 200).width == 20);

    // The file with words put in after a text of its header.
    using namespace std::string_literals;
    const std::string sound = contentOf(path);
    const auto forge = [](std::string& file, const std::string& after, std::initializer_list<uint32_t> words) {
        size_t at = file.find(after) + after.size();
        for (const uint32_t word : words) {
            std::memcpy(&file[at], &word, sizeof word);
            at += sizeof word;
        }
    };
    std::string forged = sound;
    forge(forged, "compression\0compression\0"s, {0x7fffffff});
    test::put(path, forged);
    CHECK(exrRefusal(path).starts_with("attribute \"compression\": 2147483647 bytes, but the file ends after "));

    const auto withWindows = [&](uint32_t maxX, uint32_t maxY) {
        forged = sound;
        for (const std::string& window : {"dataWindow\0box2i\0"s, "displayWindow\0box2i\0"s})
            forge(forged, window, {16, 0, 0, maxX, maxY});
        test::put(path, forged);
        return exrRefusal(path);
    };
    CHECK(withWindows(0x7ffffffe, 0x7ffffffe) == "2147483647x2147483647 pixels, expected at most 268435456");
    CHECK(withWindows(16383, 16383) ==
          fmt::format("16384x16384 pixels with 1 channels cannot be in {} bytes", sound.size()));
    CHECK(withWindows(0xffffffff, 9) == "data window 0 0 -1 9 is empty");
}

TEST_CASE("a truncated EXR is refused at any length") {
    const TemporaryFolder folder;
    writeExr(folder / "sound.exr", testImage(), {});
    const std::string sound = contentOf(folder / "sound.exr");
    for (size_t bytes = 0; bytes < sound.size(); bytes += 61) {
        test::put(folder / "file.exr", sound.substr(0, bytes));
        CHECK_MESSAGE(!exrRefusal(folder / "file.exr").starts_with("(no path)"), bytes, " bytes");
    }
}

TEST_CASE("damaged files end in an error, not in a crash") {
    for (const auto& entry : fs::directory_iterator(kData / "odd/openexr")) {
        const std::string name = entry.path().filename();
        CAPTURE(name);
        if (name.starts_with("comp_"))
            CHECK_FALSE(exrRefusal(entry.path()).starts_with("(no path)"));
        else  // the picture is sound, only its attribute "type" is wrong
            CHECK(readExr(entry.path()).width == 40);
    }
    const TemporaryFolder folder;
    writeExr(folder / "sound.exr", testImage(), {});
    const std::string sound = contentOf(folder / "sound.exr");
    std::mt19937 random(2);
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string damaged = sound;
        const size_t range = i % 2 == 0 ? 600 : sound.size();  // the header, or anywhere
        for (int k = 0; k < 3; ++k) damaged[random() % range] = static_cast<char>(random());
        test::put(folder / "file.exr", damaged);
        refused += errorOf([&] { readExr(folder / "file.exr"); }).empty() ? 0 : 1;
    }
    MESSAGE(refused, " of 2000 damaged files refused");
    CHECK(refused > 500);  // an EXR has no checksum: damage to attributes and floats may go unseen
}

TEST_CASE("an EXR that cannot be written leaves the old file") {
    const TemporaryFolder folder;
    const fs::path path = folder / "file.exr";
    test::put(path, "old");
    const auto result = test::inChild([&] {
        const rlimit limit{4096, 4096};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        ::signal(SIGXFSZ, SIG_IGN);
        writeExr(path, testImage(), {});
    });
    CHECK(result.exitedWith(3));
    CHECK(result.standardError == path.string() + ": cannot be written: File too large");
    CHECK(contentOf(path) == "old");
    CHECK(folder.names() == std::vector<std::string>{"file.exr"});
    ExrMetadata reserved;
    reserved.text["channels"] = "not a channel list";
    CHECK(errorOf([&] { writeExr(path, testImage(), reserved); }).starts_with(path.string() + ": cannot be encoded: "));
}
