#include "app/cli/report.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace crescente::app {
namespace {

spdlog::logger& log() {
    static spdlog::logger logger = [] {
        auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();  // colours on terminals only
        sink->set_pattern("%^%l%$: %v");
        return spdlog::logger("crescente", std::move(sink));
    }();
    return logger;
}

}  // namespace

ExitCode exit_code(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::usage: return exit_usage;
        case ErrorKind::input: return exit_input;
        case ErrorKind::output: return exit_output;
        case ErrorKind::unsupported: return exit_unsupported;
        case ErrorKind::resource: return exit_resource;
        case ErrorKind::internal: return exit_internal;
    }
    return exit_internal;
}

ExitCode fail(const Error& error) {
    for (const Problem& problem : error.problems) log().error(problem.text());
    return exit_code(error.kind);
}

void warn(const Problems& warnings) {
    for (const Problem& warning : warnings) log().warn(warning.text());
}

void note(const std::string& text) { log().info(text); }

}  // namespace crescente::app
