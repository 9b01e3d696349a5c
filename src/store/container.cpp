#include "store/container.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstring>
#include <set>
#include <utility>

#include "base/error.h"
#include "store/file.h"

namespace lsde {

namespace {

static_assert(std::endian::native == std::endian::little, "the file's numbers are little-endian, and used as they are");

constexpr uint64_t kPage = 4096;
constexpr uint64_t kChunk = uint64_t{1} << 20;  // bytes under one checksum
constexpr uint32_t kContainerVersion = 1;
constexpr std::array<char, 8> kMagic = {'L', 'S', 'D', 'E', 'C', 'O', 'N', 'T'};

// Magic and container version keep their place in every version.
struct Header {
    std::array<char, 8> magic = kMagic;
    uint32_t containerVersion = kContainerVersion;
    uint32_t kindVersion = 0;
    std::array<char, 8> kind{};
    uint64_t fileBytes = 0;
    uint64_t tablesOffset = 0;  // up to the end of the file
    uint64_t sectionCount = 0;
    uint64_t tablesHash = 0;
    std::array<std::byte, 4032> zero{};
    uint64_t headerHash = 0;  // of all the bytes before
};
static_assert(sizeof(Header) == kPage && std::is_trivially_copyable_v<Header>);

struct SectionEntry {
    std::array<char, 24> name{};
    uint64_t offset = 0;
    uint64_t bytes = 0;
    uint64_t elementSize = 0;
    uint64_t end() const { return offset + bytes; }
};
static_assert(sizeof(SectionEntry) == 48 && std::is_trivially_copyable_v<SectionEntry>);

uint64_t hashOf(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

uint64_t hashOf(const Header& header) {
    return hashOf(std::as_bytes(std::span(&header, 1)).first(offsetof(Header, headerHash)));
}

constexpr uint64_t pageAligned(uint64_t offset) { return (offset + kPage - 1) / kPage * kPage; }

constexpr uint64_t chunkCount(uint64_t tablesOffset) { return (tablesOffset - kPage + kChunk - 1) / kChunk; }

// Fixed-size names are padded with zeros, and have no terminator at full length.
template <size_t N>
std::array<char, N> padded(std::string_view name) {
    LSDE_ASSERT(!name.empty() && name.size() <= N);
    std::array<char, N> out{};
    std::copy_n(name.begin(), std::min(name.size(), N), out.begin());
    return out;
}

bool allZero(std::span<const std::byte> bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

template <size_t N>
std::string_view unpadded(const std::array<char, N>& name) {
    return {name.data(), static_cast<size_t>(std::find(name.begin(), name.end(), '\0') - name.begin())};
}

}  // namespace

// --------------------------------------------------------------------------------------------------------------
// writing

struct ContainerWriter::Impl {
    Impl(const std::filesystem::path& path, ContainerKind kind) : file(path) {
        header.kind = padded<8>(kind.name);
        header.kindVersion = kind.version;
        chunk.reserve(kChunk);
    }

    uint64_t offset() const { return file.size() + chunk.size(); }

    void put(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const auto piece = bytes.first(std::min<size_t>(bytes.size(), kChunk - chunk.size()));
            chunk.insert(chunk.end(), piece.begin(), piece.end());
            bytes = bytes.subspan(piece.size());
            if (chunk.size() == kChunk) flushChunk();
        }
    }

    void flushChunk() {
        if (chunk.empty()) return;
        chunkHashes.push_back(hashOf(chunk));
        file.write(chunk);
        chunk.clear();
    }

    AtomicFile file;
    Header header;
    std::vector<SectionEntry> sections;
    std::vector<uint64_t> chunkHashes;
    std::vector<std::byte> chunk;  // what is not written yet
    bool inSection = false;
};

ContainerWriter::ContainerWriter(const std::filesystem::path& path, ContainerKind kind)
    : impl_(std::make_unique<Impl>(path, kind)) {
    impl_->file.write(std::vector<std::byte>(kPage));  // for the header, whose content is known at the end
}

ContainerWriter::~ContainerWriter() = default;

void ContainerWriter::beginSection(std::string_view name, uint32_t elementSize) {
    LSDE_ASSERT(!impl_->inSection && elementSize > 0);
    const auto entryName = padded<24>(name);
    LSDE_ASSERT(std::none_of(impl_->sections.begin(), impl_->sections.end(),
                             [&](const SectionEntry& s) { return s.name == entryName; }));
    impl_->sections.push_back({entryName, impl_->offset(), 0, elementSize});
    impl_->inSection = true;
}

void ContainerWriter::append(std::span<const std::byte> bytes) {
    LSDE_ASSERT(impl_->inSection);
    impl_->put(bytes);
    impl_->sections.back().bytes += bytes.size();
}

void ContainerWriter::endSection() {
    LSDE_ASSERT(impl_->inSection && impl_->sections.back().bytes % impl_->sections.back().elementSize == 0);
    impl_->put(std::vector<std::byte>(pageAligned(impl_->offset()) - impl_->offset()));
    impl_->inSection = false;
}

void ContainerWriter::commit() {
    LSDE_ASSERT(!impl_->inSection);
    Impl& w = *impl_;
    w.flushChunk();
    std::vector<std::byte> tables;
    for (const auto part : {std::as_bytes(std::span(w.sections)), std::as_bytes(std::span(w.chunkHashes))})
        tables.insert(tables.end(), part.begin(), part.end());
    w.header.tablesOffset = w.file.size();
    w.header.fileBytes = w.file.size() + tables.size();
    w.header.sectionCount = w.sections.size();
    w.header.tablesHash = hashOf(tables);
    w.header.headerHash = hashOf(w.header);
    w.file.write(tables);
    w.file.writeAt(0, std::as_bytes(std::span(&w.header, 1)));
    w.file.commit();
}

// --------------------------------------------------------------------------------------------------------------
// reading

struct ContainerReader::Impl {
    Impl(const std::filesystem::path& path, ContainerKind kind) : file(path) {
        readHeader();
        checkKind(kind);
        readTables();
    }

    [[noreturn]] void fail(std::string_view what) const {
        throw Error(fmt::format("{}: {}", file.path().string(), what));
    }

    void readHeader();
    void checkKind(ContainerKind kind) const;
    void readTables();
    void checkSections() const;
    std::span<const std::byte> chunk(size_t index) const;
    std::string sectionsIn(uint64_t begin, uint64_t end) const;
    void checkPadding() const;
    const SectionEntry* find(std::string_view name) const;

    MappedFile file;
    Header header;
    std::vector<SectionEntry> sections;
    std::vector<uint64_t> chunkHashes;
};

void ContainerReader::Impl::readHeader() {
    const auto bytes = file.bytes();
    if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        fail(bytes.empty() ? "is empty, expected a container of lsde" : "is not a container of lsde");
    if (bytes.size() < kPage) fail(fmt::format("truncated: {} bytes, expected at least {}", bytes.size(), kPage));
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.containerVersion != kContainerVersion)
        fail(fmt::format("container version {}, expected {}", header.containerVersion, kContainerVersion));
    if (header.headerHash != hashOf(header)) fail("header damaged: its checksum differs");
    if (!allZero(header.zero)) fail("header damaged: its padding is not zero");
    if (bytes.size() < header.fileBytes)
        fail(fmt::format("truncated: {} bytes, expected {}", bytes.size(), header.fileBytes));
    if (bytes.size() > header.fileBytes)
        fail(fmt::format("{} bytes, expected {}: something is appended", bytes.size(), header.fileBytes));
}

void ContainerReader::Impl::checkKind(ContainerKind kind) const {
    if (header.kind != padded<8>(kind.name))
        fail(fmt::format("holds \"{}\", expected \"{}\"", unpadded(header.kind), kind.name));
    if (header.kindVersion != kind.version)
        fail(fmt::format("version {} of \"{}\", expected {}{}", header.kindVersion, kind.name, kind.version,
                         header.kindVersion > kind.version ? ": written by a newer lsde" : ""));
}

void ContainerReader::Impl::readTables() {
    const uint64_t offset = header.tablesOffset;
    const uint64_t bytes = header.fileBytes;
    if (offset < kPage || offset > bytes || offset % kPage != 0 || header.sectionCount > bytes / sizeof(SectionEntry) ||
        bytes - offset != header.sectionCount * sizeof(SectionEntry) + chunkCount(offset) * sizeof(uint64_t))
        fail("header damaged: its counts do not fit the file's length");
    const auto tables = file.bytes().subspan(offset);
    if (header.tablesHash != hashOf(tables)) fail("tables damaged: their checksum differs");
    sections.resize(header.sectionCount);
    chunkHashes.resize(chunkCount(offset));
    const auto split = std::as_writable_bytes(std::span(sections));
    std::copy_n(tables.begin(), split.size(), split.begin());
    std::copy(tables.begin() + static_cast<ptrdiff_t>(split.size()), tables.end(),
              std::as_writable_bytes(std::span(chunkHashes)).begin());
    checkSections();
}

// The writer's layout is the only one allowed: each section at the first page after the one before.
void ContainerReader::Impl::checkSections() const {
    uint64_t expected = kPage;
    std::set<std::string_view> names;
    for (const SectionEntry& s : sections) {
        const std::string_view name = unpadded(s.name);
        const bool named = !name.empty() && padded<24>(name) == s.name && names.insert(name).second;
        const bool placed = s.offset == expected && s.bytes <= header.tablesOffset - s.offset;
        if (!named || !placed || s.elementSize == 0 || s.bytes % s.elementSize != 0)
            fail(fmt::format("section table damaged at \"{}\"", name));
        expected = pageAligned(s.end());
    }
    if (expected != header.tablesOffset) fail("section table damaged: it does not fill the file");
}

std::span<const std::byte> ContainerReader::Impl::chunk(size_t index) const {
    const uint64_t begin = kPage + index * kChunk;
    return file.bytes().subspan(begin, std::min(kChunk, header.tablesOffset - begin));
}

std::string ContainerReader::Impl::sectionsIn(uint64_t begin, uint64_t end) const {
    std::string names;
    for (const SectionEntry& s : sections)
        if (s.bytes > 0 && s.offset < end && pageAligned(s.end()) > begin)
            names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", unpadded(s.name));
    return names;
}

void ContainerReader::Impl::checkPadding() const {
    for (const SectionEntry& s : sections) {
        const auto padding = file.bytes().subspan(s.end(), pageAligned(s.end()) - s.end());
        if (!allZero(padding)) fail(fmt::format("section \"{}\": the padding after it is not zero", unpadded(s.name)));
    }
}

const SectionEntry* ContainerReader::Impl::find(std::string_view name) const {
    const auto it =
        std::find_if(sections.begin(), sections.end(), [&](const SectionEntry& s) { return unpadded(s.name) == name; });
    return it == sections.end() ? nullptr : &*it;
}

ContainerReader::ContainerReader(const std::filesystem::path& path, ContainerKind kind)
    : impl_(std::make_unique<Impl>(path, kind)) {}
ContainerReader::~ContainerReader() = default;
ContainerReader::ContainerReader(ContainerReader&&) noexcept = default;

void ContainerReader::verify(const ForEach& forEach) const {
    const size_t chunks = impl_->chunkHashes.size();
    std::atomic<size_t> firstDamaged = chunks;
    const std::function<void(size_t)> check = [&](size_t i) {
        if (hashOf(impl_->chunk(i)) == impl_->chunkHashes[i]) return;
        size_t first = firstDamaged;
        while (i < first && !firstDamaged.compare_exchange_weak(first, i)) {
        }
    };
    if (forEach)
        forEach(chunks, check);
    else
        for (size_t i = 0; i < chunks; ++i) check(i);
    if (firstDamaged < chunks) {
        const uint64_t begin = kPage + firstDamaged * kChunk;
        const uint64_t end = begin + impl_->chunk(firstDamaged).size();
        impl_->fail(
            fmt::format("section {}: damaged in bytes {} to {}", impl_->sectionsIn(begin, end), begin, end - 1));
    }
    impl_->checkPadding();
}

bool ContainerReader::has(std::string_view name) const { return impl_->find(name) != nullptr; }

std::vector<std::string> ContainerReader::sectionNames() const {
    std::vector<std::string> names;
    for (const SectionEntry& s : impl_->sections) names.emplace_back(unpadded(s.name));
    return names;
}

uint64_t ContainerReader::fileBytes() const { return impl_->header.fileBytes; }
void ContainerReader::expectLookups() const { impl_->file.expectLookups(); }
const std::filesystem::path& ContainerReader::path() const { return impl_->file.path(); }

std::span<const std::byte> ContainerReader::sectionBytes(std::string_view name, uint32_t elementSize) const {
    const SectionEntry* s = impl_->find(name);
    if (s == nullptr) impl_->fail(fmt::format("section \"{}\" is missing", name));
    if (s->elementSize != elementSize)
        impl_->fail(
            fmt::format("section \"{}\": elements of {} bytes, expected {}", name, s->elementSize, elementSize));
    return impl_->file.bytes().subspan(s->offset, s->bytes);
}

}  // namespace lsde
