#include "app/server/export_job.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <new>

#include "app/cli/picture_options.h"
#include "base/atomic_file.h"
#include "io/image_file.h"
#include "io/scene_file.h"
#include "render/session.h"

namespace crescente::app {
int background_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / 4); }

ExportJob::ExportJob(std::uint32_t number, scene::Scene scene, io::ShapeSources sources, std::filesystem::path file) : number_(number), file_(std::move(file)) {
    thread_ = std::thread([this, made = std::move(scene), from = std::move(sources)]() mutable {
        constexpr int patient = 10;
        setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), patient);  // of this thread alone, as Linux has it; if that fails it is merely less polite
        try {
            result_ = run(std::move(made), from);
        } catch (const std::bad_alloc&) {
            result_ = failure(ErrorKind::resource, {file_.filename().string(), "", "not enough memory", "try a smaller picture"});
        }
        done_ = true;
    });
}

ExportJob::~ExportJob() {
    stopping_ = true;
    thread_.join();
}

Expected<void> ExportJob::run(scene::Scene scene, const io::ShapeSources& sources) {
    if (file_.extension() == ".json") return write_atomically(file_, io::write_scene_text(scene, sources));
    const bool layers = needs_all_layers({file_.string()});
    if (const auto writable = check_alpha({file_.string()}, scene); !writable) return writable;
    if (const auto writable = io::can_write(file_); !writable) return writable;
    prefer_finish(scene.settings, layers);
    scene.settings.threads = background_threads();
    auto session = render::Session::open(std::move(scene));
    if (!session) return tl::unexpected(session.error());
    render::Progress progress;
    while (!progress.done) {
        constexpr auto between = std::chrono::milliseconds(50);
        progress = session->advance({std::chrono::steady_clock::now() + between, &stopping_});
        fraction_ = progress.fraction;
        if (stopping_) return {};
    }
    const scene::Image picture = session->picture(layers);
    io::ImageOptions how = image_options({}, session->scene(), picture);
    how.metadata = {{"Software", std::string("Crescente ") + CRESCENTE_VERSION}};
    return io::write_image(picture, file_, how);
}

}  // namespace crescente::app
