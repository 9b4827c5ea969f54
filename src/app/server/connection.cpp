#include "app/server/connection.h"

#include <array>
#include <filesystem>

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>

#include "app/server/guard.h"
#include "app/server/http.h"

namespace crescente::app {
namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using namespace std::chrono_literals;

namespace {

constexpr auto patience = 60s;  // for a request, and between two
constexpr std::size_t longest_header = 16384;

// Why the request is not served at all; empty if it is.
std::string refusal(const HttpRequest& request, const std::optional<Target>& target, const ServerState& state) {
    if (!target) return "The address is not clean.";
    if (!is_own_host(request[http::field::host], state.address, state.port, state.wide)) return "This server goes by another name.";
    const std::string_view origin = request[http::field::origin];
    if (!origin.empty() && !is_own_origin(origin, request[http::field::host])) return "Requests of other pages are not served.";
    return {};
}

bool has_token(const Target& target, const ServerState& state) { return same_secret(target.value("token"), state.token); }

HttpAnswer forbidden(unsigned version) {
    return plain_answer(version, http::status::forbidden, "The token in the address is missing or wrong: open the address that `crescente view` printed.");
}

// A finished export: /export/KEY/NUMBER.
std::optional<std::filesystem::path> export_file(const Target& target, ServerState& state) {
    constexpr std::string_view prefix = "/export/";
    const std::string rest = target.path.substr(prefix.size());
    const auto slash = rest.find('/');
    if (slash == std::string::npos) return {};
    const Sessions::Entry* entry = state.sessions->find(rest.substr(0, slash));
    const std::string number = rest.substr(slash + 1);
    if (!entry || number.empty() || number.find_first_not_of("0123456789") != std::string::npos) return {};
    std::error_code error;
    std::filesystem::directory_iterator at(entry->folder / "exports" / number, error);
    if (error || at == std::filesystem::directory_iterator{}) return {};
    return at->path();
}

net::awaitable<bool> send_file(beast::tcp_stream& stream, const std::filesystem::path& file, unsigned version, bool keep_alive) {
    boost::system::error_code error;
    http::file_body::value_type body;
    body.open(file.c_str(), beast::file_mode::scan, error);
    if (error) {
        auto answer = plain_answer(version, http::status::not_found, "There is no such export.");
        answer.prepare_payload();
        co_await http::async_write(stream, answer, net::redirect_error(net::use_awaitable, error));
        co_return false;
    }
    http::response<http::file_body> answer{http::status::ok, version};
    answer.body() = std::move(body);
    add_safety(answer);
    answer.set(http::field::content_type, "application/octet-stream");
    answer.set(http::field::content_disposition, "attachment; filename=\"" + file.filename().string() + "\"");
    answer.set(http::field::cache_control, "no-store");
    answer.keep_alive(keep_alive);
    answer.prepare_payload();
    http::response_serializer<http::file_body> serializer{answer};
    while (!serializer.is_done()) {  // a slow line may take its time, as long as it takes some
        stream.expires_after(patience);
        co_await http::async_write_some(stream, serializer, net::redirect_error(net::use_awaitable, error));
        if (error) co_return false;
    }
    co_return keep_alive;
}

// Whoever is still sending a body that nobody wants must be able to read the answer: what comes is taken, for a moment, before the connection is closed.
net::awaitable<void> take_leave(beast::tcp_stream& stream) {
    boost::system::error_code error;
    stream.socket().shutdown(net::ip::tcp::socket::shutdown_send, error);
    stream.expires_after(2s);
    std::array<char, 16384> unwanted;
    while (!error) co_await stream.async_read_some(net::buffer(unwanted), net::redirect_error(net::use_awaitable, error));
}

net::awaitable<void> serve_requests(beast::tcp_stream& stream, ServerState& state) {
    beast::flat_buffer buffer;
    for (bool open = true; open;) {
        boost::system::error_code error;
        UploadParser parser;
        parser.header_limit(longest_header);
        parser.body_limit(boost::none);  // who takes a body counts it
        stream.expires_after(patience);
        co_await http::async_read_header(stream, buffer, parser, net::redirect_error(net::use_awaitable, error));
        if (error) co_return;
        const auto& request = parser.get();
        const unsigned version = request.version();
        const auto target = parse_target(std::string_view(request.target()));
        const bool is_get = request.method() == http::verb::get || request.method() == http::verb::head;
        const std::string refused = refusal(request, target, state);
        HttpAnswer answer;
        bool read_all = is_get && !parser.chunked() && parser.content_length().value_or(0) == 0;
        if (!refused.empty()) {
            answer = plain_answer(version, http::status::forbidden, refused);
        } else if (beast::websocket::is_upgrade(request)) {
            if (target->path == "/socket" && has_token(*target, state) && request.count(http::field::origin) == 1) {
                http::request<http::empty_body> upgrade;
                static_cast<HttpRequest&>(upgrade) = request.base();
                stream.expires_never();
                Channel::Stream socket(std::move(stream));
                co_return co_await talk(std::move(socket), std::move(upgrade), target->value("session"), state);
            }
            answer = forbidden(version);
        } else if (request.method() == http::verb::post && target->path == "/upload") {
            if (!has_token(*target, state) || request.count(http::field::origin) != 1) answer = forbidden(version);
            else answer = co_await take_upload(stream, buffer, parser, target->value("name"), target->value("session"), state), read_all = parser.is_done();
        } else if (!is_get) {
            answer = plain_answer(version, http::status::method_not_allowed, "Only GET, HEAD and uploads are served.");
        } else if (target->path.starts_with("/export/")) {
            const auto file = has_token(*target, state) ? export_file(*target, state) : std::nullopt;
            if (file && request.method() == http::verb::get) {
                open = co_await send_file(stream, *file, version, request.keep_alive() && read_all);
                continue;
            }
            answer = has_token(*target, state) ? plain_answer(version, http::status::not_found, "There is no such export.") : forbidden(version);
        } else if (target->path == "/" || target->path == "/index.html") {
            answer = has_token(*target, state) ? page_answer(version, target->path) : forbidden(version);
        } else {
            answer = page_answer(version, target->path);
        }
        open = request.keep_alive() && read_all;
        answer.keep_alive(open);
        answer.prepare_payload();
        if (request.method() == http::verb::head) answer.body().clear();
        stream.expires_after(patience);
        co_await http::async_write(stream, answer, net::redirect_error(net::use_awaitable, error));
        if (error) co_return;
    }
    co_await take_leave(stream);
}

}  // namespace

net::awaitable<void> serve_connection(net::ip::tcp::socket socket, ServerState& state) {
    boost::system::error_code ignored;
    socket.set_option(net::ip::tcp::no_delay(true), ignored);
    beast::tcp_stream stream(std::move(socket));
    try {
        co_await serve_requests(stream, state);
    } catch (const std::exception&) {
        // Whatever it is (memory, the other side): this connection ends, and no other.
    }
}

}  // namespace crescente::app
