// The WebSocket of one page: its messages go to its viewer.
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/http.hpp>

#include "app/server/connection.h"
#include "app/server/http.h"
#include "app/server/message.h"
#include "app/server/replies.h"
#include "app/server/welcome.h"

namespace crescente::app {
namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using namespace std::chrono_literals;

namespace {

const std::string subprotocol = "crescente." + std::to_string(protocol_version);
constexpr double most_messages = 500;             // a second
constexpr std::size_t most_waiting = 64;          // messages that the viewer has not taken
constexpr std::size_t most_backlog = std::size_t{1} << 20;  // bytes of answers that the page has not taken

// Counts messages: one may save up those of a second.
class Rate {
public:
    bool allows() {
        const auto now = std::chrono::steady_clock::now();
        left_ = std::min(most_messages, left_ + most_messages * std::chrono::duration<double>(now - last_).count());
        last_ = now;
        left_ -= 1;
        return left_ >= 0;
    }

private:
    double left_ = most_messages;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// Gives the page's messages to its viewer until the connection ends.
net::awaitable<void> listen(std::shared_ptr<Channel> channel, std::string key, ServerState& state) {
    Rate rate;
    std::uint32_t looks = 0;
    beast::flat_buffer buffer;
    net::steady_timer pause(channel->stream().get_executor());
    while (true) {
        boost::system::error_code error;
        co_await channel->stream().async_read(buffer, net::redirect_error(net::use_awaitable, error));
        if (error || channel->is_closing()) co_return;
        if (!rate.allows()) {
            channel->close("more than " + std::to_string(static_cast<int>(most_messages)) + " messages in a second");
            co_return;
        }
        Message message{{}, {}, failure(ErrorKind::input, {"", "", "messages are texts", ""})};
        if (channel->stream().got_text()) message = read_message({static_cast<const char*>(buffer.data().data()), buffer.size()});
        buffer.consume(buffer.size());
        if (message.request) {
            if (auto* look = std::get_if<Look>(&*message.request)) look->number = ++looks;
        }
        Sessions::Entry* entry = state.sessions->find(key);
        if (!entry || entry->page.lock() != channel) co_return;
        entry->viewer->give(std::move(message));
        // Who does not take answers, or asks faster than they can be made, waits.
        while (true) {
            entry = state.sessions->find(key);
            if (!entry || (entry->viewer->waiting() < most_waiting && *entry->backlog < most_backlog)) break;
            pause.expires_after(5ms);
            co_await pause.async_wait(net::redirect_error(net::use_awaitable, error));
            if (channel->is_closing()) co_return;
        }
    }
}

}  // namespace

net::awaitable<void> talk(Channel::Stream stream, http::request<http::empty_body> request, std::string key, ServerState& state) {
    beast::websocket::stream_base::timeout timeout = beast::websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.idle_timeout = 60s;
    stream.set_option(timeout);
    stream.set_option(beast::websocket::stream_base::decorator([](beast::websocket::response_type& response) {
        add_safety(response);
        response.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    stream.read_message_max(longest_message);
    stream.auto_fragment(false);
    boost::system::error_code error;
    co_await stream.async_accept(request, net::redirect_error(net::use_awaitable, error));
    if (error) co_return;

    Sessions::Entry* entry = key.empty() ? nullptr : state.sessions->find(key);
    const bool taken_up = entry != nullptr;
    if (!entry) entry = state.sessions->begin();
    const auto channel = std::make_shared<Channel>(std::move(stream), entry ? entry->backlog : std::make_shared<std::atomic<std::size_t>>(0));
    if (!entry) channel->close("there are too many sessions");
    else channel->send_text(welcome(entry->key, taken_up, state.sessions->limits()));
    const std::string own_key = entry ? entry->key : std::string{};
    net::co_spawn(channel->stream().get_executor(), [channel]() -> net::awaitable<void> { co_await channel->write(); }, net::detached);
    if (!entry) co_return;
    state.sessions->attach(*entry, channel);
    co_await listen(channel, own_key, state);
    if (!channel->is_closing()) channel->stop();
    state.sessions->detach(own_key, channel.get());
}

}  // namespace crescente::app
