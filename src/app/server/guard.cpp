#include "app/server/guard.h"

#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>

#include <boost/asio/ip/address.hpp>

#include "io/base64.h"

namespace crescente::app {
namespace {

std::optional<std::string> unescaped(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i] == '+' ? ' ' : text[i];
            continue;
        }
        unsigned value = 0;
        if (i + 2 >= text.size()) return std::nullopt;
        const auto [end, error] = std::from_chars(&text[i + 1], &text[i + 1] + 2, value, 16);
        if (error != std::errc() || end != &text[i + 1] + 2 || value == 0) return std::nullopt;
        out += static_cast<char>(value);
        i += 2;
    }
    return out;
}

bool is_plain_part(std::string_view part) {
    constexpr std::size_t longest = 200;
    return !part.empty() && part.size() <= longest && part.front() != '.' &&
           std::all_of(part.begin(), part.end(), [](unsigned char c) { return c >= 0x20 && c != 0x7f && c != '\\' && c != '/' && c != ':'; });
}

}  // namespace

std::string random_text(std::size_t bytes) {
    std::string raw(bytes, '\0');
    for (std::size_t have = 0; have < bytes;) {
        const ssize_t got = getrandom(raw.data() + have, bytes - have, 0);
        if (got > 0) have += static_cast<std::size_t>(got);
    }
    std::string text = io::encode_base64(raw);
    std::erase(text, '=');
    std::replace(text.begin(), text.end(), '+', '-');
    std::replace(text.begin(), text.end(), '/', '_');
    return text;
}

bool same_secret(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
    return difference == 0;
}

std::string Target::value(const std::string& name) const {
    const auto found = query.find(name);
    return found == query.end() ? std::string{} : found->second;
}

std::optional<Target> parse_target(std::string_view target) {
    const auto question = std::min(target.find('?'), target.size());
    Target parsed;
    const auto path = unescaped(target.substr(0, question));
    if (!path || !path->starts_with('/') || (*path != "/" && !is_plain_path(std::string_view(*path).substr(1)))) return std::nullopt;
    parsed.path = *path;
    std::string_view rest = target.substr(std::min(question + 1, target.size()));
    while (!rest.empty()) {
        const auto end = std::min(rest.find('&'), rest.size());
        const std::string_view pair = rest.substr(0, end);
        const auto equals = std::min(pair.find('='), pair.size());
        const auto name = unescaped(pair.substr(0, equals)), value = unescaped(pair.substr(std::min(equals + 1, pair.size())));
        if (!name || !value) return std::nullopt;
        parsed.query.emplace(*name, *value);
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return parsed;
}

bool is_own_host(std::string_view host, std::string_view address, unsigned short port, bool wide) {
    const std::string suffix = ":" + std::to_string(port);
    constexpr unsigned short usual_port = 80;
    if (host.ends_with(suffix)) host.remove_suffix(suffix.size());
    else if (port != usual_port) return false;
    if (host == "localhost" || host == "127.0.0.1" || host == "[::1]" || host == address || host == "[" + std::string(address) + "]") return true;
    if (!wide) return false;
    char name[256] = "";
    if (gethostname(name, sizeof name - 1) == 0 && host == name) return true;
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    boost::system::error_code error;
    boost::asio::ip::make_address(std::string(host), error);
    return !error;
}

bool is_own_origin(std::string_view origin, std::string_view host) { return origin == "http://" + std::string(host); }

bool is_plain_path(std::string_view name) {
    constexpr int deepest = 8;
    for (int depth = 0; depth < deepest; ++depth) {
        const auto end = std::min(name.find('/'), name.size());
        if (!is_plain_part(name.substr(0, end))) return false;
        if (end == name.size()) return true;
        name.remove_prefix(end + 1);
    }
    return false;
}

}  // namespace crescente::app
