// Exports of a viewer.
#include <algorithm>

#include "app/server/viewer_work.h"
#include "io/edit_text.h"

namespace crescente::app {
namespace {

constexpr std::size_t most_running = 4;
constexpr std::uint32_t most_kept = 16;

std::string exported_name(const std::string& file, const std::string& format) {
    std::string stem = std::filesystem::path(file).stem().string();
    std::replace_if(stem.begin(), stem.end(), [](unsigned char c) { return c < 0x20 || c == '"' || c == '\\' || c >= 0x7f; }, '_');  // the name goes into a header
    return (stem.empty() ? "scene" : stem) + "." + format;
}

}  // namespace

void Viewer::Work::begin_export(const Message& message, Export wanted) {
    if (exports_.size() >= most_running) return say_error({ErrorKind::resource, {{"", "/export", std::to_string(most_running) + " exports are being made", "wait for one, or cancel it"}}}, message.id);
    scene::Scene scene = session_->scene();
    std::vector<scene::Edit> edits;
    if (wanted.camera) {
        io::Json edit = io::Json::make_object();
        edit.object()->push_back({"camera", std::move(*wanted.camera)});
        auto camera = io::read_edit(edit, scene, {});
        if (!camera) return say_error(camera.error(), message.id);
        edits = std::move(*camera);
    }
    if (wanted.format != "json") {
        scene::Settings settings = scene.settings;
        settings.width = wanted.width, settings.height = wanted.height;
        settings.level = wanted.level;
        edits.push_back(scene::SetSettings{settings});
    }
    if (const auto applied = scene::apply(std::move(edits), scene); !applied) return say_error(applied.error(), message.id);
    const std::uint32_t number = ++last_export_;
    std::error_code error;
    if (number > most_kept) std::filesystem::remove_all(settings_.exports / std::to_string(number - most_kept), error);
    const auto folder = settings_.exports / std::to_string(number);
    std::filesystem::create_directories(folder, error);
    exports_.push_back({std::make_unique<ExportJob>(number, std::move(scene), sources_, folder / exported_name(file_, wanted.format)), message.id, -1});
    next_exports_ = Clock::now();
}

void Viewer::Work::cancel_export(std::uint32_t number) {
    std::erase_if(exports_, [&](const Running& running) {
        if (running.job->number() != number) return false;
        std::error_code ignored;
        std::filesystem::remove_all(running.job->file().parent_path(), ignored);
        return true;
    });
}

void Viewer::Work::tell_exports() {
    constexpr auto between = std::chrono::milliseconds(100);
    const auto now = Clock::now();
    if (exports_.empty() || !say_.page || now < next_exports_) return;
    next_exports_ = now + between;
    std::erase_if(exports_, [&](Running& running) {
        const ExportJob& job = *running.job;
        if (!job.is_done()) {
            if (job.fraction() != running.told) say_.news(reply("exporting", {{"number", job.number()}, {"fraction", running.told = job.fraction()}}));
            return false;
        }
        if (!job.result()) {
            Error told = job.result().error();
            for (Problem& problem : told.problems) problem.file = std::filesystem::path(problem.file).filename().string();
            say_error(told, running.id);
            return true;
        }
        std::error_code error;
        say_.text(reply("exported",
                        {{"number", job.number()},
                         {"name", job.file().filename().string()},
                         {"bytes", std::filesystem::file_size(job.file(), error)},
                         {"address", "export/" + settings_.key + "/" + std::to_string(job.number()) + "?token=" + settings_.token}},
                        running.id));
        return true;
    });
}

}  // namespace crescente::app
