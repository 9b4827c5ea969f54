// One connection of a browser: requests, one after the other, until it asks for the WebSocket.
#pragma once

#include <memory>
#include <string>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http.hpp>

#include "app/server/sessions.h"

namespace crescente::app {

// What all connections share.
struct ServerState {
    std::string token;
    std::string address;  // that is listened on
    unsigned short port = 0;
    bool wide = false;    // other machines may connect
    std::size_t connections = 0;
    std::shared_ptr<FileLibrary> files;
    Sessions* sessions = nullptr;
};

// Serves the connection until its end; never throws.
boost::asio::awaitable<void> serve_connection(boost::asio::ip::tcp::socket socket, ServerState& state);

// The WebSocket, once the request for it was found right. `key`: of the session to be taken up, if it is still there.
boost::asio::awaitable<void> talk(Channel::Stream stream, boost::beast::http::request<boost::beast::http::empty_body> request, std::string key, ServerState& state);

// Takes a file into the session's folder while it arrives; the header was read. Answers.
using UploadParser = boost::beast::http::request_parser<boost::beast::http::buffer_body>;
boost::asio::awaitable<boost::beast::http::response<boost::beast::http::string_body>> take_upload(boost::beast::tcp_stream& stream, boost::beast::flat_buffer& buffer, UploadParser& parser,
                                                                                            const std::string& name, const std::string& key, ServerState& state);

}  // namespace crescente::app
