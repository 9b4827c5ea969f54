#include "app/cli/stats_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace crescente::app {
namespace {

namespace fs = std::filesystem;

nlohmann::ordered_json rays_json(const render::RayCounts& rays) {
    return {{"camera", rays.camera}, {"reflected", rays.reflected}, {"refracted", rays.refracted},
            {"shadow", rays.shadow}, {"total", rays.total()}};
}

tl::unexpected<Error> unwritable(const fs::path& file, const std::string& reason) {
    return failure(ErrorKind::output, {file.string(), "", reason, ""});
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

bool write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return fsync(descriptor) == 0;
}

}  // namespace

nlohmann::ordered_json stats_json(const render::Stats& stats) {
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const auto& level : stats.levels) {
        levels.push_back({{"name", level.name}, {"time", level.seconds}, {"rays", rays_json(level.rays)}});
    }
    return {
        {"threads", stats.threads},
        {"rays", rays_json(stats.rays)},
        {"nodes", stats.nodes},
        {"bytes_per_pixel", stats.bytes_per_pixel},
        {"levels", std::move(levels)},
        {"tests",
         {{"box", stats.tests.box_tests},
          {"shape", stats.tests.shape_tests},
          {"shadow_cache_hits", stats.tests.shadow_cache_hits},
          {"shortcut_rays", stats.tests.shortcut_rays},
          {"shortcut_wrong", stats.tests.shortcut_wrong}}},
        {"memory",
         {{"forest", stats.forest_bytes},
          {"peak_forest", stats.peak_forest_bytes},
          {"accelerator", stats.accelerator_bytes},
          {"dropped_tiles", stats.dropped_tiles}}},
    };
}

Expected<void> can_write_text(const fs::path& file) {
    std::error_code error;
    const fs::path folder = folder_of(file);
    if (!fs::is_directory(folder, error)) return unwritable(file, "there is no folder '" + folder.string() + "'");
    // Renaming over a device or a pipe would destroy it.
    const auto status = fs::status(file, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) return unwritable(file, "it exists and is not a regular file");
    if (access(folder.c_str(), W_OK | X_OK) != 0) {
        return unwritable(file, "the folder '" + folder.string() + "' cannot be written: " + std::strerror(errno));
    }
    return {};
}

Expected<void> write_text(const fs::path& file, const std::string& text) {
    std::string part = file.string() + ".XXXXXX.part";
    const int descriptor = mkostemps(part.data(), 5, O_CLOEXEC);  // 5: ".part" stays
    if (descriptor < 0) return unwritable(file, std::strerror(errno));
    const mode_t mask = umask(0);
    umask(mask);
    fchmod(descriptor, 0666 & ~mask);
    const bool written = write_all(descriptor, text);
    const bool closed = close(descriptor) == 0;
    if (!written || !closed || std::rename(part.c_str(), file.c_str()) != 0) {
        const std::string reason = std::strerror(errno);
        unlink(part.c_str());
        return unwritable(file, reason);
    }
    return {};
}

}  // namespace crescente::app
