#include "parallel/pool.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace crescente::parallel {
namespace {

// oneTBB is not built with the thread sanitizer, which cannot see that a loop's work comes after what was done before the loop and
// before what is done after it. These say so.
#if defined(__SANITIZE_THREAD__)
void passes_on(void* order) { __tsan_release(order); }
void takes_over(void* order) { __tsan_acquire(order); }
#else
void passes_on(void*) {}
void takes_over(void*) {}
#endif

}  // namespace

struct Pool::Arena {
    int threads;
    tbb::task_arena arena;
};

Pool::Pool(int threads) {
    const int count = threads > 0 ? threads : tbb::info::default_concurrency();
    arena_ = std::make_unique<Arena>(Arena{count, tbb::task_arena(count)});
}
Pool::Pool(Pool&&) noexcept = default;
Pool& Pool::operator=(Pool&&) noexcept = default;
Pool::~Pool() = default;

int Pool::threads() const { return arena_->threads; }

void Pool::for_each(std::size_t count, const std::function<void(std::size_t)>& work) {
    if (arena_->threads == 1) {
        for (std::size_t i = 0; i < count; ++i) work(i);
        return;
    }
    char order;  // its address is what the sanitizer goes by
    passes_on(&order);
    arena_->arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1), [&](const auto& range) {
            takes_over(&order);
            for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
            passes_on(&order);
        }, tbb::simple_partitioner{});
    });
    takes_over(&order);
}

void alone(const std::function<void()>& work) { tbb::this_task_arena::isolate(work); }

}  // namespace crescente::parallel
