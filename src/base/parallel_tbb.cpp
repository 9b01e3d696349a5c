// The one file that includes TBB.
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include "base/parallel.h"

namespace lsde {

struct ThreadPool::Impl {
    // The limit holds for all of TBB, Embree's tree construction included.
    tbb::global_control control;
    tbb::task_arena arena;
    explicit Impl(int threads)
        : control(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads)), arena(threads) {}
};

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()), impl_(std::make_unique<Impl>(threads_)) {}

ThreadPool::~ThreadPool() = default;

void ThreadPool::forEach(size_t chunks, const std::function<void(size_t)>& body) {
    impl_->arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<size_t>(0, chunks, 1),
            [&](const tbb::blocked_range<size_t>& r) {
                for (size_t i = r.begin(); i != r.end(); ++i) body(i);
            },
            tbb::simple_partitioner());
    });
}

void ThreadPool::both(const std::function<void()>& first, const std::function<void()>& second) {
    impl_->arena.execute([&] { tbb::parallel_invoke(first, second); });
}

}  // namespace lsde
