// How the library reports failure: values, never exceptions across a module's face, never prints.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

namespace crescente {

// One thing that is wrong, told so that a user can mend it.
struct Problem {
    std::string file;    // path as the user gave it; empty where no file is concerned
    std::string place;   // "line 12", "/materials/chrome/ior" (JSON pointer), "byte 80"; may be empty
    std::string reason;  // what is wrong, one sentence without a full stop
    std::string hint;    // what would be right: "did you mean 'roughness'?"; may be empty

    // "file: place: reason (hint)", leaving out what is empty.
    std::string text() const;
};
using Problems = std::vector<Problem>;

// What kind of failure; the application maps it to its exit code (docs/cli.md).
enum class ErrorKind {
    usage,        // the request itself is wrong (option, setting)
    input,        // a file that was read is wrong, or missing
    output,       // a result cannot be written
    unsupported,  // a valid request that this build cannot serve
    resource,     // memory, disk, threads
    internal,     // a defect in Crescente
};

// A failure with every problem found, not only the first.
struct Error {
    ErrorKind kind = ErrorKind::internal;
    Problems problems;

    std::string text() const;  // the problems, a line each
};

template <class T>
using Expected = tl::expected<T, Error>;

inline tl::unexpected<Error> failure(ErrorKind kind, Problem problem) {
    Error error{kind, {}};
    error.problems.push_back(std::move(problem));
    return tl::unexpected<Error>(std::move(error));
}

}  // namespace crescente
