// Words and numbers of a text file, with line numbers; '#' begins a comment. Made for speed: a model is read in about the time that its
// bytes take.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

namespace crescente::io {

class TextScanner {
public:
    explicit TextScanner(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

    std::size_t line() const { return line_; }
    const char* at() const { return at_; }
    std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

    // Goes to the next word, over line ends and comments; false at the end of the file.
    bool to_word() {
        while (at_ < end_) {
            if (*at_ == '#') {
                to_line_end();
            } else if (*at_ == '\n') {
                ++line_, ++at_;
            } else if (is_blank(*at_)) {
                ++at_;
            } else {
                return true;
            }
        }
        return false;
    }

    // Goes to the next word of this line; false when there is none.
    bool to_word_of_line() {
        while (at_ < end_ && is_blank(*at_)) ++at_;
        return at_ < end_ && *at_ != '\n' && *at_ != '#';
    }

    // Call where to_word returned true.
    bool at_letter() const { return (*at_ >= 'a' && *at_ <= 'z') || (*at_ >= 'A' && *at_ <= 'Z'); }

    std::string_view word() {
        const char* first = at_;
        while (at_ < end_ && *at_ != '\n' && !is_blank(*at_)) ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }

    enum class Number { good, missing, bad };

    // The next number, on this line or a later one. `bad`: the word there is no finite number; it stays where it is.
    Number number(double& value) {
        if (!to_word()) return Number::missing;
        const char* first = *at_ == '+' ? at_ + 1 : at_;
        const auto [last, code] = std::from_chars(first, end_, value);
        if (last < end_ && !is_blank(*last) && *last != '\n' && *last != '#') return Number::bad;
        if (code == std::errc::result_out_of_range) value = std::strtod(std::string(first, last).c_str(), nullptr);  // tiny or huge
        else if (code != std::errc{}) return Number::bad;
        if (!std::isfinite(value)) return Number::bad;
        at_ = last;
        return Number::good;
    }

    std::string_view peek_word() const {
        TextScanner ahead = *this;
        return ahead.to_word() ? ahead.word() : std::string_view{};
    }

    // The rest of this line, without its end; goes to the next line.
    std::string_view rest_of_line() {
        const char* first = at_;
        to_line_end();
        const char* last = at_;
        if (at_ < end_) ++at_, ++line_;
        while (last > first && is_blank(last[-1])) --last;
        return {first, static_cast<std::size_t>(last - first)};
    }

    // Over the rest of this line and all lines that do not begin with a letter: to where the next entity can begin.
    void to_next_entity() {
        do to_line_end();
        while (to_word() && !at_letter());
    }

private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
    void to_line_end() {
        while (at_ < end_ && *at_ != '\n') ++at_;
    }

    const char* at_;
    const char* end_;
    std::size_t line_ = 1;
};

}  // namespace crescente::io
