// A checked container: named sections of bytes in one little-endian file, page-aligned, to be mapped and used as they
// are.
//
// Layout: a header of one page (magic "LSDECONT", container version, kind and its version, file length, offset of the
// tables, their XXH3-64, and that of the header itself); the sections, each at a multiple of 4096, padded with zeros;
// the tables: name, offset, length and element size of each section, then the XXH3-64 of each MiB between header and
// tables. Every byte of the file is covered by a check: any flipped bit, cut or appended byte is refused. The bytes
// depend on kind and sections only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lsde {

struct ContainerKind {
    std::string_view name;  // at most 8 bytes, e.g. "photons"
    uint32_t version = 1;
};

class ContainerWriter {
  public:
    ContainerWriter(const std::filesystem::path& path, ContainerKind kind);
    ~ContainerWriter();  // leaves no file unless committed

    // Sections are written in the order of the calls; names are unique, at most 24 bytes. elementSize is recorded and
    // checked on reading. Throws Error as AtomicFile does.
    template <typename T>
    void section(std::string_view name, std::span<const T> elements) {
        static_assert(std::is_trivially_copyable_v<T>);
        beginSection(name, sizeof(T));
        append(std::as_bytes(elements));
        endSection();
    }
    // The same in pieces, for sections larger than memory.
    void beginSection(std::string_view name, uint32_t elementSize);
    void append(std::span<const std::byte> bytes);
    void endSection();

    void commit();  // tables, checksums, fsync, rename

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

class ContainerReader {
  public:
    // Maps the file; checks magic, versions, recorded length against the file's, header and tables (offsets in range,
    // in order, page-aligned, no overflow) before anything else is touched. Throws Error "PATH: ..." that says what is
    // wrong: not a container, another kind, another version (which), truncated (bytes there / expected), header or
    // tables damaged.
    ContainerReader(const std::filesystem::path& path, ContainerKind kind);
    ~ContainerReader();
    ContainerReader(ContainerReader&&) noexcept;

    // Checks every chunk and all padding; `forEach(n, f)` runs f(0..n-1), perhaps in parallel. Throws Error naming
    // sections and byte range of the first damaged chunk (the lowest, whatever the threads).
    using ForEach = std::function<void(size_t, const std::function<void(size_t)>&)>;
    void verify(const ForEach& forEach = {}) const;

    bool has(std::string_view name) const;
    // Throws Error naming the section if it is missing or its element size is not sizeof(T).
    template <typename T>
    std::span<const T> section(std::string_view name) const {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto bytes = sectionBytes(name, sizeof(T));
        return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
    }
    std::vector<std::string> sectionNames() const;
    uint64_t fileBytes() const;
    void expectLookups() const;  // MappedFile's
    const std::filesystem::path& path() const;

  private:
    std::span<const std::byte> sectionBytes(std::string_view name, uint32_t elementSize) const;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lsde
