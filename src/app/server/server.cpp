#include "app/server/server.h"

#include <cstdlib>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "app/server/connection.h"
#include "app/server/guard.h"

namespace crescente::app {
namespace net = boost::asio;
namespace fs = std::filesystem;
using net::ip::tcp;

namespace {

constexpr std::size_t most_connections = 128;
constexpr std::size_t token_bytes = 24;

// A folder that only this user can enter, removed with all that is in it.
class PrivateFolder {
public:
    static Expected<PrivateFolder> make() {
        std::error_code error;
        std::string name = (fs::temp_directory_path(error) / "crescente-XXXXXX").string();
        if (error || !mkdtemp(name.data())) return failure(ErrorKind::output, {name, "", "no folder for temporary files can be made", ""});
        return PrivateFolder(fs::canonical(name, error));
    }
    PrivateFolder(PrivateFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    ~PrivateFolder() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove_all(path_, ignored);
    }
    const fs::path& path() const { return path_; }

private:
    explicit PrivateFolder(fs::path path) : path_(std::move(path)) {}
    fs::path path_;
};

net::awaitable<void> accept(tcp::acceptor& acceptor, ServerState& state) {
    while (acceptor.is_open()) {
        boost::system::error_code error;
        tcp::socket socket = co_await acceptor.async_accept(net::redirect_error(net::use_awaitable, error));
        if (!acceptor.is_open()) co_return;
        if (error) {  // out of descriptors, most likely: others will be closed
            net::steady_timer pause(acceptor.get_executor(), std::chrono::milliseconds(50));
            co_await pause.async_wait(net::redirect_error(net::use_awaitable, error));
            continue;
        }
        if (state.connections >= most_connections) continue;
        ++state.connections;
        net::co_spawn(acceptor.get_executor(), serve_connection(std::move(socket), state), [&state](std::exception_ptr) { --state.connections; });
    }
}

std::string page_address(const tcp::endpoint& endpoint, const std::string& token) {
    const net::ip::address address = endpoint.address();
    std::string host = address.is_unspecified() ? "127.0.0.1" : address.to_string();
    if (address.is_v6() && !address.is_unspecified()) host = "[" + host + "]";
    return "http://" + host + ":" + std::to_string(endpoint.port()) + "/?token=" + token;
}

}  // namespace

Expected<void> serve(const ServerOptions& options, const std::function<void(const std::string&, const fs::path&)>& ready) {
    const auto wrong = [&](const std::string& reason, const std::string& hint) { return failure(ErrorKind::usage, {"", "--listen", reason, hint}); };
    boost::system::error_code error;
    const net::ip::address address = net::ip::make_address(options.address, error);
    if (error) return wrong("'" + options.address + "' is no address", "such as 127.0.0.1, or 0.0.0.0 for all of this machine");
    auto folder = PrivateFolder::make();
    if (!folder) return tl::unexpected(folder.error());

    net::io_context network(1);
    tcp::acceptor acceptor(network);
    const tcp::endpoint endpoint(address, options.port);
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
    if (error) return wrong("cannot listen on " + options.address + " port " + std::to_string(options.port) + ": " + error.message(), "");

    ServerState state;
    state.token = random_text(token_bytes);
    state.address = options.address;
    state.port = acceptor.local_endpoint().port();
    state.wide = !address.is_loopback();
    FileLibrary::Places places = options.places;
    places.recent = places.recent && !state.wide;
    state.files = std::make_shared<FileLibrary>(std::move(places));
    Sessions sessions(network, options.limits, folder->path(), state.token, options.request, state.files);
    state.sessions = &sessions;

    net::signal_set signals(network, SIGINT, SIGTERM);
    signals.async_wait([&](const boost::system::error_code& failed, int) {
        if (failed) return;
        boost::system::error_code ignored;
        acceptor.close(ignored);
        sessions.end("the program ends");
    });
    net::co_spawn(network, accept(acceptor, state), net::detached);
    const auto more_to_come = net::make_work_guard(network);  // viewers' threads tell their end by way of it
    ready(page_address(acceptor.local_endpoint(), state.token), folder->path());
    while (acceptor.is_open() || !sessions.empty()) network.run_one();
    // What pages are still to be told gets a moment; then connections end with the network.
    constexpr auto moment = std::chrono::milliseconds(200);
    network.run_for(moment);
    return {};
}

}  // namespace crescente::app
