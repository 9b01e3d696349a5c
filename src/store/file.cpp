#include "store/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace lsde {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, std::string_view what) {
    throw Error(fmt::format("{}: {}", path.string(), what));
}

// With the reason that errno holds.
[[noreturn]] void failErrno(const fs::path& path, std::string_view what) {
    const int reason = errno;
    fail(path, fmt::format("{}: {}", what, std::generic_category().message(reason)));
}

// Empty for a regular file.
std::string_view notRegular(mode_t mode) {
    if (S_ISREG(mode)) return {};
    if (S_ISDIR(mode)) return "is a folder";
    if (S_ISFIFO(mode)) return "is a pipe";
    return S_ISSOCK(mode) ? "is a socket" : "is a device";
}

class Descriptor {
  public:
    explicit Descriptor(int value) : value_(value) {}
    ~Descriptor() {
        if (value_ >= 0) ::close(value_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return value_; }
    int release() { return std::exchange(value_, -1); }

  private:
    int value_;
};

struct InputFile {
    Descriptor descriptor;
    uint64_t bytes;
};

InputFile openInput(const fs::path& path) {
    // O_NONBLOCK: to open a pipe without a writer must not wait.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat status {};
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0) failErrno(path, "cannot be opened");
    if (const auto kind = notRegular(status.st_mode); !kind.empty())
        fail(path, fmt::format("{}, expected a file", kind));
    return {Descriptor(file.release()), static_cast<uint64_t>(status.st_size)};
}

fs::path folderOf(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

// Does something bear this name? Throws Error if that cannot be replaced by a file.
bool outputExists(const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) {
        if (errno == ENOENT && path.has_filename()) return false;
        failErrno(path, "cannot be written");
    }
    if (const auto kind = notRegular(status.st_mode); !kind.empty())
        fail(path, fmt::format("{}, expected a new name or a regular file, which is replaced as a whole", kind));
    return true;
}

void writeAll(int descriptor, const fs::path& path, uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) failErrno(path, "cannot be written");
        offset += static_cast<uint64_t>(written);
        bytes = bytes.subspan(static_cast<size_t>(written));
    }
}

// Takes over a temporary file that a killed process left behind. -1 if it is another's: in use (locked), of another
// user, or no plain file.
int adoptTemporary(const fs::path& temporary) {
    Descriptor file(::open(temporary.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    if (file.get() < 0 || ::flock(file.get(), LOCK_EX | LOCK_NB) != 0) return -1;
    struct stat own {};
    struct stat named {};
    // Before the lock was ours, its owner may have renamed the file to be the target.
    const bool same = ::fstat(file.get(), &own) == 0 && ::lstat(temporary.c_str(), &named) == 0 &&
                      own.st_ino == named.st_ino && own.st_dev == named.st_dev;
    if (!same || !S_ISREG(own.st_mode) || own.st_nlink != 1 || own.st_uid != ::geteuid()) return -1;
    return ::ftruncate(file.get(), 0) == 0 ? file.release() : -1;
}

// A new file, locked for as long as it is open. -1 if the name is taken or has just been adopted; throws Error if the
// folder takes no file.
int createTemporary(const fs::path& temporary, const fs::path& path) {
    Descriptor file(::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.get() < 0) {
        if (errno == EEXIST) return -1;
        failErrno(path, "cannot be written");
    }
    // Where the file system has no locks, nobody can adopt the file either.
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return -1;
    return file.release();
}

void syncFolder(const fs::path& folder, const fs::path& path) {
    const Descriptor file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (file.get() < 0) return;  // one may write into a folder without the right to read it
    // Some network file systems cannot sync a folder, and say so by EINVAL.
    if (::fsync(file.get()) != 0 && errno != EINVAL) failErrno(path, "cannot be written");
}

}  // namespace

std::string readFile(const fs::path& path, uint64_t maxBytes) {
    const InputFile file = openInput(path);
    if (file.bytes > maxBytes) fail(path, fmt::format("{} bytes, expected at most {}", file.bytes, maxBytes));
    std::string content(file.bytes, '\0');
    size_t done = 0;
    while (done < content.size()) {
        const ssize_t n = ::read(file.descriptor.get(), content.data() + done, content.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) failErrno(path, "cannot be read");
        if (n == 0) fail(path, fmt::format("was cut while being read, at byte {} of {}", done, content.size()));
        done += static_cast<size_t>(n);
    }
    return content;
}

void checkOutput(const fs::path& path, bool force) {
    if (outputExists(path) && !force) fail(path, "exists, and is overwritten only with --force");
    const fs::path folder = folderOf(path);
    if (!fs::is_directory(folder)) fail(path, fmt::format("folder {} does not exist", folder.string()));
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        fail(path, fmt::format("folder {} is not writable", folder.string()));
}

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
    target_ = outputExists(path_) ? fs::canonical(path_) : path_;
    // A part of the name that leaves room for the rest within the 255 bytes of a file name.
    const std::string name = target_.filename().string().substr(0, 230);
    for (int i = 0; descriptor_ < 0; ++i) {
        temporary_ = folderOf(target_) / fmt::format(".{}.tmp.{}", name, i);
        descriptor_ = createTemporary(temporary_, path_);
        if (descriptor_ < 0) descriptor_ = adoptTemporary(temporary_);
    }
}

AtomicFile::~AtomicFile() {
    if (descriptor_ < 0) return;
    ::unlink(temporary_.c_str());
    ::close(descriptor_);
}

void AtomicFile::write(std::span<const std::byte> bytes) {
    writeAll(descriptor_, path_, size_, bytes);
    size_ += bytes.size();
}

void AtomicFile::writeAt(uint64_t offset, std::span<const std::byte> bytes) {
    writeAll(descriptor_, path_, offset, bytes);
    size_ = std::max(size_, offset + bytes.size());
}

void AtomicFile::commit() {
    if (::fsync(descriptor_) != 0 || ::rename(temporary_.c_str(), target_.c_str()) != 0)
        failErrno(path_, "cannot be written");
    ::close(std::exchange(descriptor_, -1));
    syncFolder(folderOf(target_), path_);
}

void writeFileAtomically(const fs::path& path, std::string_view content) {
    AtomicFile file(path);
    file.write(std::as_bytes(std::span(content)));
    file.commit();
}

namespace {

struct GuardedRange {
    const std::byte* begin = nullptr;
    size_t bytes = 0;
    std::string message;  // made beforehand: a signal handler may not allocate
};

// The files mapped at present. Global because a signal handler has no other way to them; atomic because it may run at
// any time. The system's own limit is 65530 mappings.
std::array<std::atomic<const GuardedRange*>, 4096> guardedRanges;
struct sigaction previousAction {};

bool guard(const GuardedRange& range) {
    for (auto& slot : guardedRanges) {
        const GuardedRange* empty = nullptr;
        if (slot.compare_exchange_strong(empty, &range)) return true;
    }
    return false;
}

void unguard(const GuardedRange& range) {
    for (auto& slot : guardedRanges)
        if (slot.load() == &range) slot.store(nullptr);
}

// Calls async-signal-safe functions only.
void onBusError(int signal, siginfo_t* info, void*) {
    const auto* address = static_cast<const std::byte*>(info->si_addr);
    for (const auto& slot : guardedRanges) {
        const GuardedRange* range = slot.load();
        if (range == nullptr || address < range->begin || address >= range->begin + range->bytes) continue;
        const ssize_t written = ::write(STDERR_FILENO, range->message.data(), range->message.size());
        ::_exit(written < 0 ? 2 : 1);
    }
    ::sigaction(SIGBUS, &previousAction, nullptr);
    ::raise(signal);  // delivered to the previous handler on return
}

}  // namespace

struct MappedFile::Mapping {
    explicit Mapping(const fs::path& file);
    ~Mapping();
    Mapping(const Mapping&) = delete;
    Mapping& operator=(const Mapping&) = delete;

    fs::path path;
    GuardedRange range;
};

MappedFile::Mapping::Mapping(const fs::path& file) : path(file) {
    const InputFile input = openInput(path);
    if (input.bytes == 0) return;  // an empty mapping is not allowed
    void* data = ::mmap(nullptr, input.bytes, PROT_READ, MAP_PRIVATE, input.descriptor.get(), 0);
    if (data == MAP_FAILED) failErrno(path, "cannot be mapped");
    // Of a file larger than memory pages are then put aside in the order in which they came; else the kernel keeps
    // looking for one that was not used lately. Advice alone: nothing depends on its being taken.
    ::madvise(data, input.bytes, MADV_SEQUENTIAL);
    range = {static_cast<const std::byte*>(data), input.bytes,
             fmt::format("error: {}: was cut while in use\n", path.string())};
    if (guard(range)) return;
    ::munmap(data, input.bytes);
    fail(path, fmt::format("cannot be mapped: {} files are mapped already", guardedRanges.size()));
}

MappedFile::Mapping::~Mapping() {
    if (range.bytes == 0) return;
    unguard(range);
    ::munmap(const_cast<std::byte*>(range.begin), range.bytes);
}

MappedFile::MappedFile(const fs::path& path) : mapping_(std::make_unique<const Mapping>(path)) {}
MappedFile::~MappedFile() = default;
MappedFile::MappedFile(MappedFile&& other) noexcept = default;
MappedFile& MappedFile::operator=(MappedFile&& other) noexcept = default;

std::span<const std::byte> MappedFile::bytes() const { return {mapping_->range.begin, mapping_->range.bytes}; }
const fs::path& MappedFile::path() const { return mapping_->path; }
void MappedFile::expectLookups() const {
    ::madvise(const_cast<std::byte*>(mapping_->range.begin), mapping_->range.bytes, MADV_RANDOM);
}

void guardMappedFiles() {
    struct sigaction action {};
    action.sa_sigaction = onBusError;
    action.sa_flags = SA_SIGINFO;
    ::sigaction(SIGBUS, &action, &previousAction);
}

}  // namespace lsde
