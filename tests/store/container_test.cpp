#include "store/container.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>
#include <thread>

#include "store/fixture.h"

namespace fs = std::filesystem;
using namespace lsde;
using test::contentOf;
using test::errorOf;
using test::TemporaryFolder;

namespace {

constexpr ContainerKind kKind{"numbers", 3};
constexpr size_t kPage = 4096;

struct Triple {
    float x, y, z;
    bool operator==(const Triple&) const = default;
};

std::vector<uint8_t> randomBytes(size_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<uint8_t> bytes(count);
    for (uint8_t& b : bytes) b = static_cast<uint8_t>(random());
    return bytes;
}

const std::vector<Triple> kTriples(345, Triple{1.0F, -2.5F, 1e30F});

// Five sections of odd sizes, one of them empty: 5 pages and the tables.
void writeSmall(const fs::path& path) {
    ContainerWriter writer(path, kKind);
    writer.section("json", std::span(kTriples).first(1));
    writer.section("empty", std::span<const uint64_t>());
    writer.section("triples", std::span(kTriples));
    writer.section("one page exactly", std::span<const uint8_t>(randomBytes(kPage, 1)));
    writer.section("a name of 24 characters.", std::span<const uint8_t>(randomBytes(1, 2)));
    writer.commit();
}

void checkWhole(const fs::path& path) { ContainerReader(path, kKind).verify(); }

// Where the numbers are in the file's header.
constexpr size_t kTablesOffset = 32;
constexpr size_t kTablesHash = 48;

uint64_t wordAt(const std::string& file, size_t offset) {
    uint64_t word = 0;
    std::memcpy(&word, &file[offset], sizeof word);
    return word;
}

// Put a number into the header, or into the tables, and make the checksums right again, as somebody with bad intent
// would.
void forgeHeader(std::string& file, size_t offset, uint64_t value) {
    std::memcpy(&file[offset], &value, sizeof value);
    const uint64_t hash = XXH3_64bits(file.data(), kPage - 8);
    std::memcpy(&file[kPage - 8], &hash, sizeof hash);
}
void forgeTables(std::string& file, size_t offset, uint64_t value) {
    const uint64_t tables = wordAt(file, kTablesOffset);
    std::memcpy(&file[tables + offset], &value, sizeof value);
    forgeHeader(file, kTablesHash, XXH3_64bits(&file[tables], file.size() - tables));
}

}  // namespace

TEST_CASE("sections come back as they were written") {
    const TemporaryFolder folder;
    writeSmall(folder / "file");
    const ContainerReader reader(folder / "file", kKind);
    reader.verify();
    CHECK(reader.sectionNames() ==
          std::vector<std::string>{"json", "empty", "triples", "one page exactly", "a name of 24 characters."});
    const auto triples = reader.section<Triple>("triples");
    CHECK(std::equal(triples.begin(), triples.end(), kTriples.begin(), kTriples.end()));
    CHECK(reader.section<uint64_t>("empty").empty());
    const auto page = reader.section<uint8_t>("one page exactly");
    CHECK(std::vector(page.begin(), page.end()) == randomBytes(kPage, 1));
    CHECK(reader.has("json"));
    CHECK_FALSE(reader.has("jso"));
    CHECK(reader.fileBytes() == fs::file_size(folder / "file"));
    CHECK(reinterpret_cast<uintptr_t>(triples.data()) % kPage == 0);
}

TEST_CASE("a container without sections is sound") {
    const TemporaryFolder folder;
    ContainerWriter(folder / "file", kKind).commit();
    checkWhole(folder / "file");
    CHECK(fs::file_size(folder / "file") == kPage);
}

TEST_CASE("the same sections give the same bytes, in pieces or whole") {
    const TemporaryFolder folder;
    const std::vector<uint8_t> bytes = randomBytes((3 << 20) + 17, 3);
    ContainerWriter whole(folder / "whole", kKind);
    whole.section("bytes", std::span(bytes));
    whole.commit();
    ContainerWriter pieces(folder / "pieces", kKind);
    pieces.beginSection("bytes", 1);
    for (size_t at = 0, size = 1; at < bytes.size(); at += size, size = 7 * size + 5)
        pieces.append(std::as_bytes(std::span(bytes).subspan(at, std::min(size, bytes.size() - at))));
    pieces.endSection();
    pieces.commit();
    CHECK(contentOf(folder / "whole") == contentOf(folder / "pieces"));
}

TEST_CASE("a container that is not committed leaves no file") {
    const TemporaryFolder folder;
    ContainerWriter(folder / "file", kKind).section("triples", std::span(kTriples));
    CHECK(folder.names().empty());
}

TEST_CASE("a flipped bit in any byte is refused") {
    const TemporaryFolder folder;
    writeSmall(folder / "file");
    const std::string sound = contentOf(folder / "file");
    std::fstream file(folder / "file", std::ios::in | std::ios::out | std::ios::binary);
    std::mt19937 random(4);
    const auto putByte = [&](size_t at, char byte) {
        file.seekp(static_cast<std::streamoff>(at));
        file.put(byte);
        file.flush();
    };
    size_t accepted = 0;
    for (size_t at = 0; at < sound.size(); ++at) {
        putByte(at, static_cast<char>(sound[at] ^ (1 << random() % 8)));
        accepted += errorOf([&] { checkWhole(folder / "file"); }).empty() ? 1 : 0;
        putByte(at, sound[at]);
    }
    CHECK(accepted == 0);
    checkWhole(folder / "file");
    MESSAGE(sound.size(), " bytes, each flipped in one bit");
}

TEST_CASE("blocks of 64 bytes in each other's place are refused") {
    const TemporaryFolder folder;
    writeSmall(folder / "file");
    const std::string sound = contentOf(folder / "file");
    std::mt19937 random(5);
    std::uniform_int_distribution<size_t> block(0, sound.size() / 64 - 1);
    int swapped = 0;
    while (swapped < 300) {
        const size_t a = 64 * block(random);
        const size_t b = 64 * block(random);
        if (sound.compare(a, 64, sound, b, 64) == 0) continue;
        std::string damaged = sound;
        std::swap_ranges(&damaged[a], &damaged[a] + 64, &damaged[b]);
        test::put(folder / "file", damaged);
        CHECK_MESSAGE(!errorOf([&] { checkWhole(folder / "file"); }).empty(), "blocks at ", a, " and ", b);
        ++swapped;
    }
}

TEST_CASE("a cut or lengthened file is refused with both lengths") {
    const TemporaryFolder folder;
    writeSmall(folder / "file");
    const std::string sound = contentOf(folder / "file");
    const std::string path = (folder / "file").string();
    for (size_t bytes = 8; bytes < sound.size(); bytes += 37) {
        test::put(folder / "file", sound.substr(0, bytes));
        const std::string expected = bytes < kPage ? "at least 4096" : std::to_string(sound.size());
        CHECK(errorOf([&] { checkWhole(folder / "file"); }) ==
              fmt::format("{}: truncated: {} bytes, expected {}", path, bytes, expected));
    }
    for (const size_t extra : {1, 8, 4096}) {
        test::put(folder / "file", sound + std::string(extra, '\0'));
        CHECK(
            errorOf([&] { checkWhole(folder / "file"); }) ==
            fmt::format("{}: {} bytes, expected {}: something is appended", path, sound.size() + extra, sound.size()));
    }
}

TEST_CASE("a file of another kind or version is refused by what it is") {
    const TemporaryFolder folder;
    const std::string path = (folder / "file").string();
    const auto refusal = [&] { return errorOf([&] { ContainerReader(folder / "file", kKind); }); };
    CHECK(refusal() == path + ": cannot be opened: No such file or directory");
    test::put(folder / "file", "");
    CHECK(refusal() == path + ": is empty, expected a container of lsde");
    for (const std::string& foreign : {std::string("LSDE"), std::string(10000, 'x'), std::string("{\"asset\": 1}")}) {
        test::put(folder / "file", foreign);
        CHECK(refusal() == path + ": is not a container of lsde");
    }
    ContainerWriter(folder / "file", {"picture", 3}).commit();
    CHECK(refusal() == path + ": holds \"picture\", expected \"numbers\"");
    ContainerWriter(folder / "file", {"numbers", 4}).commit();
    CHECK(refusal() == path + ": version 4 of \"numbers\", expected 3: written by a newer lsde");
    ContainerWriter(folder / "file", {"numbers", 2}).commit();
    CHECK(refusal() == path + ": version 2 of \"numbers\", expected 3");
    std::string newer = contentOf(folder / "file");
    newer[8] = 2;
    test::put(folder / "file", newer);
    CHECK(refusal() == path + ": container version 2, expected 1");
    CHECK(errorOf([&] { ContainerReader(folder.path(), kKind); }).ends_with(": is a folder, expected a file"));
}

TEST_CASE("a missing section or one of another element size is refused by name") {
    const TemporaryFolder folder;
    writeSmall(folder / "file");
    const ContainerReader reader(folder / "file", kKind);
    const std::string path = (folder / "file").string();
    CHECK(errorOf([&] { reader.section<float>("tree"); }) == path + ": section \"tree\" is missing");
    CHECK(errorOf([&] { reader.section<float>("triples"); }) ==
          path + ": section \"triples\": elements of 12 bytes, expected 4");
}

TEST_CASE("forged numbers with a right checksum reach no memory outside the file") {
    const TemporaryFolder folder;
    writeSmall(folder / "file");
    const std::string sound = contentOf(folder / "file");
    const std::vector<uint64_t> values = {
        0, 1, 4095, 4096, 1 << 20, uint64_t{1} << 60, ~uint64_t{0}, ~uint64_t{0} - 4095};
    // Kind, length, place of the tables, number of sections.
    for (const size_t field : {16, 24, 32, 40})
        for (const uint64_t value : values) {
            std::string forged = sound;
            forgeHeader(forged, field, value);
            if (forged == sound) continue;
            test::put(folder / "file", forged);
            CHECK_MESSAGE(!errorOf([&] { checkWhole(folder / "file"); }).empty(), "header byte ", field, ": ", value);
        }
    // Name, place, length and element size of the first and the third section.
    for (const size_t field : {0, 16, 24, 32, 40, 96, 120, 128, 136})
        for (const uint64_t value : values) {
            std::string forged = sound;
            forgeTables(forged, field, value);
            if (forged == sound) continue;
            test::put(folder / "file", forged);
            CHECK_MESSAGE(!errorOf([&] {
                               const ContainerReader reader(folder / "file", kKind);
                               reader.verify();
                               reader.section<Triple>("json");
                               reader.section<Triple>("triples");
                           }).empty(),
                          "section table byte ", field, ": ", value);
        }
}

TEST_CASE("a section whose end wraps around is refused") {
    const TemporaryFolder folder;
    ContainerWriter writer(folder / "file", kKind);
    writer.section("first", std::span<const uint8_t>(randomBytes(kPage, 10)));
    writer.section("second", std::span<const uint8_t>(randomBytes(kPage, 11)));
    writer.commit();
    std::string forged = contentOf(folder / "file");
    constexpr size_t kEntry = 48;                       // name 24, offset 8, bytes 8, element size 8
    forgeTables(forged, 32, ~uint64_t{0} - kPage + 1);  // from the first page to byte 0
    forgeTables(forged, kEntry + 24, 0);
    forgeTables(forged, kEntry + 32, wordAt(forged, kTablesOffset));
    test::put(folder / "file", forged);
    CHECK(errorOf([&] { checkWhole(folder / "file"); }) ==
          (folder / "file").string() + ": section table damaged at \"first\"");
}

TEST_CASE("padding that is not zero is refused even with right checksums") {
    const TemporaryFolder folder;
    ContainerWriter writer(folder / "file", kKind);
    writer.section("short", std::span<const uint8_t>(randomBytes(10, 6)));
    writer.commit();
    std::string forged = contentOf(folder / "file");
    forged[kPage + 10] = 1;
    forgeTables(forged, 48, XXH3_64bits(&forged[kPage], kPage));  // the checksum after the one entry
    test::put(folder / "file", forged);
    CHECK(errorOf([&] { checkWhole(folder / "file"); }) ==
          (folder / "file").string() + ": section \"short\": the padding after it is not zero");
}

TEST_CASE("the lowest damaged chunk is named, whatever the order of checking") {
    const TemporaryFolder folder;
    ContainerWriter writer(folder / "file", kKind);
    writer.section("first", std::span<const uint8_t>(randomBytes(1 << 20, 7)));
    writer.section("second", std::span<const uint8_t>(randomBytes(3 << 20, 8)));
    writer.section("third", std::span<const uint8_t>(randomBytes(100, 9)));
    writer.commit();
    std::string damaged = contentOf(folder / "file");
    for (const size_t at : {kPage + (3 << 20), kPage + (2 << 20) + 5})
        damaged[at] = static_cast<char>(damaged[at] ^ 64);
    test::put(folder / "file", damaged);
    const ContainerReader reader(folder / "file", kKind);
    const std::string expected =
        (folder / "file").string() + ": section \"second\": damaged in bytes 2101248 to 3149823";
    CHECK(errorOf([&] { reader.verify(); }) == expected);
    const auto backwards = [](size_t n, const std::function<void(size_t)>& check) {
        while (n > 0) check(--n);
    };
    CHECK(errorOf([&] { reader.verify(backwards); }) == expected);
    const auto threads = [](size_t n, const std::function<void(size_t)>& check) {
        std::vector<std::jthread> all;
        for (size_t i = 0; i < n; ++i) all.emplace_back([&check, i] { check(i); });
    };
    CHECK(errorOf([&] { reader.verify(threads); }) == expected);
}
