// Parallel loops over independent work.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace crescente::parallel {

// A fixed number of threads (the caller's counts as one). Loops of one pool run one after the other.
class Pool {
public:
    explicit Pool(int threads);  // 0: one for each core
    Pool(Pool&&) noexcept;
    Pool& operator=(Pool&&) noexcept;
    ~Pool();

    int threads() const;

    // Calls work(i) once for each i in 0..count-1, in any order and on any thread, and returns when all are done.
    void for_each(std::size_t count, const std::function<void(std::size_t)>& work);

private:
    struct Arena;
    std::unique_ptr<Arena> arena_;
};

// Runs work that may have parallel parts of its own. While it waits for these its thread takes up nothing else: what it holds locked, no other work on this thread
// can ask for.
void alone(const std::function<void()>& work);

}  // namespace crescente::parallel
