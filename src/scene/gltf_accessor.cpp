#include "scene/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"

namespace lsde {

namespace {

// Buffers need not be aligned in memory.
template <typename T>
T load(const unsigned char* p) {
    T value;
    std::memcpy(&value, p, sizeof value);
    return value;
}

uint32_t loadIndex(const unsigned char* p, int componentType) {
    switch (componentType) {
        case 5121:
            return *p;
        case 5123:
            return load<uint16_t>(p);
        default:
            return load<uint32_t>(p);
    }
}

size_t bytesOfType(int componentType) { return componentType <= 5121 ? 1 : componentType <= 5123 ? 2 : 4; }

// Divisor of normalised integers (glTF 2.0, section 3.11); -1 stands for two values of a signed type.
float loadFloat(const unsigned char* p, int componentType, bool normalized) {
    switch (componentType) {
        case 5120:
            return normalized ? std::max(static_cast<float>(load<int8_t>(p)) / 127, -1.0F) : load<int8_t>(p);
        case 5121:
            return static_cast<float>(*p) / (normalized ? 255.0F : 1.0F);
        case 5122:
            return normalized ? std::max(static_cast<float>(load<int16_t>(p)) / 32767, -1.0F) : load<int16_t>(p);
        case 5123:
            return static_cast<float>(load<uint16_t>(p)) / (normalized ? 65535.0F : 1.0F);
        case 5125:
            return static_cast<float>(load<uint32_t>(p));
        default:
            return load<float>(p);
    }
}

}  // namespace

size_t GltfAccessor::componentBytes() const { return bytesOfType(componentType); }

uint32_t GltfAccessor::sparseIndex(size_t i) const {
    return loadIndex(sparseIndices + i * bytesOfType(sparseIndexType), sparseIndexType);
}

// Of the first sparse index that is not below the element (by halving: they increase).
size_t GltfAccessor::sparsePosition(size_t element) const {
    size_t lo = 0, hi = sparseCount;
    while (lo < hi) {
        const size_t middle = (lo + hi) / 2;
        if (sparseIndex(middle) < element)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

const unsigned char* GltfAccessor::bytesOf(size_t element) const {
    if (sparseCount > 0) {
        const size_t at = sparsePosition(element);
        if (at < sparseCount && sparseIndex(at) == element) return sparseValues + at * components * componentBytes();
    }
    return data == nullptr ? nullptr : data + element * stride;
}

void GltfAccessor::checkSparse() const {
    for (size_t i = 0; i < sparseCount; ++i) {
        const uint32_t index = sparseIndex(i);
        if (index >= count)
            throw Error(fmt::format("{}: sparse index {} = {}, but {} elements", where, i, index, count));
        if (i > 0 && index <= sparseIndex(i - 1))
            throw Error(fmt::format("{}: sparse index {} = {}, expected more than the one before", where, i, index));
    }
}

uint32_t GltfAccessor::index(size_t element) const {
    const unsigned char* p = bytesOf(element);
    return p == nullptr ? 0 : loadIndex(p, componentType);
}

std::array<float, 4> GltfAccessor::floats(size_t element) const {
    std::array<float, 4> out{};
    const unsigned char* p = bytesOf(element);
    if (p == nullptr) return out;
    for (size_t c = 0; c < components; ++c) {
        out[c] = loadFloat(p + c * componentBytes(), componentType, normalized);
        if (!std::isfinite(out[c]))
            throw Error(fmt::format("{}: element {} is not finite ({}), expected numbers", where, element, out[c]));
    }
    return out;
}

}  // namespace lsde
