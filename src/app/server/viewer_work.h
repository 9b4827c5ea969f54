// What a viewer's thread has and does: it carries out orders, lets the picture grow in quanta between them, and shows it.
#pragma once

#include <chrono>

#include "app/server/export_job.h"
#include "app/server/file_library.h"
#include "app/server/frame_maker.h"
#include "app/server/scene_json.h"
#include "app/server/viewer.h"
#include "render/history.h"

namespace crescente::app {

class Viewer::Work {
public:
    Work(Viewer& box, ViewerSettings settings, Outlet outlet);
    void run();

private:
    using Clock = std::chrono::steady_clock;

    // --- viewer_work.cpp: the loop
    Orders take_orders();
    void serve(Orders orders);
    bool may_grow() const;
    bool has_work(Clock::time_point now) const;
    Clock::time_point wake_time() const;
    void grow();
    void show(bool quick);
    void tell_progress();
    void tell_scene();
    ReplyJson progress_json(const render::Stats& stats, double rays_per_second) const;

    // --- viewer_exports.cpp
    void begin_export(const Message& message, Export wanted);
    void cancel_export(std::uint32_t number);
    void tell_exports();

    // --- viewer_orders.cpp: what the page asks for
    void attach(std::uint32_t page);
    void carry_out(Message message);
    void take_view();
    bool take_look();  // whether there was one
    void edit(Message& message, const io::Json& json);
    void walk_history(const MessageId& id, int times, bool undo);
    void set_until(const MessageId& id, scene::Level level);
    void set_studio(const Message& message, const std::optional<std::string>& name);
    void set_ground(const Message& message, scene::Ground ground);
    void set_environment_file(const Message& message, const std::optional<std::string>& file);
    void replay(const MessageId& id, int x, int y);
    void apply(const Message& message, std::vector<scene::Edit> edits);
    Expected<render::EditReport> change_unseen(std::vector<scene::Edit> edits);  // what undo does not take back
    void keep_view();
    EditState edit_state() const { return {history_.undoable(), history_.redoable(), revision_}; }
    void after_edit(const render::EditReport& report, const SceneParts& parts);
    void open(const std::string& file, const MessageId& id);
    void note_sources(io::ShapeSources sources);
    void list_files(const MessageId& id, const std::optional<std::string>& folder);
    bool needs_session(const MessageId& id);
    void lose_scene(const Error& error);
    void say_error(const Error& error, const MessageId& id) { say_.text(error_reply(error, id)); }

    Viewer& box_;
    ViewerSettings settings_;
    Outlet say_;

    std::optional<render::Session> session_;
    render::History history_;
    std::string file_;          // that is open, as a path
    std::string title_;         // as the page knows it
    Problems warnings_;         // of reading it
    io::ShapeSources sources_;  // of its exact shapes; uploads by their names alone
    std::optional<Error> lost_; // why nothing is open, although something was, or was to be
    std::uint64_t revision_ = 0;

    bool begun_ = false;             // the model of the command line was opened
    bool paused_ = false;
    std::optional<Look> look_;       // the newest that was not taken yet
    std::optional<ViewSize> view_;
    ViewSize wanted_view_{};         // what the page asked for last; 0: nothing yet
    std::optional<scene::Level> wanted_level_;
    std::uint32_t looks_ = 0;        // number of the camera that is shown
    render::Progress progress_;

    FrameMaker frames_;
    std::uint32_t sent_ = 0, shown_ = 0;  // numbers of frames
    bool unshown_ = false;                // there may be something to send
    bool whole_first_ = false;            // nothing is sent before the whole picture is there
    Clock::time_point next_frame_{}, next_progress_{};

    bool opened_ = false;                 // the page does not know the scene that is open at all
    SceneParts untold_;                   // parts of the scene that the page does not know as they are
    ToldObjects told_objects_;
    bool progress_untold_ = false;
    double grown_seconds_ = 0;            // since the edit
    std::uint64_t rays_before_ = 0, camera_rays_before_ = 0, tiles_before_ = 0;  // at the edit
    std::uint64_t rays_told_ = 0;
    Clock::time_point rays_told_at_{};
    std::optional<std::uint64_t> fresh_from_;  // rays when all trees began anew, if nothing was edited since
    std::optional<std::uint64_t> fresh_rays_;

    struct Running {
        std::unique_ptr<ExportJob> job;
        MessageId id;
        double told = -1;
    };
    std::vector<Running> exports_;
    std::uint32_t last_export_ = 0;
    Clock::time_point next_exports_{};
};

}  // namespace crescente::app
