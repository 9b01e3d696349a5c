// Vectors whose new elements are not set: for large results that several threads fill, and so touch, first.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace lsde {

// For types whose lifetime begins with their memory's: implicit-lifetime types (P0593).
template <typename T>
struct UnsetAllocator : std::allocator<T> {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    template <typename U>
    struct rebind {
        using other = UnsetAllocator<U>;
    };

    template <typename U>
    void construct(U* /*unset*/) noexcept {}
    template <typename U, typename... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        std::construct_at(at, std::forward<Arguments>(arguments)...);
    }
};

template <typename T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace lsde
