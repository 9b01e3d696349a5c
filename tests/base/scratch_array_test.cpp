#include "base/scratch_array.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>

#include "store/fixture.h"

using namespace lsde;

namespace {

constexpr size_t kMany = 1 << 20;

// What the process has mapped there, as the kernel tells it.
std::string mappingOf(const void* address) {
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        const auto dash = line.find('-');
        const auto begin = std::stoull(line.substr(0, dash), nullptr, 16);
        const auto end = std::stoull(line.substr(dash + 1), nullptr, 16);
        const auto at = reinterpret_cast<uintptr_t>(address);
        if (begin <= at && at < end) return line;
    }
    return "";
}

struct TemporaryFilesIn {
    std::string before;
    explicit TemporaryFilesIn(const std::string& folder) {
        if (const char* const set = std::getenv("TMPDIR")) before = set;
        ::setenv("TMPDIR", folder.c_str(), 1);
    }
    ~TemporaryFilesIn() {
        if (before.empty())
            ::unsetenv("TMPDIR");
        else
            ::setenv("TMPDIR", before.c_str(), 1);
    }
};

}  // namespace

TEST_CASE("an array in a file starts as zeros, keeps what is written, and leaves no file") {
    const test::TemporaryFolder folder;
    const TemporaryFilesIn there(folder.path().string());
    ScratchArray<uint32_t> a(kMany, ScratchPlace::File);
    REQUIRE(a.size() == kMany);
    CHECK(mappingOf(a.data()).find(folder.path().string()) != std::string::npos);
    CHECK(folder.names().empty());
    CHECK(std::accumulate(a.data(), a.data() + kMany, uint64_t{0}) == 0);
    std::iota(a.data(), a.data() + kMany, 0U);
    const ScratchArray<uint32_t> b = std::move(a);
    CHECK(b[kMany - 1] == kMany - 1);
}

TEST_CASE("small arrays, and all where no file can be made, are in memory") {
    const TemporaryFilesIn nowhere("/nowhere");
    for (const size_t size : {size_t{1000}, kMany}) {
        ScratchArray<uint32_t> a(size, ScratchPlace::File);
        a[size - 1] = 7;
        CHECK(a[0] == 0);
        CHECK(a[size - 1] == 7);
        CHECK(mappingOf(a.data()).find("lsde") == std::string::npos);
    }
    CHECK(ScratchArray<uint32_t>(0, ScratchPlace::Memory).empty());
}
