#include "app/cli/edit_report.h"

#include <algorithm>
#include <cstdio>

#include "app/cli/quantities.h"
#include "app/cli/stats_json.h"

namespace crescente::app {
namespace {

std::string count(std::uint64_t n) { return human_count(static_cast<double>(n)); }

std::string percent(double part, double whole) {
    if (!(whole > 0)) return "-";
    char text[32];
    std::snprintf(text, sizeof text, "%.1f %%", 100 * part / whole);
    return text;
}

std::string time_or_dash(const std::optional<double>& seconds) {
    if (!seconds) return "-";
    if (*seconds >= 0.01) return human_time(*seconds);
    char text[32];
    std::snprintf(text, sizeof text, "%.2f ms", *seconds * 1000);
    return text;
}

// The beginning of a line's text, never half a character.
std::string shortened(const std::string& text) {
    constexpr std::size_t longest = 70;
    if (text.size() <= longest) return text;
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return text.substr(0, end) + "...";
}

std::string row(const std::string& line, const std::string& tiles, const std::string& trees, const render::RayCounts* rays, const std::string& ray_share,
                const std::string& first, const std::string& converged, const std::string& time_share, const std::string& what) {
    const auto of = [&](const char* head, std::uint64_t render::RayCounts::*member) { return rays ? count(rays->*member) : std::string(head); };
    char text[256];
    std::snprintf(text, sizeof text, "%5s  %9s  %-5s %9s %9s %9s %9s %9s %9s %9s %9s  ", line.c_str(), tiles.c_str(), trees.c_str(),
                  of("camera", &render::RayCounts::camera).c_str(), of("reflected", &render::RayCounts::reflected).c_str(),
                  of("refracted", &render::RayCounts::refracted).c_str(), of("shadow", &render::RayCounts::shadow).c_str(), ray_share.c_str(), first.c_str(),
                  converged.c_str(), time_share.c_str());
    return text + what + "\n";
}

struct Sums {
    render::RayCounts rays;
    double seconds = 0;
    std::size_t converged = 0;
};
Sums sums_of(const std::vector<PlayedEdit>& edits) {
    Sums sums;
    for (const PlayedEdit& edit : edits) {
        sums.rays += edit.rays;
        if (!edit.converged) continue;
        sums.seconds += *edit.converged;
        ++sums.converged;
    }
    return sums;
}

}  // namespace

std::string report_head(const scene::Settings& settings, std::size_t tiles, int threads, const FreshRender& fresh) {
    return std::to_string(settings.width) + "x" + std::to_string(settings.height) + ", " + std::to_string(tiles) + " tiles, " + std::to_string(threads) +
           (threads == 1 ? " thread\n" : " threads\n") +
           row("line", "tiles", "trees", nullptr, "of fresh", "first", "converged", "of fresh", "edit") +
           row("", std::to_string(tiles), "", &fresh.rays, "", "", time_or_dash(fresh.seconds), "", "(fresh render)");
}

std::string report_row(const PlayedEdit& edit, std::size_t tiles, const FreshRender& fresh) {
    return row(std::to_string(edit.line), std::to_string(edit.tiles) + "/" + std::to_string(tiles), edit.began_anew ? "anew" : "kept", &edit.rays,
               percent(static_cast<double>(edit.rays.total()), static_cast<double>(fresh.rays.total())), time_or_dash(edit.first), time_or_dash(edit.converged),
               edit.converged ? percent(*edit.converged, fresh.seconds) : "-", shortened(edit.text));
}

std::string report_sums(const std::vector<PlayedEdit>& edits, const FreshRender& fresh) {
    const Sums sums = sums_of(edits);
    const auto anew = std::count_if(edits.begin(), edits.end(), [](const PlayedEdit& e) { return e.began_anew; });
    const auto whole = static_cast<double>(edits.size());
    return std::to_string(edits.size()) + (edits.size() == 1 ? " edit" : " edits") + " (" + std::to_string(anew) + " anew, " +
           std::to_string(edits.size() - sums.converged) + " not converged): " + count(sums.rays.total()) + " rays, " +
           percent(static_cast<double>(sums.rays.total()), whole * static_cast<double>(fresh.rays.total())) + " of as many fresh renders; " +
           human_time(sums.seconds) + ", " + percent(sums.seconds, static_cast<double>(sums.converged) * fresh.seconds) + " of those that converged\n";
}

nlohmann::ordered_json fresh_json(const FreshRender& fresh) { return {{"rays", rays_json(fresh.rays)}, {"time", fresh.seconds}}; }

nlohmann::ordered_json edits_json(const std::vector<PlayedEdit>& edits, const FreshRender& fresh) {
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    const auto share = [](double part, double whole) { return whole > 0 ? Json(part / whole) : Json(nullptr); };
    const auto or_null = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
    for (const PlayedEdit& edit : edits) {
        list.push_back({{"line", edit.line},
                        {"edit", edit.text},
                        {"tiles", edit.tiles},
                        {"began_anew", edit.began_anew},
                        {"accelerator_kept", edit.accelerator_kept},
                        {"rays", rays_json(edit.rays)},
                        {"rays_of_fresh", share(static_cast<double>(edit.rays.total()), static_cast<double>(fresh.rays.total()))},
                        {"time", {{"edit", edit.edit_seconds}, {"first", or_null(edit.first)}, {"converged", or_null(edit.converged)}}},
                        {"time_of_fresh", edit.converged ? share(*edit.converged, fresh.seconds) : Json(nullptr)}});
    }
    return list;
}

nlohmann::ordered_json sums_json(const std::vector<PlayedEdit>& edits) {
    const Sums sums = sums_of(edits);
    return {{"edits", edits.size()}, {"converged", sums.converged}, {"rays", rays_json(sums.rays)}, {"time", sums.seconds}};
}

}  // namespace crescente::app
