// Work in a process of its own, for libraries that a damaged file can crash or hang.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

#include <tl/expected.hpp>

namespace crescente::io {

struct IsolationLimits {
    std::chrono::seconds time{60};        // of the wall clock; also of the processor
    std::size_t memory = std::size_t{4} << 30;  // more than this process has, bytes
};

enum class IsolationFailure {
    crashed,      // ended by a signal, an uncaught exception or lack of memory
    too_long,     // ended by us after limits.time
    unavailable,  // no process could be made
};

// Runs `work` in a copy of this process and returns what it returned. Nothing that it does to the memory is seen here; what it prints is lost.
// It must not need other threads, which the copy does not have. Blocks until the copy has ended; leaves no process behind.
tl::expected<std::string, IsolationFailure> run_isolated(const std::function<std::string()>& work, const IsolationLimits& limits);

}  // namespace crescente::io
