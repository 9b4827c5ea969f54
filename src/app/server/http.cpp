#include "app/server/http.h"

#include <algorithm>

#include "app/server/page_files.h"

namespace crescente::app {
namespace http = boost::beast::http;

namespace {

// Styles may stand in the page, as its component library makes them.
constexpr const char* policy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; font-src 'self'; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

constexpr std::string_view page_of_no_page =
    "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Crescente</title><h1>Crescente</h1>"
    "<p>This program was built without Node, so that the viewer's page is not in it. Install nodejs (18 or newer) and npm, configure and build again.</p></html>";

}  // namespace

void add_safety(http::fields& headers) {
    headers.set(http::field::server, "Crescente");
    headers.set("Content-Security-Policy", policy);
    headers.set("X-Content-Type-Options", "nosniff");
    headers.set("Referrer-Policy", "no-referrer");  // the address has the token
    headers.set("Cross-Origin-Opener-Policy", "same-origin");
    headers.set("Cross-Origin-Resource-Policy", "same-origin");
}

HttpAnswer plain_answer(unsigned version, http::status status, std::string_view text) {
    HttpAnswer answer{status, version};
    add_safety(answer);
    answer.set(http::field::content_type, "text/plain; charset=utf-8");
    answer.set(http::field::cache_control, "no-store");
    answer.body() = std::string(text) + "\n";
    return answer;
}

HttpAnswer json_answer(unsigned version, http::status status, std::string text) {
    HttpAnswer answer{status, version};
    add_safety(answer);
    answer.set(http::field::content_type, "application/json");
    answer.set(http::field::cache_control, "no-store");
    answer.body() = std::move(text);
    return answer;
}

HttpAnswer page_answer(unsigned version, std::string_view path) {
    const bool is_page = path == "/" || path == "/index.html";
    const auto files = page_files();
    const auto found = std::find_if(files.begin(), files.end(), [&](const PageFile& file) { return file.path == (is_page ? "/index.html" : path); });
    HttpAnswer answer{http::status::ok, version};
    add_safety(answer);
    if (found == files.end()) {
        if (!is_page) return plain_answer(version, http::status::not_found, "There is no such file.");
        answer.set(http::field::content_type, "text/html; charset=utf-8");
        answer.set(http::field::cache_control, "no-store");
        answer.body() = page_of_no_page;
        return answer;
    }
    answer.set(http::field::content_type, found->type);
    answer.set(http::field::content_encoding, "gzip");
    // Names of assets change with their content.
    answer.set(http::field::cache_control, found->path.starts_with("/assets/") ? "public, max-age=31536000, immutable" : "no-store");
    answer.body() = found->gzip;
    return answer;
}

}  // namespace crescente::app
