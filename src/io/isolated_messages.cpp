#include "io/isolated_messages.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace crescente::io {
namespace {

constexpr char progress_mark = 'p', answer_mark = 'a';
constexpr std::size_t longest_stage = 255;
constexpr std::size_t progress_header = 1 + sizeof(double) + 1, answer_header = 1 + sizeof(std::uint64_t);

template <class T>
void append(std::string& to, T value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::string progress_message(double fraction, std::string_view stage) {
    stage = stage.substr(0, longest_stage);
    std::string message(1, progress_mark);
    append(message, fraction);
    append(message, static_cast<unsigned char>(stage.size()));
    message += stage;
    return message;
}

std::string answer_message_header(std::uint64_t size) {
    std::string message(1, answer_mark);
    append(message, size);
    return message;
}

// Whether the message that `held_` begins with was complete and has been taken; broken state if it is none.
bool MessageReader::take_header() {
    if (held_.empty()) return false;
    if (held_[0] == progress_mark) {
        if (held_.size() < progress_header) return false;
        const std::size_t length = static_cast<unsigned char>(held_[progress_header - 1]);
        if (held_.size() < progress_header + length) return false;
        double fraction;
        std::memcpy(&fraction, held_.data() + 1, sizeof fraction);
        if (progress_ && std::isfinite(fraction)) progress_(std::clamp(fraction, 0.0, 1.0), std::string_view(held_).substr(progress_header, length));
        held_.erase(0, progress_header + length);
        return true;
    }
    if (held_[0] == answer_mark) {
        if (held_.size() < answer_header) return false;
        std::memcpy(&left_, held_.data() + 1, sizeof left_);
        held_.erase(0, answer_header);
        state_ = left_ <= largest_answer_ ? State::answer : State::broken;
        return state_ == State::answer;
    }
    state_ = State::broken;
    return false;
}

bool MessageReader::take(std::string_view bytes) {
    constexpr std::size_t longest = progress_header + longest_stage;  // of what is held
    while (!bytes.empty() && state_ != State::broken) {
        if (state_ == State::between) {
            const std::size_t taken = std::min(bytes.size(), longest);
            held_ += bytes.substr(0, taken);
            bytes.remove_prefix(taken);
            while (state_ == State::between && take_header()) {
            }
            if (state_ == State::answer) {  // what is held is of the answer
                const std::string rest = std::move(held_);
                held_.clear();
                if (!take(rest)) return false;
            }
        } else if (state_ == State::answer && left_ > 0) {
            const std::size_t taken = static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), left_));
            answer_ += bytes.substr(0, taken);
            bytes.remove_prefix(taken);
            left_ -= taken;
        } else {  // after the answer comes its end, and after that nothing
            state_ = state_ == State::answer && bytes.size() == 1 && bytes[0] == answer_end ? State::complete : State::broken;
            bytes = {};
        }
    }
    return state_ != State::broken;
}

}  // namespace crescente::io
