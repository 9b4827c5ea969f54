// crescente view [MODEL]: the viewer in the browser.
#include <memory>

#include "app/cli/command.h"
#include "app/cli/quantities.h"
#include "app/cli/scene_options.h"

#ifdef CRESCENTE_WITH_SERVER
#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iostream>

#include "app/server/server.h"
#endif

namespace crescente::app {
namespace {

struct ViewOptions {
    SceneOptions scene;
    std::vector<std::string> folders;
    std::string address = "127.0.0.1";
    int port = 0;
    int sessions = 8;
    std::string keep = "5m", upload = "1G";
    bool no_browser = false;
};

#ifdef CRESCENTE_WITH_SERVER

// Opens the default browser, if there is a desktop. By way of a file, as only this user can read: every user of a machine can see the arguments of programs, and the address has the token.
void open_browser(const std::string& address, const std::filesystem::path& folder) {
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
    const std::string file = (folder / "open.html").string();
    std::ofstream(file) << "<!doctype html><meta http-equiv=\"refresh\" content=\"0;url=" << address << "\"><title>Crescente</title>\n";
    chmod(file.c_str(), S_IRUSR | S_IWUSR);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
    char program[] = "xdg-open";
    char* const arguments[] = {program, const_cast<char*>(file.c_str()), nullptr};
    pid_t process = 0;
    if (posix_spawnp(&process, program, &actions, nullptr, arguments, environ) != 0) note("no browser could be opened: open the address yourself");
    posix_spawn_file_actions_destroy(&actions);
}

Expected<ServerOptions> understand(const ViewOptions& options) {
    ServerOptions server;
    Problems problems;
    const auto keep = [&](auto value, auto& place) {
        if (value) place = std::move(*value);
        else problems.insert(problems.end(), value.error().problems.begin(), value.error().problems.end());
    };
    keep(understand(options.scene), server.request);
    keep(parse_duration("--keep", options.keep), server.limits.kept);
    std::int64_t upload = 0;
    keep(parse_bytes("--upload", options.upload), upload);
    server.limits.upload = static_cast<std::uint64_t>(upload);
    server.limits.most = static_cast<std::size_t>(options.sessions);
    server.address = options.address;
    server.port = static_cast<unsigned short>(options.port);
    std::error_code error;
    for (const std::string& folder : options.folders) {
        if (!std::filesystem::is_directory(folder, error)) problems.push_back({folder, "--folder", "is no folder", ""});
        server.places.folders.emplace_back(folder);
    }
    const std::string& file = options.scene.file;
    if (!file.empty() && std::filesystem::is_directory(file, error)) problems.push_back({file, "", "is a folder", "--folder allows a folder"});
    else if (!file.empty() && !std::filesystem::exists(file, error)) problems.push_back({file, "", "there is no such file", ""});
    if (!problems.empty()) return tl::unexpected<Error>({ErrorKind::usage, std::move(problems)});
    if (!file.empty()) server.places.files.emplace_back(file);
    return server;
}

ExitCode view(const ViewOptions& options) {
    const auto server = understand(options);
    if (!server) return fail(server.error());
    const auto served = serve(*server, [&](const std::string& address, const std::filesystem::path& folder) {
        std::cout << address << std::endl;
        if (!options.no_browser) open_browser(address, folder);
    });
    return served ? exit_ok : fail(served.error());
}

#else

ExitCode view(const ViewOptions&) {
    return fail({ErrorKind::unsupported, {{"", "view", "this build has no viewer", "install libboost1.81-dev and libturbojpeg0-dev, and build again"}}});
}

#endif

}  // namespace

Command add_view(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("view", "Look at a model in the browser, and edit it while it renders");
    const auto options = std::make_shared<ViewOptions>();
    add_scene_options(*parser, options->scene);
    parser->get_option("MODEL")->required(false);
    parser->add_option("--folder", options->folders, "A folder from which the page may open models (repeatable)")->option_text("DIR")->expected(1)->take_all()->allow_extra_args(false);
    parser->add_option("--listen", options->address, "Address to listen on; other than loopback, whoever knows the printed address can use the viewer")->option_text("ADDRESS");
    parser->add_option("--port", options->port, "Port to listen on; 0: one that is free")->option_text("N")->check(CLI::Range(0, 65535));
    parser->add_option("--sessions", options->sessions, "Most viewers at a time")->option_text("N")->check(CLI::Range(1, 1000));
    parser->add_option("--keep", options->keep, "How long a viewer without a page is kept")->option_text("TIME");
    parser->add_option("--upload", options->upload, "Most bytes that a page may upload")->option_text("BYTES");
    parser->add_flag("--no-browser", options->no_browser, "Only print the address");
    parser->footer(
        "The address is printed, and opened in the default browser. Ctrl-C ends.\n\n"
        "Examples:\n"
        "  crescente view engine.glb\n"
        "  crescente view --folder ~/models\n"
        "  crescente view part.step --no-browser --port 8080");
    return {parser, [options](const Invocation&) { return view(*options); }};
}

}  // namespace crescente::app
