// Taking in files that the page sends.
#include <filesystem>
#include <fstream>

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>

#include "app/server/connection.h"
#include "app/server/guard.h"
#include "app/server/http.h"
#include "app/server/replies.h"

namespace crescente::app {
namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace fs = std::filesystem;

namespace {

HttpAnswer wrong(unsigned version, http::status status, const std::string& name, const std::string& reason, const std::string& hint = {}) {
    return json_answer(version, status, error_reply({ErrorKind::input, {{name.substr(0, 300), "", reason, hint}}}, {}));
}

// Removes what was not taken in as a whole.
class Unfinished {
public:
    explicit Unfinished(fs::path file) : file_(std::move(file)) {}
    ~Unfinished() {
        std::error_code ignored;
        if (!file_.empty()) fs::remove(file_, ignored);
    }
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;
    bool finish(const fs::path& as) {
        std::error_code error;
        fs::rename(file_, as, error);
        if (!error) file_.clear();
        return !error;
    }

private:
    fs::path file_;
};

}  // namespace

net::awaitable<HttpAnswer> take_upload(beast::tcp_stream& stream, beast::flat_buffer& buffer, UploadParser& parser, const std::string& name, const std::string& key, ServerState& state) {
    const unsigned version = parser.get().version();
    Sessions::Entry* entry = state.sessions->find(key);
    if (!entry) co_return wrong(version, http::status::forbidden, name, "there is no such session", "`session` of the address is the key of `welcome`");
    if (!is_plain_path(name)) co_return wrong(version, http::status::bad_request, name, "is no name for an upload", "such as part.step, or textures/oak.png");
    const std::uint64_t most = state.sessions->limits().upload;
    if (parser.content_length().value_or(0) > most - std::min(most, entry->uploaded)) {
        co_return wrong(version, http::status::payload_too_large, name, "the files of a session may have " + std::to_string(most) + " bytes together");
    }
    const fs::path file = entry->folder / "uploads" / name;
    std::error_code failed;
    fs::create_directories(file.parent_path(), failed);
    const fs::path part = entry->folder / ("part-" + random_text(9));
    std::ofstream out(part, std::ios::binary);
    Unfinished unfinished(part);
    if (failed || !out) co_return wrong(version, http::status::internal_server_error, name, "cannot be written");

    std::vector<char> block(std::size_t{1} << 16);
    while (!parser.is_done()) {
        constexpr auto patience = std::chrono::seconds(60);
        stream.expires_after(patience);
        parser.get().body().data = block.data();
        parser.get().body().size = block.size();
        boost::system::error_code error;
        co_await http::async_read(stream, buffer, parser, net::redirect_error(net::use_awaitable, error));
        if (error == http::error::need_buffer) error = {};
        if (error == http::error::body_limit) co_return wrong(version, http::status::payload_too_large, name, "is larger than " + std::to_string(most) + " bytes");
        if (error) co_return wrong(version, http::status::bad_request, name, "did not arrive as a whole");
        const std::size_t got = block.size() - parser.get().body().size;
        out.write(block.data(), static_cast<std::streamsize>(got));
        entry = state.sessions->find(key);
        if (!entry) co_return wrong(version, http::status::forbidden, name, "the session has ended");
        entry->uploaded += got;
        if (entry->uploaded > most) co_return wrong(version, http::status::payload_too_large, name, "the files of a session may have " + std::to_string(most) + " bytes together");
        if (!out) co_return wrong(version, http::status::insufficient_storage, name, "cannot be written: the disk may be full");
    }
    out.close();
    if (!out || !unfinished.finish(file)) co_return wrong(version, http::status::insufficient_storage, name, "cannot be written");
    co_return json_answer(version, http::status::ok, reply("file", "upload/" + name));
}

}  // namespace crescente::app
