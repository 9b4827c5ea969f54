// Ctrl-C and SIGTERM while a picture grows.
#pragma once

#include <atomic>

namespace crescente::app {

// From construction on, the signals no longer end the program but are counted; destruction restores what was before. One at a time.
class StopRequests {
public:
    StopRequests();
    ~StopRequests();
    StopRequests(const StopRequests&) = delete;
    StopRequests& operator=(const StopRequests&) = delete;

    // Set at the first signal: finish with the picture so far.
    const std::atomic<bool>& asked() const;
    // Set at the second: give up at once. A third is not caught.
    const std::atomic<bool>& insisted() const;
};

}  // namespace crescente::app
