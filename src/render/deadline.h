// When work must stop.
#pragma once

#include <atomic>
#include <chrono>

namespace crescente::render {

// When advance() must come back. Work is done in quanta of at most about 2 ms.
struct Deadline {
    std::chrono::steady_clock::time_point at = std::chrono::steady_clock::time_point::max();
    const std::atomic<bool>* stop = nullptr;  // set by another thread, or a signal handler, to come back at once

    static Deadline never() { return {}; }
    bool is_never() const { return !stop && at == std::chrono::steady_clock::time_point::max(); }
    static Deadline in(std::chrono::nanoseconds time) { return {std::chrono::steady_clock::now() + time, nullptr}; }
    bool passed() const { return (stop && stop->load(std::memory_order_relaxed)) || std::chrono::steady_clock::now() >= at; }
};

}  // namespace crescente::render
