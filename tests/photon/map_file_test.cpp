#include "photon/map_file.h"

#include <doctest/doctest.h>

#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/hash.h"
#include "photon/density.h"
#include "photon/map_header.h"
#include "photon/photons.h"
#include "store/container.h"
#include "store/fixture.h"

using namespace lsde;
using test::contentOf;
using test::errorOf;
using test::put;
using test::Random;
using test::TemporaryFolder;

namespace {

// Photons and ledger of the paths [begin, end) of an emission of 10,000: 0, 1 or 2 photons a path and class.
PhotonMap mapOf(IndexRange range, bool all = false) {
    PhotonMap map;
    MapHeader& h = map.header;
    h.sceneHash = "0123456789abcdef0123456789abcdef";
    h.seed = std::numeric_limits<uint64_t>::max();
    h.totalPaths = 10'000;
    h.maxDepth = 64;
    h.store = all ? "all" : "caustic";
    h.lights = {"lamp", "the \"sun\""};
    h.objects = {"floor", "wall", "B\u00e4lle"};
    for (size_t i = 0; i < Dispersion::kCounts; ++i)
        h.dispersion[1].at4TimesPowersOf2[i] = 1 / (1.25F + static_cast<float>(i));
    if (range.begin < range.end) h.ranges = {range};
    h.ledger = Ledger(2, 3);
    std::vector<PackedPhoton> photons[kPhotonClasses];
    for (uint64_t path = range.begin; path < range.end; ++path)
        for (size_t c = 0; c < (all ? kPhotonClasses : 1); ++c) {
            Random random(static_cast<uint32_t>(3 * path + c));
            for (uint32_t n = random.bits() % 3; n-- > 0;) {
                const Photon p = test::randomPhoton(random, hashCombine(path, n));
                photons[c].push_back(pack(p));
                h.ledger[LedgerColumn::Emitted] += FixedRgb(p.power);
                h.ledger.flux[3 * c + random.bits() % 3] += FixedRgb(p.power);
                ++h.ledger.landed[c];
                h.ledger.maxAimWeight = std::max(h.ledger.maxAimWeight, static_cast<double>(p.power.x));
            }
        }
    ThreadPool pool(2);
    for (size_t c = 0; c < (all ? kPhotonClasses : 1); ++c)
        map.setTree(static_cast<PhotonClass>(c), buildPhotonTree(std::move(photons[c]), pool));
    return map;
}

template <typename T>
bool sameBytes(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

// All kinds of queries over the whole map, so that a sanitizer sees any step outside of its memory.
void query(const PhotonMap& map) {
    for (int c = 0; c < kPhotonClasses; ++c) {
        const PhotonTreeView tree = map.photons(static_cast<PhotonClass>(c));
        const KdIndex index(tree);
        DensityScratch scratch;
        DensityQuery density;
        density.minCount = 20;
        density.maxRadius = 1;
        for (const float x : {-0.4F, 0.0F, 0.4F, 3.0F}) {
            density.point.position = Vec3(x, 0, 0);
            index.within(Vec3(x, 0, 0), 10, scratch.found);
            index.nearest(Vec3(x, 0, 0), 10, kInfinity, scratch.found);
            gatherPhotons(index, density, scratch, [&](uint32_t i, float) { REQUIRE(i < tree.count); });
        }
    }
}

// The sections of a map, to be put together again with other content under sound checksums.
struct Sections {
    std::string header;
    std::vector<KdNode> nodes;
    std::vector<PhotonBlock> blocks;
    std::vector<PhotonPayload> payload;

    explicit Sections(const std::filesystem::path& file) {
        const ContainerReader reader(file, {"photons", kMapVersion});
        const auto text = reader.section<char>("header");
        header.assign(text.begin(), text.end());
        const auto copy = [](auto& to, const auto& from) { to.assign(from.begin(), from.end()); };
        copy(nodes, reader.section<KdNode>("caustic.nodes"));
        copy(blocks, reader.section<PhotonBlock>("caustic.blocks"));
        copy(payload, reader.section<PhotonPayload>("caustic.payload"));
    }

    void write(const std::filesystem::path& file) const {
        ContainerWriter writer(file, {"photons", kMapVersion});
        writer.section("header", std::span<const char>(header));
        writer.section("caustic.nodes", std::span(nodes));
        writer.section("caustic.blocks", std::span(blocks));
        writer.section("caustic.payload", std::span(payload));
        writer.commit();
    }
};

struct Fixture {
    TemporaryFolder folder;
    RunContext run{2};
    std::filesystem::path file = folder / "map.lsmap";

    std::string readingError() {
        return errorOf([&] { query(readPhotonMap(file, run)); });
    }
};

}  // namespace

TEST_CASE_FIXTURE(Fixture, "a map comes back from its file as it was, with at most 40 bytes a photon") {
    for (const bool all : {false, true}) {
        const PhotonMap map = mapOf({0, 10'000}, all);
        writePhotonMap(file, map, run);
        const PhotonMap read = readPhotonMap(file, run);
        CHECK(map.scratchPlace() == ScratchPlace::Memory);
        CHECK(read.scratchPlace() == ScratchPlace::File);
        uint64_t count = 0;
        for (int c = 0; c < kPhotonClasses; ++c) {
            const auto photonClass = static_cast<PhotonClass>(c);
            const PhotonTreeView a = map.photons(photonClass), b = read.photons(photonClass);
            CHECK(read.stores(photonClass) == (all || c == 0));
            count += a.count;
            CHECK(a.count == b.count);
            CHECK(map.header.dispersion[static_cast<size_t>(c)] == read.header.dispersion[static_cast<size_t>(c)]);
            CHECK(a.bounds.lo == b.bounds.lo);
            CHECK(a.bounds.hi == b.bounds.hi);
            CHECK((sameBytes(a.blocks, b.blocks) && sameBytes(a.nodes, b.nodes) && sameBytes(a.payload, b.payload)));
        }
        const double bytes = static_cast<double>(std::filesystem::file_size(file)) / static_cast<double>(count);
        MESSAGE(count << " photons, " << bytes << " bytes each");
        CHECK(bytes < 40);
        CHECK(read.header.seed == map.header.seed);
        CHECK(read.header.lights == map.header.lights);
        CHECK(read.header.objects == map.header.objects);
        CHECK(read.header.ranges == map.header.ranges);
        CHECK(read.header.emittedPaths() == 10'000);
        CHECK(read.header.ledger.columns == map.header.ledger.columns);
        CHECK(read.header.ledger.flux == map.header.ledger.flux);
        CHECK(read.header.ledger.maxAimWeight == map.header.ledger.maxAimWeight);
        query(read);
        const std::string bytesOnce = contentOf(file);
        writePhotonMap(file, read, run);
        CHECK(contentOf(file) == bytesOnce);
    }
}

TEST_CASE_FIXTURE(Fixture, "maps of no photons and of few are sound files") {
    for (const uint64_t paths : {0, 1, 2, 15, 20, 200}) {
        writePhotonMap(file, mapOf({0, paths}), run);
        CHECK(readingError().empty());
    }
    writePhotonMap(file, PhotonMap(), run);
    CHECK(readingError() != "");  // one that says not even what it stores
}

TEST_CASE_FIXTURE(Fixture, "merged shards are the bytes of the one emission, in any order") {
    for (const bool all : {false, true}) {
        writePhotonMap(file, mapOf({0, 10'000}, all), run);
        std::vector<std::filesystem::path> shards;
        uint64_t begin = 0;
        for (const uint64_t end : {1, 3000, 3001, 9000, 10'000}) {
            shards.push_back(folder / ("shard" + std::to_string(end)));
            writePhotonMap(shards.back(), mapOf({begin, end}, all), run);
            begin = end;
        }
        for (int rotation = 0; rotation < 5; ++rotation) {
            std::rotate(shards.begin(), shards.begin() + 2, shards.end());
            std::swap(shards[0], shards[1]);
            writePhotonMap(folder / "merged", mergePhotonMaps(shards, run), run);
            CHECK(contentOf(folder / "merged") == contentOf(file));
        }
        PhotonMap resumed = mergePhotonMaps(mapOf({4000, 10'000}, all), mapOf({0, 4000}, all), run);
        writePhotonMap(folder / "merged", resumed, run);
        CHECK(contentOf(folder / "merged") == contentOf(file));
    }
}

TEST_CASE_FIXTURE(Fixture, "of shards' dispersions the larger holds, in any order") {
    PhotonMap other = mapOf({100, 200});
    other.header.dispersion[1].at4TimesPowersOf2[0] = 1;
    other.header.dispersion[1].at4TimesPowersOf2[1] = 0;
    writePhotonMap(folder / "a", mapOf({0, 100}), run);
    writePhotonMap(folder / "b", other, run);
    Dispersion expected = mapOf({0, 100}).header.dispersion[1];
    expected.at4TimesPowersOf2[0] = 1;
    CHECK(mergePhotonMaps({folder / "a", folder / "b"}, run).header.dispersion[1] == expected);
    CHECK(mergePhotonMaps({folder / "b", folder / "a"}, run).header.dispersion[1] == expected);
}

TEST_CASE_FIXTURE(Fixture, "ranges with a gap stay apart until it is filled") {
    const PhotonMap ends = mergePhotonMaps(mapOf({0, 100}), mapOf({200, 300}), run);
    CHECK(ends.header.ranges == std::vector<IndexRange>{{0, 100}, {200, 300}});
    CHECK(ends.header.emittedPaths() == 200);
    writePhotonMap(file, ends, run);
    const PhotonMap whole = mergePhotonMaps(readPhotonMap(file, run), mapOf({100, 200}), run);
    CHECK(whole.header.ranges == std::vector<IndexRange>{{0, 300}});
}

TEST_CASE_FIXTURE(Fixture, "maps that do not belong together are not merged, and the message says why") {
    const auto error = [&](const std::function<void(MapHeader&)>& change, IndexRange range = {100, 200}) {
        writePhotonMap(folder / "a", mapOf({0, 100}), run);
        PhotonMap other = mapOf(range);
        change(other.header);
        writePhotonMap(folder / "b", other, run);
        std::string message = errorOf([&] { mergePhotonMaps({folder / "a", folder / "b"}, run); });
        if (!message.empty()) {
            CHECK(message.find((folder / "a").string()) != std::string::npos);
            CHECK(message.find((folder / "b").string()) != std::string::npos);
            CHECK(message.find('\n') == std::string::npos);
        }
        return message;
    };
    const auto contains = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    CHECK(error([](MapHeader&) {}).empty());
    CHECK(contains(error([](MapHeader& h) { h.sceneHash = "f"; }), "scene"));
    CHECK(contains(error([](MapHeader& h) { h.seed = 7; }), "seed 18446744073709551615, and 7"));
    CHECK(contains(error([](MapHeader& h) { h.totalPaths = 20'000; }), "paths"));
    CHECK(contains(error([](MapHeader& h) { h.maxDepth = 3; }), "depth"));
    CHECK(contains(error([](MapHeader& h) { h.aimed = false; }), "aimed"));
    CHECK(contains(error([](MapHeader& h) { h.lights[1] = "moon"; }), "light 1 the \"sun\", and moon"));
    CHECK(contains(error([](MapHeader& h) { h.objects[2] = "x"; }), "object 2"));
    CHECK(contains(error([](MapHeader&) {}, {99, 200}), "overlap: both hold light path 99"));
    CHECK(contains(error([](MapHeader&) {}, {0, 100}), "overlap: both hold light path 0"));
    CHECK_THROWS_AS(mergePhotonMaps(mapOf({0, 10}), mapOf({10, 20}, true), run), Error);
}

TEST_CASE_FIXTURE(Fixture, "a damaged file is refused") {
    writePhotonMap(file, mapOf({0, 300}), run);
    const std::string sound = contentOf(file);
    Random random(21);
    for (int i = 0; i < 300; ++i) {
        std::string damaged = sound;
        const size_t at = random.bits() % sound.size();
        if (i % 4 == 0)
            damaged.resize(at);
        else if (i % 4 == 1)
            damaged.insert(at, 1, static_cast<char>(random.bits()));
        else
            damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random.bits() % 8)));
        put(file, damaged);
        const std::string error = readingError();
        CAPTURE(i);
        REQUIRE(error.find(file.string()) == 0);
        REQUIRE(error.find('\n') == std::string::npos);
    }
}

TEST_CASE_FIXTURE(Fixture, "records that emission cannot have made are refused by name, sound checksums or not") {
    writePhotonMap(file, mapOf({0, 300}), run);
    const Sections sound(file);
    const auto error = [&](const std::function<void(Sections&)>& change) {
        Sections changed = sound;
        change(changed);
        changed.write(file);
        return readingError();
    };
    const auto contains = [](const std::string& text, const char* part) {
        INFO(text);
        return text.find(part) != std::string::npos;
    };
    CHECK(error([](Sections&) {}).empty());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(contains(error([&](Sections& s) { s.blocks[3].y[5] = nan; }),
                   "section \"caustic.blocks\": record 53: position"));
    CHECK(contains(error([&](Sections& s) { s.blocks[0].x[0] = kInfinity; }), "record 0"));
    CHECK(contains(error([](Sections& s) { s.blocks.back().x[15] = 0; }), "absent"));
    CHECK(
        contains(error([](Sections& s) { s.payload[7].light = 2; }), "section \"caustic.payload\": record 7: light 2"));
    CHECK(contains(error([](Sections& s) { s.payload[8].path = 3; }), "record 8: path"));
    CHECK(contains(error([](Sections& s) { s.payload[9].flags = 8; }), "record 9: flags"));
    CHECK(contains(error([](Sections& s) { s.blocks[3].y[5] += 1; }), "section \"caustic.nodes\""));
    CHECK(contains(error([](Sections& s) { s.nodes.back().loX[7] = 0; }), "section \"caustic.nodes\": record"));
    CHECK(contains(error([&](Sections& s) { s.nodes[0].hiZ[0] = nan; }), "section \"caustic.nodes\": record 0"));
    CHECK(contains(error([](Sections& s) { s.payload.pop_back(); }), "section \"caustic.payload\""));
    CHECK(contains(error([](Sections& s) { s.nodes.pop_back(); }), "section \"caustic.nodes\""));
    CHECK(contains(error([](Sections& s) { s.header += "x"; }), "section \"header\": is not JSON"));
}

TEST_CASE_FIXTURE(Fixture, "no change of a section leads a query out of its memory, sound checksums or not") {
    writePhotonMap(file, mapOf({0, 300}), run);
    const Sections sound(file);
    Random random(22);
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
        Sections s = sound;
        const std::span<std::byte> sections[] = {
            std::as_writable_bytes(std::span(s.header)), std::as_writable_bytes(std::span(s.nodes)),
            std::as_writable_bytes(std::span(s.blocks)), std::as_writable_bytes(std::span(s.payload))};
        const auto bytes = sections[i % 4];
        bytes[random.bits() % bytes.size()] ^= static_cast<std::byte>(1 << (random.bits() % 8));
        s.write(file);
        refused += readingError().empty() ? 0 : 1;
    }
    MESSAGE(refused << " of 300 refused");  // others are maps too: of another seed, power or direction
    CHECK(refused > 150);
}

TEST_CASE_FIXTURE(Fixture, "a header that is not one is refused by field") {
    writePhotonMap(file, mapOf({0, 300}), run);
    const Sections sound(file);
    const auto error = [&](const std::string& from, const std::string& to) {
        Sections s = sound;
        const size_t at = s.header.find(from);
        REQUIRE(at != std::string::npos);
        s.header.replace(at, from.size(), to);
        s.write(file);
        return readingError();
    };
    const auto contains = [](const std::string& text, const std::string& part) {
        INFO(text);
        return text.find("section \"header\": " + part) != std::string::npos;
    };
    CHECK(contains(error("\"seed\": 18446744073709551615", "\"seed\": -1"), "\"seed\": -1, expected"));
    CHECK(contains(error("\"seed\": 18446744073709551615", "\"seed\": 1.5"), "\"seed\": 1.5, expected"));
    CHECK(contains(error("\"seed\"", "\"sead\""), "\"seed\": missing"));
    CHECK(contains(error("\"maxDepth\": 64", "\"maxDepth\": 4294967296"), "\"maxDepth\""));
    CHECK(contains(error("\"store\": \"caustic\"", "\"store\": \"some\""), "\"store\": \"some\", expected"));
    CHECK(contains(error("\"aimed\": true", "\"aimed\": 1"), "\"aimed\""));
    CHECK(contains(error("   0.8", "   1.8"), "\"dispersion\": 1.8"));
    CHECK(contains(error("   1.0,", ""), "\"caustic\": 7 elements, expected 8"));
    CHECK(contains(error("W, m, linear", "W, ft, linear"), "\"units\""));
    CHECK(contains(error("\"lamp\"", "12"), "\"lights\": 12, expected a string"));
    CHECK(contains(error("\"lamp\",", ""), "\"emittedByLight\": 2 elements, expected 1"));
    CHECK(contains(error("   300", "   0"), "\"ranges\""));
    CHECK(contains(error("   300", "   10001"), "\"ranges\""));
    CHECK(contains(error("0000000000", "000000000"), "fixed-point number"));
    CHECK(!error("\"count\": ", "\"count\": 1").empty());
    CHECK(!error("\"count\": ", "\"count\": -").empty());
}
