// The options that keep a render in a file, so that a stop or a crash loses little, and what they do.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "render/checkpoint.h"
#include "render/session.h"

namespace crescente::app {

// As the user wrote them.
struct CheckpointOptions {
    std::string file;
    std::optional<std::string> every;
    bool resume = false, fresh = false;
};

// Declares the options; `options` must outlive the parsing.
void add_checkpoint_options(CLI::App& command, CheckpointOptions& options);

// What they ask for.
struct CheckpointRequest {
    std::string file;                              // empty: no checkpoints
    std::chrono::duration<double> every{60};       // between two of them
    bool resume = false;                           // go on from the file
    bool fresh = false;                            // begin afresh where that cannot be, or without `resume`: whatever checkpoint is there
};

// Every problem of the options at once (usage).
Expected<CheckpointRequest> understand(const CheckpointOptions& options);

// What can be told before a model is read: a file that cannot be written, is none of ours, would be lost, or cannot be gone on from.
Expected<void> check(const CheckpointRequest& request);

class Checkpoints {
public:
    explicit Checkpoints(CheckpointRequest request) : request_(std::move(request)) {}

    // The head of the file that is to be gone on from; nothing if the render begins afresh. Errors: as of begin().
    Expected<std::optional<render::CheckpointHead>> head();

    // Takes the forest of the file into the session, if that was asked for. A file that does not fit is an error, or a warning where the user allows to
    // begin afresh.
    Expected<void> begin(render::Session& session);

    // What keeps a render from going on: an error, with what to do about it, or, where the user allows to begin afresh, a warning.
    Expected<void> refuse(Error error);

    // Saves if it is time to. What fails is told; the last checkpoint stays, and the next is tried when its time comes.
    // `note`: as of Session::save.
    void look(render::Session& session, const std::string& note = {});

    // Saves what there is at the end, complete or not.
    Expected<void> end(render::Session& session, const std::string& note = {});

    bool wanted() const { return !request_.file.empty(); }
    const std::string& file() const { return request_.file; }
    bool resumed() const { return resumed_; }
    const render::RayCounts& rays_before() const { return rays_before_; }  // traced by the runs that this one goes on from
    nlohmann::ordered_json json() const;

private:
    using Clock = std::chrono::steady_clock;
    bool goes_on() const;  // from a file
    Expected<void> save(render::Session& session, const std::string& note);

    CheckpointRequest request_;
    Clock::time_point last_ = Clock::now();
    render::RayCounts rays_before_;
    bool resumed_ = false;
    std::uint64_t saved_ = 0, bytes_ = 0;  // times; of the last one
    double save_seconds_ = 0, resume_seconds_ = 0;
};

}  // namespace crescente::app
