#include "app/cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "app/cli/quantities.h"
#include "app/cli/report.h"

namespace crescente::app {
namespace {

int terminal_width() {
    winsize size{};
    constexpr int usual = 80;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

std::string bar(double fraction, int width) {
    const int filled = std::clamp(static_cast<int>(fraction * width), 0, width);
    return "[" + std::string(static_cast<std::size_t>(filled), '=') + std::string(static_cast<std::size_t>(width - filled), ' ') + "]";
}

}  // namespace

ProgressDisplay::ProgressDisplay(bool quiet, std::optional<std::chrono::duration<double>> limit)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), limit_(limit) {}

ProgressDisplay::~ProgressDisplay() {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressDisplay::announce(const std::string& what) {
    if (!quiet_) std::fprintf(stderr, "%s\n", what.c_str());
}

double ProgressDisplay::seconds_left(double fraction, double elapsed) const {
    double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 1e9;
    if (limit_) left = std::min(left, std::max(0.0, limit_->count() - elapsed));
    return left;
}

void ProgressDisplay::show(const render::Progress& progress, const render::Session& session) {
    if (quiet_ || progress.done) return;
    const auto now = Clock::now();
    const std::chrono::duration<double> since_last = now - last_;
    const double interval = terminal_ ? 0.1 : 2.0;  // seconds
    if (since_last.count() < interval) return;

    const std::uint64_t rays = session.stats().rays.total();
    const double rate = static_cast<double>(rays - last_rays_) / since_last.count();
    const double left = seconds_left(progress.fraction, std::chrono::duration<double>(now - start_).count());
    last_ = now;
    last_rays_ = rays;

    char numbers[96];
    std::snprintf(numbers, sizeof numbers, " %3.0f %%  %s  %s left", progress.fraction * 100, human_rate(rate).c_str(),
                  left >= 1e9 ? "?" : human_time(left).c_str());
    if (terminal_) {
        constexpr int level_width = 12, widest_bar = 40;
        const int room = terminal_width() - level_width - static_cast<int>(std::string_view(numbers).size()) - 3;
        std::fprintf(stderr, "\r\x1b[K%-*s%s%s", level_width, progress.level.c_str(),
                     room > 4 ? bar(progress.fraction, std::min(room, widest_bar)).c_str() : "", numbers);
        std::fflush(stderr);
        drawn_ = true;
    } else {
        std::fprintf(stderr, "%s%s\n", progress.level.c_str(), numbers);
    }
}

LoadingDisplay::LoadingDisplay(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

LoadingDisplay::~LoadingDisplay() {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void LoadingDisplay::show(double fraction, std::string_view stage) {
    if (quiet_) return;
    const auto now = Clock::now();
    const double interval = terminal_ ? 0.1 : 2.0;  // seconds
    if (std::chrono::duration<double>(now - last_).count() < interval) return;
    last_ = now;
    const std::string text(stage);
    constexpr int stage_width = 16, bar_width = 40;
    if (terminal_) {
        const int room = std::min(bar_width, terminal_width() - stage_width - 10);
        std::fprintf(stderr, "\r\x1b[K%-*s%s %3.0f %%", stage_width, text.c_str(), room > 4 ? bar(fraction, room).c_str() : "", fraction * 100);
        std::fflush(stderr);
        drawn_ = true;
    } else {
        std::fprintf(stderr, "%s %3.0f %%\n", text.c_str(), fraction * 100);
    }
}

io::ReadOptions read_options(bool cache, bool verbose, LoadingDisplay& display) {
    io::ReadOptions options;
    options.cache = cache;
    options.progress = [&display](double fraction, std::string_view stage) { display.show(fraction, stage); };
    options.log = [verbose](LogLevel level, std::string_view text) {
        if (verbose || level >= LogLevel::warning) note(std::string(text));
    };
    return options;
}

}  // namespace crescente::app
