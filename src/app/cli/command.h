// The subcommands of `crescente`, one file each.
#pragma once

#include <functional>
#include <string>

#include <CLI/App.hpp>

#include "app/cli/report.h"

namespace crescente::app {

// What a subcommand knows of the run as a whole.
struct Invocation {
    std::string command_line;  // as given, quoted where a shell needs it
};

// Runs a subcommand after its options have been parsed.
using Action = std::function<ExitCode(const Invocation&)>;

struct Command {
    CLI::App* parser;
    Action run;
};

Command add_render(CLI::App& app);
Command add_edit(CLI::App& app);
Command add_view(CLI::App& app);
Command add_info(CLI::App& app);
Command add_bench(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_formats(CLI::App& app);
Command add_schema(CLI::App& app);
Command add_materials(CLI::App& app);

}  // namespace crescente::app
