// The one place that opens, maps and writes files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace lsde {

// Whole content of a regular file. Throws Error ("PATH: ..."), also beyond maxBytes, checked before allocation.
std::string readFile(const std::filesystem::path& path, uint64_t maxBytes);

// Throws Error "PATH: exists, ... --force" if the output exists and force is off; and, force or not, if it is no
// regular file (a folder, a pipe, a device), or if its folder does not exist or is not writable. To be called before
// the work starts, so that nobody waits for a refusal.
void checkOutput(const std::filesystem::path& path, bool force);

// Writes beside the target under a temporary name, fsyncs, renames; on any exception (disk full included) the temporary
// file is removed and the old file is untouched. What a killed process left behind is reused by the next writer of that
// target. A symbolic link stays, the file it names is replaced. Throws Error "PATH: cannot be written: REASON".
class AtomicFile {
  public:
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();  // removes the temporary file unless committed
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::span<const std::byte> bytes);  // at the end
    void writeAt(uint64_t offset, std::span<const std::byte> bytes);
    uint64_t size() const { return size_; }
    void commit();

  private:
    std::filesystem::path path_;                // as given, for messages
    std::filesystem::path target_, temporary_;  // symbolic links resolved
    int descriptor_ = -1;
    uint64_t size_ = 0;
};

void writeFileAtomically(const std::filesystem::path& path, std::string_view content);

// A regular file mapped read-only; an empty one has no bytes. Throws Error ("PATH: ...").
class MappedFile {
  public:
    explicit MappedFile(const std::filesystem::path& path);
    ~MappedFile();
    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&& other) noexcept;

    std::span<const std::byte> bytes() const;
    const std::filesystem::path& path() const;
    // From now on, here and there: where memory is short, what is read is no more than what is asked for.
    void expectLookups() const;

  private:
    struct Mapping;
    std::unique_ptr<const Mapping> mapping_;
};

// A file cut while it is mapped must not kill the process by SIGBUS: installs a handler that prints one line naming the
// file and exits with 1 when a fault hits a mapped file. Any other SIGBUS goes to the handler there was before.
void guardMappedFiles();

}  // namespace lsde
