#include "app/cli/stop.h"

#include <csignal>
#include <iterator>

namespace crescente::app {
namespace {

// A signal handler can reach nothing but static storage.
std::atomic<bool> stop_asked = false;
std::atomic<bool> stop_insisted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "only such atomics may be touched in a signal handler");

void on_signal(int signal) {
    if (!stop_asked.exchange(true)) return;
    stop_insisted = true;
    std::signal(signal, SIG_DFL);  // a third one ends the program whatever it is doing
}

constexpr int signals[] = {SIGINT, SIGTERM};
struct sigaction previous[std::size(signals)];

}  // namespace

StopRequests::StopRequests() {
    stop_asked = stop_insisted = false;
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;  // so that no write of a picture fails halfway
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < std::size(signals); ++i) {
        sigaction(signals[i], &action, &previous[i]);
        // Who started the program with a signal ignored (nohup, a script's background jobs) wants it ignored.
        if (previous[i].sa_handler == SIG_IGN) sigaction(signals[i], &previous[i], nullptr);
    }
}

StopRequests::~StopRequests() {
    for (std::size_t i = 0; i < std::size(signals); ++i) sigaction(signals[i], &previous[i], nullptr);
}

const std::atomic<bool>& StopRequests::asked() const { return stop_asked; }
const std::atomic<bool>& StopRequests::insisted() const { return stop_insisted; }

}  // namespace crescente::app
