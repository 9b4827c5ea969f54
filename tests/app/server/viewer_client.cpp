#include "app/server/viewer_client.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <boost/asio/connect.hpp>
#include <boost/beast/core.hpp>
#include <png.h>
#include <turbojpeg.h>

namespace crescente::test {
namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using net::ip::tcp;

namespace {

std::vector<std::string> view_command(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"view", "--no-browser"});
    return command(std::move(arguments));
}

std::uint32_t number_at(const std::string& bytes, std::size_t at, std::size_t length) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < length; ++i) value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes.at(at + i))) << (8 * i);
    return value;
}

Pixels read_jpeg(const std::string& bytes) {
    const tjhandle reader = tjInitDecompress();
    Pixels pixels;
    int subsampling = 0, space = 0;
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    if (tjDecompressHeader3(reader, data, bytes.size(), &pixels.width, &pixels.height, &subsampling, &space) == 0) {
        pixels.rgb.resize(static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height) * 3);
        if (tjDecompress2(reader, data, bytes.size(), pixels.rgb.data(), pixels.width, 0, pixels.height, TJPF_RGB, 0) != 0) pixels = {};
    }
    EXPECT_EQ(subsampling, TJSAMP_444);
    tjDestroy(reader);
    return pixels;
}

// A picture of half the size both ways, pixel by pixel.
Pixels stretched(const Pixels& half, int width, int height) {
    EXPECT_EQ(half.width, (width + 1) / 2);
    EXPECT_EQ(half.height, (height + 1) / 2);
    Pixels whole{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t from = 3 * (static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(half.width) + static_cast<std::size_t>(x / 2));
            for (std::size_t c = 0; c < 3; ++c) whole.rgb.push_back(half.rgb.at(from + c));
        }
    }
    return whole;
}

void connect(tcp::socket& socket, net::io_context& network, const std::string& host) {
    const auto colon = host.rfind(':');
    net::connect(socket, tcp::resolver(network).resolve(host.substr(0, colon), host.substr(colon + 1)));
}

}  // namespace

Pixels read_png(const std::string& bytes) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    Pixels pixels;
    if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) return pixels;
    image.format = PNG_FORMAT_RGB;
    pixels.width = static_cast<int>(image.width), pixels.height = static_cast<int>(image.height);
    pixels.rgb.resize(PNG_IMAGE_SIZE(image));
    if (!png_image_finish_read(&image, nullptr, pixels.rgb.data(), 0, nullptr)) pixels = {};
    return pixels;
}

Server::Server(std::vector<std::string> arguments) : program_(view_command(std::move(arguments)), Running::Limits{}), address_(program_.first_line()) {
    EXPECT_TRUE(address_.starts_with("http://127.0.0.1:")) << address_;
}

std::string Server::host() const { return address_.substr(7, address_.find('/', 7) - 7); }
std::string Server::token() const { return address_.substr(address_.find("token=") + 6); }

std::size_t Server::resident_bytes() const {
    std::ifstream status("/proc/" + std::to_string(program_.process()) + "/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmRSS:")) return std::stoull(line.substr(6)) * 1024;
    }
    return 0;
}

HttpReply ask(const Server& server, const std::string& target, const std::string& method, const std::string& body, const Fields& fields) {
    net::io_context network;
    tcp::socket socket(network);
    connect(socket, network, server.host());
    http::request<http::string_body> request;
    request.method_string(method);
    request.target(target);
    request.version(11);
    request.set(http::field::host, server.host());
    request.set(http::field::origin, "http://" + server.host());
    for (const auto& [name, value] : fields) {
        if (value.empty()) request.erase(name);
        else request.set(name, value);
    }
    request.body() = body;
    if (!body.empty()) request.prepare_payload();
    boost::system::error_code error;
    http::write(socket, request, error);  // a refusal may come before all was sent
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(std::uint64_t{1} << 28);
    http::read(socket, buffer, parser, error);
    if (!parser.is_header_done()) return {};
    const auto& reply = parser.get();
    return {static_cast<int>(reply.result_int()), std::string(reply[http::field::content_type]), reply.body(), std::string(reply["Content-Security-Policy"]),
            std::string(reply["X-Content-Type-Options"])};
}

Client::Client(const Server& server, const std::string& session) {
    connect(socket_.next_layer(), network_, server.host());
    socket_.next_layer().set_option(tcp::no_delay(true));
    socket_.set_option(beast::websocket::stream_base::decorator([&](beast::websocket::request_type& request) {
        request.set(http::field::origin, "http://" + server.host());
        request.set(http::field::sec_websocket_protocol, "crescente.2");
    }));
    socket_.read_message_max(std::size_t{1} << 28);
    socket_.handshake(server.host(), "/socket?token=" + server.token() + (session.empty() ? "" : "&session=" + session));
    while (welcome_.is_null()) {
        auto first = next();
        if (auto* text = std::get_if<Json>(&first)) welcome_ = std::move(*text);
    }
}

// As a page does: what was changed of the objects goes into those that are there.
void Client::take_scene(const Json& news) {
    scene_.update(news);
    scene_.erase("changed");
    scene_.erase("gone");
    const auto place = [&](const Json& index) { return std::find_if(scene_["objects"].begin(), scene_["objects"].end(), [&](const Json& one) { return one["index"] == index; }); };
    for (const Json& object : news.value("changed", Json::array())) {
        if (const auto at = place(object["index"]); at != scene_["objects"].end()) at->update(object);
        else scene_["objects"].push_back(object);
    }
    for (const Json& index : news.value("gone", Json::array())) scene_["objects"].erase(place(index));
    told_objects += news.value("objects", Json::array()).size() + news.value("changed", Json::array()).size();
}

void Client::send_text(const std::string& text) {
    socket_.text(true);
    socket_.write(net::buffer(text));
}

Client::Json Client::request(Json message) {
    const std::int64_t id = ++last_id_;
    message["id"] = id;
    send(message);
    while (true) {
        auto got = next();
        if (auto* text = std::get_if<Json>(&got); text && text->value("id", std::int64_t{0}) == id) {
            progress_ = nullptr;  // it was of the time before
            return std::move(*text);
        }
    }
}

Client::Json Client::wait_for(const std::string& name) {
    while (true) {
        auto got = next();
        if (auto* text = std::get_if<Json>(&got); text && text->contains(name)) return std::move(*text);
    }
}

const Client::Json& Client::wait_done() {
    while (progress_.is_null() || progress_["done"] != true) wait_for("progress");
    return progress_;
}

FrameHeader Client::wait_frame() {
    while (true) {
        const auto got = next();
        if (const auto* frame = std::get_if<FrameHeader>(&got)) return *frame;
    }
}

FrameHeader Client::wait_converged(const std::function<bool(const FrameHeader&)>& enough) {
    while (true) {
        const FrameHeader frame = wait_frame();
        if (frame.converged && (!enough || enough(frame))) return frame;
    }
}

bool Client::is_ended() {
    try {
        while (true) next();
    } catch (const boost::system::system_error&) {
        return true;
    }
}

void Client::vanish() {
    boost::system::error_code ignored;
    socket_.next_layer().close(ignored);
}

std::variant<Client::Json, FrameHeader> Client::next() {
    beast::flat_buffer buffer;
    socket_.read(buffer);
    const std::string bytes = beast::buffers_to_string(buffer.data());
    if (!socket_.got_text()) {
        const FrameHeader frame = draw(bytes);
        ++frames;
        if (acknowledging) acknowledge(frame.number);
        return frame;
    }
    Json json = Json::parse(bytes);
    if (json.contains("scene")) take_scene(json["scene"]);
    if (json.contains("progress")) progress_ = json["progress"];
    return json;
}

FrameHeader Client::draw(const std::string& bytes) {
    EXPECT_TRUE(bytes.starts_with("CRF1"));
    FrameHeader frame;
    frame.number = number_at(bytes, 4, 4), frame.looks = number_at(bytes, 8, 4);
    frame.width = static_cast<int>(number_at(bytes, 12, 2)), frame.height = static_cast<int>(number_at(bytes, 14, 2));
    frame.converged = number_at(bytes, 16, 1) == 1, frame.anew = number_at(bytes, 17, 1) == 1;
    frame.parts = number_at(bytes, 18, 2);
    if (picture_.width != frame.width || picture_.height != frame.height) {
        EXPECT_TRUE(frame.anew) << "another size";
        picture_ = {frame.width, frame.height, std::vector<std::uint8_t>(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height) * 3)};
    }
    std::size_t at = 20;
    for (std::size_t i = 0; i < frame.parts; ++i) {
        const auto x = number_at(bytes, at, 2), y = number_at(bytes, at + 2, 2), width = number_at(bytes, at + 4, 2), height = number_at(bytes, at + 6, 2);
        const bool lossless = number_at(bytes, at + 8, 1) == 1;
        const std::size_t length = number_at(bytes, at + 12, 4);
        at += 16;
        Pixels part = lossless ? read_png(bytes.substr(at, length)) : read_jpeg(bytes.substr(at, length));
        if (!lossless && part.width < static_cast<int>(width)) part = stretched(part, static_cast<int>(width), static_cast<int>(height));
        at += length;
        EXPECT_EQ(part.width, static_cast<int>(width));
        EXPECT_EQ(part.height, static_cast<int>(height));
        EXPECT_TRUE(lossless || !frame.converged);
        if (part.rgb.size() != std::size_t{width} * height * 3 || x + width > static_cast<unsigned>(frame.width) || y + height > static_cast<unsigned>(frame.height)) {
            ADD_FAILURE() << "a part that does not fit";
            continue;
        }
        for (std::size_t row = 0; row < height; ++row) {
            std::memcpy(&picture_.rgb[((y + row) * static_cast<std::size_t>(frame.width) + x) * 3], &part.rgb[row * width * 3], width * std::size_t{3});
        }
        frame.area += static_cast<int>(width * height);
    }
    EXPECT_EQ(at, bytes.size());
    return frame;
}

}  // namespace crescente::test
