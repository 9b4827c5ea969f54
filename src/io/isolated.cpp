#include "io/isolated.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fstream>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

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

constexpr char complete = 'c';  // the last byte of an answer that is whole

[[noreturn]] void work_and_answer(const std::function<std::string()>& work, const IsolationLimits& limits, int to) {
    for (const int signal_number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGINT}) signal(signal_number, SIG_DFL);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, static_cast<rlim_t>(limits.time.count()));
    limit(RLIMIT_AS, address_space() + limits.memory);
    bool good = false;
    try {
        const std::string answer = work();
        good = write_all(to, answer.data(), answer.size()) && write_all(to, &complete, 1);
    } catch (...) {
    }
    _exit(good ? 0 : 1);  // no destructors of objects that belong to the other process
}

}  // namespace

tl::expected<std::string, IsolationFailure> run_isolated(const std::function<std::string()>& work, const IsolationLimits& limits) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return tl::unexpected(IsolationFailure::unavailable);
    const pid_t child = fork();
    if (child < 0) {
        close(ends[0]);
        close(ends[1]);
        return tl::unexpected(IsolationFailure::unavailable);
    }
    if (child == 0) {
        close(ends[0]);
        work_and_answer(work, limits, ends[1]);
    }
    close(ends[1]);

    using clock = std::chrono::steady_clock;
    const auto deadline = clock::now() + limits.time;
    std::string answer;
    bool in_time = true, ended = false;
    char chunk[1 << 16];
    while (!ended && in_time) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - clock::now());
        in_time = left.count() > 0;
        pollfd one{ends[0], POLLIN, 0};
        if (!in_time || poll(&one, 1, static_cast<int>(left.count())) <= 0) continue;
        const ssize_t got = read(ends[0], chunk, sizeof chunk);
        if (got > 0) answer.append(chunk, static_cast<std::size_t>(got));
        else if (got == 0 || errno != EINTR) ended = true;
    }
    close(ends[0]);
    if (!ended) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!in_time || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) return tl::unexpected(IsolationFailure::too_long);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty() || answer.back() != complete) {
        return tl::unexpected(IsolationFailure::crashed);
    }
    answer.pop_back();
    return answer;
}

}  // namespace crescente::io
