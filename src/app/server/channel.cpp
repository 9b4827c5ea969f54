#include "app/server/channel.h"

#include <algorithm>

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "app/server/replies.h"

namespace crescente::app {
namespace net = boost::asio;
namespace beast = boost::beast;

namespace {

// {"progress":...: the name of a message.
std::string_view name_of(std::string_view text) { return text.substr(0, text.find(':')); }

}  // namespace

Channel::Channel(Stream stream, std::shared_ptr<std::atomic<std::size_t>> backlog)
    : stream_(std::move(stream)), backlog_(std::move(backlog)), wake_(stream_.get_executor(), net::steady_timer::time_point::max()) {}

Channel::~Channel() { stop(); }

void Channel::push(Outgoing message) {
    if (closing_ || stopped_) return;
    if (message.text) *backlog_ += message.bytes.size();
    waiting_.push_back(std::move(message));
    wake_.cancel();
}

void Channel::send_text(std::string text) { push({std::move(text), true, false}); }

void Channel::send_news(std::string text) {
    const auto same = std::find_if(waiting_.begin(), waiting_.end(), [&](const Outgoing& o) { return o.news && name_of(o.bytes) == name_of(text); });
    if (same == waiting_.end()) return push({std::move(text), true, true});
    *backlog_ += text.size() - same->bytes.size();
    same->bytes = std::move(text);
}

void Channel::send_frame(std::string bytes) { push({std::move(bytes), false, false}); }

void Channel::close(const std::string& reason) {
    send_text(reply("closed", {{"reason", reason}}));
    closing_ = true;
}

void Channel::stop() {
    stopped_ = true;
    for (const Outgoing& message : waiting_) {
        if (message.text) *backlog_ -= message.bytes.size();
    }
    waiting_.clear();
    wake_.cancel();
}

net::awaitable<void> Channel::write() {
    boost::system::error_code error;
    while (!stopped_) {
        if (waiting_.empty()) {
            if (closing_) break;
            co_await wake_.async_wait(net::redirect_error(net::use_awaitable, error));
            continue;
        }
        const Outgoing message = std::move(waiting_.front());
        waiting_.pop_front();
        stream_.text(message.text);
        co_await stream_.async_write(net::buffer(message.bytes), net::redirect_error(net::use_awaitable, error));
        if (message.text) *backlog_ -= message.bytes.size();
        if (error) break;
    }
    stop();
    co_await stream_.async_close(beast::websocket::close_code::going_away, net::redirect_error(net::use_awaitable, error));
}

}  // namespace crescente::app
