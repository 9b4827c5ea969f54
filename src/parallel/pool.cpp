#include "parallel/pool.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace crescente::parallel {

struct Pool::Arena {
    int threads;
    tbb::task_arena arena;
};

Pool::Pool(int threads) {
    const int count = threads > 0 ? threads : tbb::info::default_concurrency();
    arena_ = std::make_unique<Arena>(Arena{count, tbb::task_arena(count)});
}
Pool::Pool(Pool&&) noexcept = default;
Pool::~Pool() = default;

int Pool::threads() const { return arena_->threads; }

void Pool::for_each(std::size_t count, const std::function<void(std::size_t)>& work) {
    if (arena_->threads == 1) {
        for (std::size_t i = 0; i < count; ++i) work(i);
        return;
    }
    arena_->arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1), [&](const auto& range) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
        }, tbb::simple_partitioner{});
    });
}

}  // namespace crescente::parallel
