// Arrays that are worked on beside a large map: in memory, or where the kernel can put them aside when that is short.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace lsde {

enum class ScratchPlace : uint8_t {
    Memory,
    // A file without a name in $TMPDIR (/var/tmp, if that is not set). Where there is no room for one: memory.
    File,
};

// Zeros at first; they take up space from when they are touched.
class ScratchBytes {
  public:
    ScratchBytes() = default;
    // Throws std::bad_alloc.
    ScratchBytes(size_t size, ScratchPlace place);
    ~ScratchBytes();
    ScratchBytes(ScratchBytes&& other) noexcept;
    ScratchBytes& operator=(ScratchBytes&& other) noexcept;

    std::byte* data() const { return data_; }

  private:
    std::byte* data_ = nullptr;  // null: none
    size_t size_ = 0;
};

// Of types whose lifetime begins with their memory's (P0593), and which mean something where all bytes are zero.
template <typename T>
class ScratchArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  public:
    ScratchArray() = default;
    ScratchArray(size_t size, ScratchPlace place) : bytes_(size * sizeof(T), place), size_(size) {}

    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T& operator[](size_t i) { return data()[i]; }
    const T& operator[](size_t i) const { return data()[i]; }
    T* data() { return reinterpret_cast<T*>(bytes_.data()); }
    const T* data() const { return reinterpret_cast<const T*>(bytes_.data()); }

  private:
    ScratchBytes bytes_;
    size_t size_ = 0;
};

}  // namespace lsde
