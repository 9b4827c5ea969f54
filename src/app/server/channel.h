// What goes out to one page over its WebSocket, in order and bounded. All of it on the network's thread, but for the count of bytes.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <string>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket.hpp>

namespace crescente::app {

class Channel {
public:
    using Stream = boost::beast::websocket::stream<boost::beast::tcp_stream>;

    // `backlog`: where the bytes of texts that wait are counted, maybe with those of others; any thread may read it.
    Channel(Stream stream, std::shared_ptr<std::atomic<std::size_t>> backlog);
    ~Channel();
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;

    Stream& stream() { return stream_; }

    void send_text(std::string text);
    // In place of one that waits and has the same name.
    void send_news(std::string text);
    // Who sends frames waits for the page to have shown them: there are never more than two.
    void send_frame(std::string bytes);
    // Says so once all that waits is sent, and ends.
    void close(const std::string& reason);

    // Sends what there is until the page is gone or close() was called.
    boost::asio::awaitable<void> write();
    void stop();
    bool is_closing() const { return closing_; }

private:
    struct Outgoing {
        std::string bytes;
        bool text = true, news = false;
    };
    void push(Outgoing message);

    Stream stream_;
    std::shared_ptr<std::atomic<std::size_t>> backlog_;
    std::deque<Outgoing> waiting_;
    boost::asio::steady_timer wake_;
    bool closing_ = false, stopped_ = false;
};

}  // namespace crescente::app
