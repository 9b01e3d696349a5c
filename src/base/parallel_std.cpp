// Threads by the standard library alone: under ThreadSanitizer a race-free TBB loop gives reports of its own, and the
// suppression that hides them hides real races too.
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/parallel.h"

namespace lsde {

struct ThreadPool::Impl {
    std::atomic<int> spare{0};  // threads that may still be started
};

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))),
      impl_(std::make_unique<Impl>()) {
    impl_->spare = threads_ - 1;
}

ThreadPool::~ThreadPool() = default;

void ThreadPool::forEach(size_t chunks, const std::function<void(size_t)>& body) {
    std::atomic<size_t> next{0};
    std::exception_ptr failure;
    std::mutex failureMutex;
    const auto work = [&] {
        for (size_t i = next++; i < chunks; i = next++) {
            try {
                body(i);
            } catch (...) {
                const std::scoped_lock lock(failureMutex);
                if (!failure) failure = std::current_exception();
                next = chunks;
            }
        }
    };
    std::vector<std::thread> helpers;
    while (helpers.size() + 1 < chunks && impl_->spare-- > 0) helpers.emplace_back(work);
    if (helpers.size() + 1 < chunks) ++impl_->spare;  // the last decrement found none
    work();
    for (auto& helper : helpers) helper.join();
    impl_->spare += static_cast<int>(helpers.size());
    if (failure) std::rethrow_exception(failure);
}

void ThreadPool::both(const std::function<void()>& first, const std::function<void()>& second) {
    forEach(2, [&](size_t i) { i == 0 ? first() : second(); });
}

}  // namespace lsde
