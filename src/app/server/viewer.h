// One viewer: a session of the engine in a thread of its own, the orders that come in for it, and what it says to the page.
//
// Any thread may give orders; they wait in a box that is never locked while anything is rendered. All else belongs to the viewer's thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "app/cli/scene_options.h"
#include "app/server/message.h"

namespace crescente::app {

class FileLibrary;

// How a viewer speaks to the page. Its functions are called by the viewer's thread, and do not block.
struct Outlet {
    enum class Kind {
        text,   // must arrive
        news,   // may be replaced by a newer one of its name while the page is slow
        frame,  // binary
    };
    std::function<void(std::uint32_t page, Kind kind, std::string message)> send;
    std::function<std::size_t()> backlog;  // bytes of text that the page has not taken yet
    std::function<void()> ended;           // the thread's last act
    std::uint32_t page = 0;                // the one that is attached: what was meant for one before must not reach the next

    void text(std::string message) const { send(page, Kind::text, std::move(message)); }
    void news(std::string message) const { send(page, Kind::news, std::move(message)); }
    void frame(std::string message) const { send(page, Kind::frame, std::move(message)); }
};

// What a viewer is made with.
struct ViewerSettings {
    std::string key, token;              // of the session and of the server, in addresses
    SceneRequest request;                // how scenes are read; its file is what is opened at first, if there is one
    std::shared_ptr<FileLibrary> files;  // what may be opened
    std::filesystem::path uploads;       // folder of what the page uploaded
    std::filesystem::path exports;       // folder for exports; both are there as long as the viewer is
};

class Viewer {
public:
    Viewer(ViewerSettings settings, Outlet outlet);
    ~Viewer();  // waits for the thread to end
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    void give(Message message);
    // Page number so much is there, from 1, which has seen nothing yet. Without a page (0) nothing grows.
    void attach(std::uint32_t page);
    // Ends the thread soon; `ended` is called.
    void stop();
    // Orders that wait: who reads from a page stops reading while there are many.
    std::size_t waiting() const { return waiting_.load(std::memory_order_relaxed); }

private:
    class Work;  // the thread's own
    struct Orders {
        std::deque<Message> messages;
        std::optional<Look> look;       // the newest
        std::optional<ViewSize> view;
        std::optional<std::uint32_t> page;  // that was attached
    };
    void order(const std::function<void(Orders&)>& put, bool at_once);

    std::mutex mutex_;
    std::condition_variable ordered_;
    Orders orders_;
    std::atomic<std::size_t> waiting_ = 0;
    std::atomic<bool> hurry_ = false;  // an order that should not wait for the end of a quantum
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace crescente::app
