// Work in a process of its own, for libraries that a damaged file can crash or hang.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace crescente::io {

struct IsolationLimits {
    std::chrono::seconds time{60};        // of the wall clock; also of the processor
    std::size_t memory = std::size_t{4} << 30;  // more than this process has, bytes; an answer may not be longer either
};

enum class IsolationFailure {
    crashed,      // ended by a signal, an uncaught exception or lack of memory
    too_long,     // ended by us after limits.time
    cancelled,    // ended by us because watch.cancelled said so
    unavailable,  // no process could be made
};

// What comes out of the process while it works. Any of these may be empty.
struct IsolationWatch {
    std::function<void(double fraction, std::string_view stage)> progress;  // as the work told it; fraction from 0 to 1
    std::function<void(std::string_view text)> printed;  // what the work printed, in pieces, the first 64 KB of it
    std::function<bool()> cancelled;                     // asked about ten times a second
};

// How the work tells how far it has come.
using TellProgress = std::function<void(double fraction, std::string_view stage)>;

// Runs `work` in a copy of this process and returns what it returned. Nothing that it does to the memory is seen here; what it prints goes to
// the watch. It must not need other threads, which the copy does not have. Blocks until the copy has ended; leaves no process behind.
tl::expected<std::string, IsolationFailure> run_isolated(const std::function<std::string(const TellProgress&)>& work, const IsolationLimits& limits,
                                                         const IsolationWatch& watch = {});

}  // namespace crescente::io
