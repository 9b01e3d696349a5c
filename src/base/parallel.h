// Loops over threads. Work is cut into chunks whose limits depend on the sizes given only, never on the threads, so a
// result kept by chunk index and merged in that order is the same for any number of threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace lsde {

class ThreadPool {
  public:
    // threads 0: as many as the machine has.
    explicit ThreadPool(int threads = 0);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int threads() const { return threads_; }

    // Calls body(chunk) for each chunk in [0, chunks), in any order, on several threads; returns when all are done.
    // The first exception that a body throws is thrown again here.
    void forEach(size_t chunks, const std::function<void(size_t chunk)>& body);

    // Calls body(begin, end) for [0, count) cut into runs of `grain` elements, the last one shorter.
    void forRange(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body) {
        if (count == 0) return;
        forEach((count + grain - 1) / grain, [&](size_t chunk) {
            const size_t begin = chunk * grain;
            body(begin, begin + grain < count ? begin + grain : count);
        });
    }

    // Runs both, at the same time where threads are free. May be nested.
    void both(const std::function<void()>& first, const std::function<void()>& second);

  private:
    struct Impl;
    int threads_;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lsde
