#include "base/scratch_array.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <new>
#include <string>
#include <utility>

namespace lsde {

namespace {

// Smaller arrays are not worth a file.
constexpr size_t kLeastInFile = 1 << 20;

// Of an open file of that size whose name is gone; -1: there is none.
int unnamedFile(size_t size) {
    const char* const folder = std::getenv("TMPDIR");
    std::string name = std::string(folder != nullptr && *folder != 0 ? folder : "/var/tmp") + "/lsde-XXXXXX";
    const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor < 0) return -1;
    ::unlink(name.c_str());
    // Room for all of it: a page that finds none when it is touched would end the process.
    if (::posix_fallocate(descriptor, 0, static_cast<off_t>(size)) == 0) return descriptor;
    ::close(descriptor);
    return -1;
}

std::byte* mapFile(size_t size) {
    const int descriptor = unnamedFile(size);
    if (descriptor < 0) return nullptr;
    void* const data = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    ::close(descriptor);
    if (data == MAP_FAILED) return nullptr;
    ::madvise(data, size, MADV_RANDOM);  // no pages about those that are asked for
    return static_cast<std::byte*>(data);
}

std::byte* mapMemory(size_t size) {
    void* const data = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (data == MAP_FAILED) throw std::bad_alloc();
    return static_cast<std::byte*>(data);
}

}  // namespace

ScratchBytes::ScratchBytes(size_t size, ScratchPlace place) : size_(size) {
    if (size == 0) return;
    if (place == ScratchPlace::File && size >= kLeastInFile) data_ = mapFile(size);
    if (data_ == nullptr) data_ = mapMemory(size);
}

ScratchBytes::~ScratchBytes() {
    if (data_ != nullptr) ::munmap(data_, size_);
}

ScratchBytes::ScratchBytes(ScratchBytes&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

ScratchBytes& ScratchBytes::operator=(ScratchBytes&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
}

}  // namespace lsde
