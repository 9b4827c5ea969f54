// Sizes, times and amounts as people write and read them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace crescente::app {

// Each reads the text of a command line option and names that option in its error (ErrorKind::usage).

struct Size {
    int width = 0, height = 0;
};
// "1920x1080".
Expected<Size> parse_size(const std::string& option, std::string_view text);

// "10", "10s", "500ms", "2m", "1.5h": not negative; a bare number is seconds.
Expected<std::chrono::duration<double>> parse_duration(const std::string& option, std::string_view text);

// "2G", "512M", "64K", "1000000": bytes, in powers of 1024.
Expected<std::int64_t> parse_bytes(const std::string& option, std::string_view text);

// "1,2.5,-3": finite numbers between commas.
Expected<std::vector<double>> parse_numbers(const std::string& option, std::string_view text);

// "1.23 M", "45.6 k", "789".
std::string human_count(double count);

// "1.63 Mrays/s".
std::string human_rate(double rays_per_second);

// "1.2 GiB", "34 KiB", "12 bytes".
std::string human_bytes(double bytes);

// "45 ms", "1.23 s", "2:05", "1:02:05".
std::string human_time(double seconds);

}  // namespace crescente::app
