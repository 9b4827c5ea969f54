// The viewer's server: HTTP for the page, uploads and exports, a WebSocket for each viewer. It runs on the thread that calls serve(); each viewer renders in a thread of its own.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "app/cli/scene_options.h"
#include "app/server/file_library.h"
#include "app/server/sessions.h"

namespace crescente::app {

struct ServerOptions {
    std::string address = "127.0.0.1";
    unsigned short port = 0;  // 0: any that is free
    FileLibrary::Places places;
    SessionLimits limits;
    SceneRequest request;  // its file, if there is one, is opened by every new session
};

// Serves until SIGINT or SIGTERM. `ready` is called with the address of the page once it can be opened, and a private folder that is removed at the end. Errors (usage): the address is
// none, or cannot be listened on; (output) no folder for temporary files.
Expected<void> serve(const ServerOptions& options, const std::function<void(const std::string& address, const std::filesystem::path& folder)>& ready);

}  // namespace crescente::app
