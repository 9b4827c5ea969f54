// What the user sees while a picture grows.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "io/formats.h"
#include "render/session.h"

namespace crescente::app {

// A bar on stderr when that is a terminal, else a line every two seconds.
class ProgressDisplay {
public:
    // `limit`: the rendering time the user allows, if any.
    explicit ProgressDisplay(bool quiet, std::optional<std::chrono::duration<double>> limit);
    ~ProgressDisplay();  // removes the bar
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void announce(const std::string& what);
    void show(const render::Progress& progress, const render::Session& session);

private:
    using Clock = std::chrono::steady_clock;
    double seconds_left(double fraction, double elapsed) const;

    bool quiet_, terminal_;
    bool drawn_ = false;
    std::optional<std::chrono::duration<double>> limit_;
    Clock::time_point start_ = Clock::now(), last_ = start_;
    std::uint64_t last_rays_ = 0;
};

// The same while a file is read, from the first tenth of a second on.
class LoadingDisplay {
public:
    explicit LoadingDisplay(bool quiet);
    ~LoadingDisplay();  // removes the bar
    LoadingDisplay(const LoadingDisplay&) = delete;
    LoadingDisplay& operator=(const LoadingDisplay&) = delete;

    void show(double fraction, std::string_view stage);

private:
    using Clock = std::chrono::steady_clock;

    bool quiet_, terminal_;
    bool drawn_ = false;
    Clock::time_point last_ = Clock::now();
};

// How the command line reads files: progress on the display, which must outlive the options, and what libraries say in the log where `verbose`.
io::ReadOptions read_options(bool cache, bool verbose, LoadingDisplay& display);

}  // namespace crescente::app
