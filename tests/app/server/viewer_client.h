// A page's part of the protocol, for tests: a WebSocket to the real program, the picture put together from its frames.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace crescente::test {

// RGB, 8 bits.
struct Pixels {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
    bool operator==(const Pixels&) const = default;
};
Pixels read_png(const std::string& bytes);

struct FrameHeader {
    std::uint32_t number = 0, looks = 0;
    int width = 0, height = 0;
    bool converged = false, anew = false;
    std::size_t parts = 0;
    int area = 0;  // pixels of all parts
};

// `crescente view`, running.
class Server {
public:
    explicit Server(std::vector<std::string> arguments);
    const std::string& address() const { return address_; }
    std::string host() const;  // with port
    std::string token() const;
    Running& program() { return program_; }
    std::size_t resident_bytes() const;

private:
    Running program_;
    std::string address_;
};

using Fields = std::vector<std::pair<std::string, std::string>>;

struct HttpReply {
    int status = 0;
    std::string type, body, policy, sniffing;
};
// One request; Host and Origin are the server's unless `fields` say otherwise (an empty value leaves them out).
HttpReply ask(const Server& server, const std::string& target, const std::string& method = "GET", const std::string& body = {}, const Fields& fields = {});

class Client {
public:
    using Json = nlohmann::json;

    // Fails the test where the server does not take the connection.
    explicit Client(const Server& server, const std::string& session = {});

    void send(const Json& message) { send_text(message.dump()); }
    void send_text(const std::string& text);
    // Sends with a number of its own and waits for what answers it.
    Json request(Json message);
    // The next text with this member. Frames that come meanwhile are drawn, and acknowledged.
    Json wait_for(const std::string& name);
    // Until a frame says that the picture is converged, and meets the condition.
    FrameHeader wait_converged(const std::function<bool(const FrameHeader&)>& enough = {});
    FrameHeader wait_frame();
    // The progress that says so of what was last asked for.
    const Json& wait_done();
    // Whether the next message is the end of the connection, after any others.
    bool is_ended();

    // Closes the TCP connection without a word.
    void vanish();
    void acknowledge(std::uint32_t frame) { send({{"shown", frame}}); }

    const Pixels& picture() const { return picture_; }
    const Json& welcome() const { return welcome_; }  // the first message
    std::string session() const { return welcome_["welcome"]["session"]; }
    const Json& scene() const { return scene_; }  // as the messages so far have it

    bool acknowledging = true;
    std::size_t frames = 0;        // that came
    std::size_t told_objects = 0;  // in messages `scene`

private:
    // The next message: a text, or the header of a frame that was drawn.
    std::variant<Json, FrameHeader> next();
    FrameHeader draw(const std::string& bytes);
    void take_scene(const Json& news);

    boost::asio::io_context network_;
    boost::beast::websocket::stream<boost::asio::ip::tcp::socket> socket_{network_};
    Json welcome_, scene_, progress_;
    Pixels picture_;
    std::int64_t last_id_ = 0;
};

}  // namespace crescente::test
