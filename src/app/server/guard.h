// Who may speak to the server: browsers whose page came from it, who know its token.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace crescente::app {

// So many random bytes of the system, as text for addresses (RFC 4648, section 5).
std::string random_text(std::size_t bytes);

// Takes the same time wherever the texts differ.
bool same_secret(std::string_view a, std::string_view b);

// "/socket?token=a%20b" taken apart. Nothing if the path is not clean: not absolute, with empty or dotted parts, backslashes or bytes that are no text.
struct Target {
    std::string path;
    std::map<std::string, std::string> query;

    std::string value(const std::string& name) const;  // empty if it is not there
};
std::optional<Target> parse_target(std::string_view target);

// Whether a request with this Host header (RFC 9112) may mean a server that listens on this address and port. Names that only DNS knows are refused: whoever rebinds one to this machine
// would speak for its pages. `wide`: the server listens to other machines, so that any address may be its own.
bool is_own_host(std::string_view host, std::string_view address, unsigned short port, bool wide);

// Whether the request comes from a page of that host.
bool is_own_origin(std::string_view origin, std::string_view host);

// A relative path whose parts are plain names, such as "textures/oak.png": for what is uploaded.
bool is_plain_path(std::string_view name);

}  // namespace crescente::app
