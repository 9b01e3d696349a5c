// A data race on purpose: two chunks of a loop write one variable. ThreadSanitizer has to report it, else it is blind
// to races of the thread pool's loops.
#include <atomic>

#include "base/parallel.h"

int main() {
    lsde::ThreadPool pool(2);
    int shared = 0;
    std::atomic<int> arrived{0};
    pool.forEach(2, [&](size_t) {
        // Both threads are here at once; relaxed, so that the wait does not order their writes.
        arrived.fetch_add(1, std::memory_order_relaxed);
        while (arrived.load(std::memory_order_relaxed) < 2) {
        }
        ++shared;
    });
    return 0;
}
