// What a process of isolated work sends home: progress, then the answer, then a mark that the answer is whole.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace crescente::io {

std::string progress_message(double fraction, std::string_view stage);
std::string answer_message_header(std::uint64_t size);  // the answer's bytes follow it, and then answer_end
inline constexpr char answer_end = 'e';

// Takes the bytes as they arrive. They come from a process that may have gone astray: nothing is believed.
class MessageReader {
public:
    // An answer of more bytes than `largest_answer` is not taken.
    MessageReader(std::uint64_t largest_answer, std::function<void(double fraction, std::string_view stage)> progress)
        : largest_answer_(largest_answer), progress_(std::move(progress)) {}

    bool take(std::string_view bytes);  // false: these are no messages; nothing more is taken
    bool complete() const { return state_ == State::complete; }
    std::string& answer() { return answer_; }

private:
    enum class State { between, answer, complete, broken };
    bool take_header();

    State state_ = State::between;
    std::string held_;  // the beginning of a message
    std::string answer_;
    std::uint64_t left_ = 0;
    std::uint64_t largest_answer_;
    std::function<void(double, std::string_view)> progress_;
};

}  // namespace crescente::io
