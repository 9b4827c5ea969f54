#include "app/cli/checkpoints.h"

#include <filesystem>
#include <system_error>

#include "app/cli/quantities.h"
#include "app/cli/report.h"
#include "app/cli/stats_json.h"
#include "base/atomic_file.h"

namespace crescente::app {
namespace {

bool is_there(const std::string& file) {
    std::error_code code;
    return std::filesystem::exists(file, code);
}

Error with_way_out(Error error) {
    for (Problem& problem : error.problems) {
        if (problem.hint.empty()) problem.hint = "--resume --fresh begins afresh and replaces it";
    }
    return error;
}

}  // namespace

void add_checkpoint_options(CLI::App& command, CheckpointOptions& options) {
    command.add_option("--checkpoint", options.file, "Keep the state of the render in this file, every minute and at the end")->option_text("FILE");
    command.add_option("--checkpoint-every", options.every, "Time between two checkpoints (30s, 10m)")->option_text("TIME");
    command.add_flag("--resume", options.resume, "Go on from the checkpoint");
    command.add_flag("--fresh", options.fresh, "Begin afresh and replace a checkpoint; with --resume: only where there is none that fits");
}

Expected<CheckpointRequest> understand(const CheckpointOptions& options) {
    CheckpointRequest request{options.file, {}, options.resume, options.fresh};
    request.every = CheckpointRequest{}.every;
    Problems problems;
    if (options.every) {
        if (const auto every = parse_duration("--checkpoint-every", *options.every)) request.every = *every;
        else problems = every.error().problems;
    }
    const std::pair<bool, const char*> dependent[] = {{options.every.has_value(), "--checkpoint-every"}, {options.resume, "--resume"}, {options.fresh, "--fresh"}};
    for (const auto& [given, option] : dependent) {
        if (given && options.file.empty()) problems.push_back({"", option, "there is no checkpoint", "name its file by --checkpoint"});
    }
    if (!problems.empty()) return tl::unexpected<Error>({ErrorKind::usage, std::move(problems)});
    return request;
}

Expected<void> check(const CheckpointRequest& request) {
    if (request.file.empty()) return {};
    if (auto writable = can_write_file(request.file); !writable) return writable;
    if (!is_there(request.file)) {
        if (!request.resume || request.fresh) return {};
        return failure(ErrorKind::input, {request.file, "", "there is no such checkpoint", "--resume --fresh begins afresh where there is none"});
    }
    if (!render::is_checkpoint(request.file)) {
        return failure(ErrorKind::output, {request.file, "", "is there already and no checkpoint: it is not overwritten", "name another file"});
    }
    if (request.fresh) return {};
    if (!request.resume) {
        return failure(ErrorKind::output, {request.file, "", "there is a checkpoint already", "--resume goes on from it, --fresh begins afresh and replaces it"});
    }
    return render::read_checkpoint_head(request.file).map([](const render::CheckpointHead&) {}).map_error(with_way_out);
}

Expected<void> Checkpoints::refuse(Error error) {
    if (!request_.fresh) return tl::unexpected(with_way_out(std::move(error)));
    warn(error.problems);
    note("begins afresh: " + request_.file + " will be replaced");
    request_.resume = false;
    return {};
}

bool Checkpoints::goes_on() const { return request_.resume && !(request_.fresh && !is_there(request_.file)); }

Expected<std::optional<render::CheckpointHead>> Checkpoints::head() {
    if (!goes_on()) return std::nullopt;
    auto head = render::read_checkpoint_head(request_.file);
    if (head) return std::move(*head);
    return refuse(std::move(head.error())).map([] { return std::optional<render::CheckpointHead>(); });
}

Expected<void> Checkpoints::begin(render::Session& session) {
    const auto start = last_ = Clock::now();
    if (!goes_on()) return {};
    if (auto restored = session.restore(request_.file); !restored) return refuse(std::move(restored.error()));
    resumed_ = true;
    rays_before_ = session.stats().rays;
    last_ = Clock::now();
    resume_seconds_ = std::chrono::duration<double>(last_ - start).count();
    return {};
}

void Checkpoints::look(render::Session& session, const std::string& note) {
    if (!wanted() || Clock::now() - last_ < request_.every) return;
    if (const auto saved = save(session, note); !saved) warn(saved.error().problems);
}

Expected<void> Checkpoints::end(render::Session& session, const std::string& note) {
    if (!wanted()) return {};
    return save(session, note);
}

Expected<void> Checkpoints::save(render::Session& session, const std::string& note) {
    const auto start = Clock::now();
    const auto size = session.save(request_.file, note);
    last_ = Clock::now();
    if (!size) return tl::unexpected(size.error());
    ++saved_;
    bytes_ = *size;
    save_seconds_ += std::chrono::duration<double>(last_ - start).count();
    return {};
}

nlohmann::ordered_json Checkpoints::json() const {
    return {{"file", request_.file}, {"resumed", resumed_}, {"rays_before", rays_json(rays_before_)}, {"saved", saved_}, {"bytes", bytes_},
            {"time", {{"save", save_seconds_}, {"resume", resume_seconds_}}}};
}

}  // namespace crescente::app
