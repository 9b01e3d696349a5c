#include "base/parallel.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace lsde;

namespace {

constexpr int kThreadCounts[] = {1, 2, 8};

uint64_t fibonacci(ThreadPool& pool, int n) {
    if (n < 2) return static_cast<uint64_t>(n);
    uint64_t a = 0, b = 0;
    pool.both([&] { a = fibonacci(pool, n - 1); }, [&] { b = fibonacci(pool, n - 2); });
    return a + b;
}

}  // namespace

TEST_CASE("a pool has the threads asked for, and at least one by default") {
    for (const int threads : kThreadCounts) CHECK(ThreadPool(threads).threads() == threads);
    CHECK(ThreadPool().threads() >= 1);
}

TEST_CASE("every chunk is done exactly once, and all of them before forEach returns") {
    for (const int threads : kThreadCounts) {
        ThreadPool pool(threads);
        for (const size_t chunks : {0, 1, 2, 3, 1000}) {
            CAPTURE(threads);
            CAPTURE(chunks);
            std::vector<int> done(chunks);  // not atomic: no two calls share a chunk
            pool.forEach(chunks, [&](size_t i) { ++done[i]; });
            CHECK(done == std::vector<int>(chunks, 1));
        }
    }
}

TEST_CASE("ranges are cut by count and grain alone") {
    using Ranges = std::vector<std::pair<size_t, size_t>>;
    for (const int threads : kThreadCounts) {
        ThreadPool pool(threads);
        const auto cut = [&](size_t count, size_t grain) {
            Ranges ranges((count + grain - 1) / grain);
            pool.forRange(count, grain, [&](size_t begin, size_t end) { ranges[begin / grain] = {begin, end}; });
            return ranges;
        };
        CHECK(cut(0, 4).empty());
        CHECK(cut(10, 4) == Ranges{{0, 4}, {4, 8}, {8, 10}});
        CHECK(cut(8, 4) == Ranges{{0, 4}, {4, 8}});
        CHECK(cut(3, 4) == Ranges{{0, 3}});
        CHECK(cut(2, 1) == Ranges{{0, 1}, {1, 2}});
    }
}

TEST_CASE("a sum kept by chunk is the same for any number of threads") {
    std::vector<float> sums;
    for (const int threads : kThreadCounts) {
        ThreadPool pool(threads);
        std::vector<float> part(100);
        pool.forRange(100000, 1000, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) part[begin / 1000] += 1.0F / static_cast<float>(1 + i);
        });
        sums.push_back(std::accumulate(part.begin(), part.end(), 0.0F));
    }
    CHECK(sums[1] == sums[0]);
    CHECK(sums[2] == sums[0]);
}

TEST_CASE("an exception comes out of the loop, and the pool works on") {
    for (const int threads : kThreadCounts) {
        ThreadPool pool(threads);
        std::atomic<int> done{0};
        const auto body = [&](size_t i) {
            if (i == 3) throw std::runtime_error("chunk " + std::to_string(i));
            ++done;
        };
        CHECK_THROWS_WITH_AS(pool.forEach(100, body), "chunk 3", std::runtime_error);
        CHECK_THROWS_WITH_AS(pool.both([] {}, [] { throw std::runtime_error("second"); }), "second",
                             std::runtime_error);
        done = 0;
        pool.forEach(100, [&](size_t) { ++done; });
        CHECK(done == 100);
    }
}

TEST_CASE("loops and pairs may be nested") {
    for (const int threads : kThreadCounts) {
        CAPTURE(threads);
        ThreadPool pool(threads);
        std::vector<int> done(20 * 30);
        pool.forEach(20, [&](size_t i) { pool.forEach(30, [&](size_t j) { ++done[30 * i + j]; }); });
        CHECK(done == std::vector<int>(20 * 30, 1));
        CHECK(fibonacci(pool, 12) == 144);
    }
}

TEST_CASE("two chunks run at the same time where there are two threads") {
    ThreadPool pool(2);
    std::atomic<int> arrived{0}, met{0};
    // Each waits for the other; the deadline only keeps a pool that has lost its threads from hanging here.
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    pool.forEach(2, [&](size_t) {
        ++arrived;
        while (arrived < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
        if (arrived == 2) ++met;
    });
    CHECK(met == 2);
}
