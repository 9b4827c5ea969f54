// Answers to HTTP requests: with what headers, and what they say.
#pragma once

#include <string>
#include <string_view>

#include <boost/beast/http.hpp>

namespace crescente::app {

using HttpRequest = boost::beast::http::request_header<>;
using HttpAnswer = boost::beast::http::response<boost::beast::http::string_body>;

// The headers that every answer has: a policy by which the page can load nothing from elsewhere, and runs no script that was not delivered with it.
void add_safety(boost::beast::http::fields& headers);

// A page of plain text.
HttpAnswer plain_answer(unsigned version, boost::beast::http::status status, std::string_view text);
HttpAnswer json_answer(unsigned version, boost::beast::http::status status, std::string text);

// A file of the page; `path` as it is asked for, "/" for the page itself.
HttpAnswer page_answer(unsigned version, std::string_view path);

}  // namespace crescente::app
