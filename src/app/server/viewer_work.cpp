#include "app/server/viewer_work.h"

#include <algorithm>
#include <new>

#include "render/level.h"

namespace crescente::app {
namespace {

constexpr auto quantum = std::chrono::milliseconds(4);
constexpr std::uint32_t most_unshown = 2;  // frames under way
constexpr std::size_t most_backlog = std::size_t{1} << 16;  // bytes of text, past which the scene waits
constexpr std::size_t most_undo = 1000;
constexpr auto between_progress = std::chrono::milliseconds(100);

const char* level_name(scene::Level level) { return render::levels()[static_cast<std::size_t>(level)].name; }

}  // namespace

Viewer::Work::Work(Viewer& box, ViewerSettings settings, Outlet outlet)
    : box_(box), settings_(std::move(settings)), say_(std::move(outlet)), history_(most_undo), frames_(0) {}

void Viewer::Work::run() {
    begun_ = settings_.request.file.empty();
    while (!box_.stopping_) {
        Orders orders = take_orders();
        if (box_.stopping_) return;
        // What is thrown past the libraries is the end of memory, or a defect: it costs the scene, not the server.
        try {
            serve(std::move(orders));
        } catch (const std::bad_alloc&) {
            lose_scene({ErrorKind::resource, {{"", "", "not enough memory for the scene: it was closed", "a smaller window, a lower level, --memory"}}});
        } catch (const std::exception& error) {
            lose_scene({ErrorKind::internal, {{"", "", std::string("defect in Crescente: ") + error.what(), "please report it; the scene was closed"}}});
        }
    }
}

void Viewer::Work::lose_scene(const Error& error) {
    exports_.clear();
    history_.forget();
    session_.reset();
    frames_.begin_anew();
    lost_ = error;
    say_error(error, {});
}

void Viewer::Work::serve(Orders orders) {
    if (orders.look) look_ = std::move(orders.look);
    if (orders.view) view_ = orders.view, wanted_view_ = *orders.view;
    if (orders.page) attach(*orders.page);
    if (!begun_ && say_.page) {  // once there is somebody to hear of it
        begun_ = true;
        open(settings_.request.file, {});
    }
    for (Message& message : orders.messages) carry_out(std::move(message));
    take_view();
    const bool looked = take_look();
    if (opened_) tell_scene();
    if (looked) show(true);  // what is known of the new view already
    grow();
    show(false);
    tell_scene();  // after the pixels, which the eye waits for
    tell_progress();
    tell_exports();
}

// Those that wait; if there is nothing else to do, the next ones.
Viewer::Orders Viewer::Work::take_orders() {
    std::unique_lock lock(box_.mutex_);
    const auto is_ordered = [&] { return box_.stopping_ || !box_.orders_.messages.empty() || box_.orders_.look || box_.orders_.view || box_.orders_.page; };
    if (!has_work(Clock::now())) {
        const auto wake = wake_time();
        if (wake == Clock::time_point::max()) box_.ordered_.wait(lock, is_ordered);
        else box_.ordered_.wait_until(lock, wake, is_ordered);
    }
    box_.hurry_ = false;
    box_.waiting_.store(0, std::memory_order_relaxed);
    return std::exchange(box_.orders_, {});
}

// A pause leaves a whole picture behind.
bool Viewer::Work::may_grow() const { return session_ && say_.page && !progress_.done && !(paused_ && progress_.first_picture); }

bool Viewer::Work::has_work(Clock::time_point now) const {
    if (!session_ || !say_.page) return false;
    if (may_grow()) return true;
    return wake_time() <= now;
}

Viewer::Work::Clock::time_point Viewer::Work::wake_time() const {
    auto wake = Clock::time_point::max();
    if (!session_ || !say_.page) return wake;
    if (!exports_.empty()) wake = next_exports_;
    if (unshown_ && sent_ - shown_ < most_unshown && !(whole_first_ && !progress_.first_picture)) wake = std::min(wake, next_frame_);
    if (progress_untold_) wake = std::min(wake, next_progress_);
    if (untold_.any()) wake = std::min(wake, Clock::now() + between_progress / 5);  // the page is slow: look again soon
    return wake;
}

void Viewer::Work::grow() {
    if (!may_grow()) return;
    const auto start = Clock::now();
    progress_ = session_->advance({start + quantum, &box_.hurry_});
    grown_seconds_ += std::chrono::duration<double>(Clock::now() - start).count();
    unshown_ = true;
    progress_untold_ = true;
    if (!progress_.done) return;
    if (fresh_from_) fresh_rays_ = session_->stats().rays.total() - *fresh_from_;
    next_frame_ = next_progress_ = Clock::now();
}

void Viewer::Work::show(bool quick) {
    if (!session_ || !say_.page || !unshown_ || sent_ - shown_ >= most_unshown || Clock::now() < next_frame_) return;
    if (whole_first_ && !progress_.first_picture) return;
    whole_first_ = false;
    const auto start = Clock::now();
    unshown_ = false;
    // A quarter of the time at most goes into showing.
    const auto take_time = [&] {
        constexpr auto shortest = std::chrono::milliseconds(20);
        next_frame_ = Clock::now() + std::max<Clock::duration>(shortest, 3 * (Clock::now() - start));
    };
    if (!frames_.look(*session_, progress_.done)) return take_time();
    auto bytes = frames_.make(sent_ + 1, looks_, quick);
    if (!bytes) return say_error(bytes.error(), {});
    ++sent_;
    say_.frame(std::move(*bytes));
    unshown_ = quick;  // all of its pixels are to follow
    take_time();
}

void Viewer::Work::tell_scene() {
    if (!session_ || !say_.page || !untold_.any() || say_.backlog() > most_backlog) return;
    if (opened_) told_objects_.forget();
    ReplyJson json = scene_json(session_->scene(), std::exchange(untold_, {}), told_objects_);
    if (std::exchange(opened_, false)) json["opened"] = true;
    json["file"] = title_;
    json["revision"] = revision_;
    json["can_undo"] = history_.undoable();
    json["can_redo"] = history_.redoable();
    if (!warnings_.empty()) json["warnings"] = problems_json(std::exchange(warnings_, {}));
    say_.text(reply("scene", std::move(json)));
}

void Viewer::Work::tell_progress() {
    const auto now = Clock::now();
    if (!session_ || !say_.page || !progress_untold_ || now < next_progress_) return;
    const render::Stats stats = session_->stats();
    const std::uint64_t rays = stats.rays.total();
    const double seconds = std::chrono::duration<double>(now - rays_told_at_).count();
    const double rate = rays >= rays_told_ && seconds > 0 ? static_cast<double>(rays - rays_told_) / seconds : 0;
    say_.news(reply("progress", progress_json(stats, rate)));
    rays_told_ = rays;
    rays_told_at_ = now;
    progress_untold_ = false;
    next_progress_ = now + between_progress;
}

ReplyJson Viewer::Work::progress_json(const render::Stats& stats, double rays_per_second) const {
    const std::uint64_t rays = stats.rays.total();
    return {{"level", progress_.level},
            {"fraction", progress_.fraction},
            {"until", level_name(session_->scene().settings.level)},
            {"done", progress_.done},
            {"paused", paused_},
            {"first_picture", progress_.first_picture},
            {"seconds", grown_seconds_},
            {"rays", rays},
            {"rays_per_second", rays_per_second},
            {"bytes", stats.forest_bytes + stats.accelerator_bytes},
            {"nodes", stats.nodes},
            {"edit_rays", rays - rays_before_},
            {"edit_camera_rays", stats.rays.camera >= camera_rays_before_ ? stats.rays.camera - camera_rays_before_ : 0},
            {"edit_tiles", stats.revised_tiles - tiles_before_},
            {"fresh_rays", fresh_rays_ ? ReplyJson(*fresh_rays_) : ReplyJson(nullptr)}};
}

}  // namespace crescente::app
