// What the program says about failure: the only place that prints errors and chooses exit codes.
#pragma once

#include "base/error.h"

namespace crescente::app {

// docs/cli.md documents these.
enum ExitCode : int {
    exit_ok = 0,
    exit_different = 1,   // pictures that must be equal are not
    exit_usage = 2,
    exit_input = 3,
    exit_output = 4,
    exit_unsupported = 5,
    exit_resource = 6,
    exit_internal = 70,
    exit_stopped = 130,  // as shells report a program that ended by Ctrl-C
};

ExitCode exit_code(ErrorKind kind);

// Prints every problem to stderr as "error: file: place: reason (hint)" and returns the exit code.
ExitCode fail(const Error& error);

// Prints what a reader could not honour, likewise.
void warn(const Problems& warnings);

// Prints something worth knowing that is not wrong.
void note(const std::string& text);

}  // namespace crescente::app
