#include "io/isolated.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio_ext.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/isolated_messages.h"

namespace crescente::io {
namespace {

void limit(int resource, rlim_t value) {
    rlimit current{};
    if (getrlimit(static_cast<__rlimit_resource>(resource), &current) != 0) return;
    current.rlim_cur = current.rlim_max == RLIM_INFINITY ? value : std::min(value, current.rlim_max);
    setrlimit(static_cast<__rlimit_resource>(resource), &current);
}

// Address space of this process, bytes; proc(5).
std::size_t address_space() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

bool write_all(int to, const char* bytes, std::size_t count) {
    while (count > 0) {
        const ssize_t written = write(to, bytes, count);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes += written;
        count -= static_cast<std::size_t>(written);
    }
    return true;
}

[[noreturn]] void work_and_answer(const std::function<std::string(const TellProgress&)>& work, const IsolationLimits& limits, int to, int printed_to) {
    for (const int signal_number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGINT}) signal(signal_number, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // who started this process may be ended while it works
    __fpurge(stdout);  // what the other process has yet to print is its own matter
    dup2(printed_to, STDOUT_FILENO);
    dup2(printed_to, STDERR_FILENO);
    // What else is open is not its business: who waits for the end of a pipe that another thread made meanwhile would wait for this process, too.
    close_range(STDERR_FILENO + 1, static_cast<unsigned>(to) - 1, 0), close_range(static_cast<unsigned>(to) + 1, ~0u, 0);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, static_cast<rlim_t>(limits.time.count()));
    limit(RLIMIT_AS, address_space() + limits.memory);
    const auto send = [to](const std::string& bytes) { return write_all(to, bytes.data(), bytes.size()); };
    bool good = false;
    try {
        const std::string answer = work([&](double fraction, std::string_view stage) {
            if (!send(progress_message(fraction, stage))) _exit(1);  // nobody listens any more
        });
        std::fflush(stdout);  // what the libraries printed lies in their buffers
        good = send(answer_message_header(answer.size())) && send(answer) && write_all(to, &answer_end, 1);
    } catch (...) {
    }
    _exit(good ? 0 : 1);  // no destructors of objects that belong to the other process
}

// Both ends of a pipe, closed at the end.
struct Pipe {
    int ends[2] = {-1, -1};
    bool good = pipe2(ends, O_CLOEXEC) == 0;

    Pipe() = default;
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        for (const int end : ends) {
            if (end >= 0) close(end);
        }
    }
    void close_end(int which) { close(std::exchange(ends[which], -1)); }
};

// Reads what there is from the pipe and hands it on; closes it at its end.
template <class Take>
void read_some(Pipe& pipe, Take&& take) {
    char chunk[1 << 16];
    const ssize_t got = read(pipe.ends[0], chunk, sizeof chunk);
    if (got > 0) take(std::string_view(chunk, static_cast<std::size_t>(got)));
    else if (got == 0 || errno != EINTR) pipe.close_end(0);
}

}  // namespace

tl::expected<std::string, IsolationFailure> run_isolated(const std::function<std::string(const TellProgress&)>& work, const IsolationLimits& limits,
                                                         const IsolationWatch& watch) {
    Pipe messages, printed;
    if (!messages.good || !printed.good) return tl::unexpected(IsolationFailure::unavailable);
    const pid_t child = fork();
    if (child < 0) return tl::unexpected(IsolationFailure::unavailable);
    if (child == 0) work_and_answer(work, limits, messages.ends[1], printed.ends[1]);
    messages.close_end(1);
    printed.close_end(1);

    using clock = std::chrono::steady_clock;
    const auto deadline = clock::now() + limits.time;
    MessageReader reader(limits.memory, watch.progress);
    std::size_t printed_left = std::size_t{64} << 10;
    const auto take_printed = [&](std::string_view text) {
        text = text.substr(0, printed_left);
        printed_left -= text.size();
        if (watch.printed && !text.empty()) watch.printed(text);
    };
    bool in_time = true, cancelled = false, sane = true;
    while (messages.ends[0] >= 0 && in_time && !cancelled && sane) {
        constexpr std::chrono::milliseconds between_questions{100};
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - clock::now());
        in_time = left.count() > 0;
        cancelled = watch.cancelled && watch.cancelled();
        if (!in_time || cancelled) break;
        pollfd both[2] = {{messages.ends[0], POLLIN, 0}, {printed.ends[0], POLLIN, 0}};  // poll ignores what is closed
        if (poll(both, 2, static_cast<int>(std::min(left, between_questions).count())) <= 0) continue;
        if (both[1].revents != 0) read_some(printed, take_printed);
        if (both[0].revents != 0) read_some(messages, [&](std::string_view bytes) { sane = reader.take(bytes); });
    }
    if (messages.ends[0] >= 0) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    pollfd rest{printed.ends[0], POLLIN, 0};
    while (printed.ends[0] >= 0 && printed_left > 0 && poll(&rest, 1, 0) > 0) read_some(printed, take_printed);
    if (cancelled) return tl::unexpected(IsolationFailure::cancelled);
    if (!in_time || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) return tl::unexpected(IsolationFailure::too_long);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !reader.complete()) return tl::unexpected(IsolationFailure::crashed);
    return std::move(reader.answer());
}

}  // namespace crescente::io
