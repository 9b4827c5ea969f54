// crescente: the command line. Reads as the data path: options, command, exit code.
#include <algorithm>
#include <array>
#include <cctype>
#include <csignal>
#include <iostream>
#include <new>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "app/cli/command.h"
#include "base/spelling.h"

namespace crescente::app {
namespace {

constexpr const char* footer =
    "Examples:\n"
    "  crescente render model.glb -o picture.png     a bare model is framed and lit by a studio\n"
    "  crescente render scene.nff -o picture.png --size 1920x1080 --time 10s\n"
    "  crescente view model.glb                      the viewer, in the browser\n"
    "  crescente edit model.glb script.jsonl         edits played on a scene, with what each costs\n"
    "  crescente info model.glb                      what is in the file, and what is wrong with it\n"
    "  crescente bench scene.nff                     accelerators and switches compared\n\n"
    "Exit codes: 0 ok, 1 pictures differ, 2 usage, 3 input, 4 output, 5 unsupported, 6 out of memory or disk, 70 defect, 130 stopped";

std::string quoted_command_line(int count, char** arguments) {
    std::string line = "crescente";
    for (int i = 1; i < count; ++i) {
        const std::string argument = arguments[i];
        const auto plain = [](unsigned char c) { return std::isalnum(c) || std::string_view("-_./,=:+@%").find(static_cast<char>(c)) != std::string_view::npos; };
        line += ' ';
        if (!argument.empty() && std::all_of(argument.begin(), argument.end(), plain)) {
            line += argument;
            continue;
        }
        line += '\'';
        for (const char c : argument) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += '\'';
    }
    return line;
}

ExitCode usage(const std::string& reason, const std::string& hint) { return fail({ErrorKind::usage, {{"", "", reason, hint}}}); }

// Options that nobody declared, each with the nearest spelling.
ExitCode refuse(const CLI::App& parser, const std::vector<std::string>& unknown) {
    std::vector<std::string> names;
    for (const CLI::Option* option : parser.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    Error error{ErrorKind::usage, {}};
    const bool option_among = std::any_of(unknown.begin(), unknown.end(), [](const auto& u) { return u.starts_with('-'); });
    for (const std::string& argument : unknown) {
        if (option_among && !argument.starts_with('-')) continue;  // the value of an unknown option, more often than not
        const std::string name = argument.substr(0, argument.find('='));
        const std::string near = nearest_spelling(name, names);
        error.problems.push_back({"", argument, "is not known to `crescente " + parser.get_name() + "`",
                                  near.empty() ? "see `crescente " + parser.get_name() + " --help`" : "did you mean '" + near + "'?"});
    }
    return fail(error);
}

ExitCode run(int count, char** arguments) {
    CLI::App app("Crescente renders models by ray tracing with growing realism: a whole picture at once, better at every moment.", "crescente");
    app.set_version_flag("--version", std::string("crescente ") + CRESCENTE_VERSION);
    app.footer(footer);
    const std::array commands = {add_render(app), add_edit(app), add_view(app), add_info(app), add_bench(app), add_compare(app), add_formats(app), add_schema(app), add_materials(app)};
    for (const Command& command : commands) command.parser->allow_extras();
    app.allow_extras();

    try {
        app.parse(count, arguments);
    } catch (const CLI::Success& success) {  // --help, --version
        app.exit(success);
        return exit_ok;
    } catch (const CLI::ParseError& error) {
        return usage(error.what(), "see `crescente --help`");
    }

    for (const Command& command : commands) {
        if (!command.parser->parsed()) continue;
        if (const auto unknown = command.parser->remaining(); !unknown.empty()) return refuse(*command.parser, unknown);
        return command.run({quoted_command_line(count, arguments)});
    }
    if (const auto unknown = app.remaining(); !unknown.empty()) {
        std::vector<std::string> names;
        for (const Command& command : commands) names.push_back(command.parser->get_name());
        return usage("there is no command '" + unknown.front() + "'", spelling_hint(unknown.front(), names));
    }
    return usage("a command is missing", "render, edit, view, info, bench, compare, formats or schema; see `crescente --help`");
}

}  // namespace
}  // namespace crescente::app

// The library reports failure by value; what is thrown past it is the end of memory, or a defect.
int main(int count, char** arguments) {
    using namespace crescente;
    std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow further is an error to report, not a reason to die
    try {
        return app::run(count, arguments);
    } catch (const std::bad_alloc&) {
        return app::fail({ErrorKind::resource, {{"", "", "not enough memory", "try a smaller --size"}}});
    } catch (const std::exception& error) {
        return app::fail({ErrorKind::internal, {{"", "", std::string("defect in Crescente: ") + error.what(), "please report it"}}});
    }
}
