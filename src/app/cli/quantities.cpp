#include "app/cli/quantities.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

namespace crescente::app {
namespace {

tl::unexpected<Error> wrong(const std::string& option, std::string_view text, const std::string& hint) {
    return failure(ErrorKind::usage, {"", option, "'" + std::string(text) + "' cannot be understood", hint});
}

// The finite number that `text` begins with; what follows it is left in `text`.
std::optional<double> take_number(std::string_view& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

struct Suffix {
    std::string_view name;
    double factor;
};

// A number that is not negative, with one of the suffixes or none.
template <std::size_t n>
std::optional<double> parse_amount(std::string_view text, const Suffix (&suffixes)[n]) {
    const auto number = take_number(text);
    if (!number || *number < 0) return std::nullopt;
    for (const Suffix& suffix : suffixes) {
        if (text == suffix.name) return *number * suffix.factor;
    }
    return std::nullopt;
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, pattern, values...);
    return buffer;
}

}  // namespace

Expected<Size> parse_size(const std::string& option, std::string_view text) {
    const std::string hint = "write WIDTHxHEIGHT in pixels, such as 1920x1080";
    const std::string_view whole = text;
    Size size;
    for (int* side : {&size.width, &size.height}) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *side);
        if (error != std::errc()) return wrong(option, whole, hint);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (side == &size.width) {
            if (text.empty() || (text.front() != 'x' && text.front() != 'X')) return wrong(option, whole, hint);
            text.remove_prefix(1);
        }
    }
    if (!text.empty()) return wrong(option, whole, hint);
    return size;
}

Expected<std::chrono::duration<double>> parse_duration(const std::string& option, std::string_view text) {
    static constexpr Suffix suffixes[] = {{"", 1}, {"s", 1}, {"ms", 1e-3}, {"m", 60}, {"min", 60}, {"h", 3600}};
    constexpr double longest = 1e9;  // seconds, 30 years: what steady_clock can add without overflow
    const auto seconds = parse_amount(text, suffixes);
    if (!seconds || *seconds > longest) return wrong(option, text, "write a time such as 10s, 500ms, 2m or 1h");
    return std::chrono::duration<double>(*seconds);
}

Expected<std::int64_t> parse_bytes(const std::string& option, std::string_view text) {
    static constexpr Suffix suffixes[] = {{"", 1},           {"K", 1024.0},      {"k", 1024.0},
                                          {"M", 1048576.0},  {"G", 1073741824.0}, {"T", 1099511627776.0}};
    constexpr double most = 9e15;  // exact in a double
    const auto bytes = parse_amount(text, suffixes);
    if (!bytes || *bytes > most) return wrong(option, text, "write an amount such as 512M or 2G");
    return static_cast<std::int64_t>(*bytes);
}

Expected<std::vector<double>> parse_numbers(const std::string& option, std::string_view text) {
    const std::string_view whole = text;
    std::vector<double> numbers;
    while (true) {
        const auto number = take_number(text);
        if (!number) break;
        numbers.push_back(*number);
        if (text.empty()) return numbers;
        if (text.front() != ',') break;
        text.remove_prefix(1);
    }
    return wrong(option, whole, "write numbers between commas, such as 1,2.5,-3");
}

std::string human_count(double count) {
    static constexpr Suffix suffixes[] = {{"G", 1e9}, {"M", 1e6}, {"k", 1e3}};
    for (const Suffix& suffix : suffixes) {
        if (count >= suffix.factor) return format("%.3g ", count / suffix.factor) + std::string(suffix.name);
    }
    return format("%.0f", count);
}

std::string human_rate(double rays_per_second) {
    const std::string count = human_count(rays_per_second);
    return count + (count.find(' ') == std::string::npos ? " rays/s" : "rays/s");
}

std::string human_bytes(double bytes) {
    static constexpr Suffix suffixes[] = {{"GiB", 1073741824.0}, {"MiB", 1048576.0}, {"KiB", 1024.0}};
    for (const Suffix& suffix : suffixes) {
        if (bytes >= suffix.factor) return format("%.1f ", bytes / suffix.factor) + std::string(suffix.name);
    }
    return format("%.0f bytes", bytes);
}

std::string human_time(double seconds) {
    if (!(seconds < 1e9)) return "?";
    if (seconds < 1) return format("%.0f ms", seconds * 1000);
    if (seconds < 60) return format("%.2f s", seconds);
    const long whole = std::lround(seconds);
    if (whole < 3600) return format("%ld:%02ld", whole / 60, whole % 60);
    return format("%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace crescente::app
