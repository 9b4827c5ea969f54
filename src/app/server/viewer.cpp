#include "app/server/viewer.h"

#include <sys/resource.h>
#include <unistd.h>

#include "app/server/viewer_work.h"

namespace crescente::app {

Viewer::Viewer(ViewerSettings settings, Outlet outlet) {
    thread_ = std::thread([this, settings = std::move(settings), outlet = std::move(outlet)]() mutable {
        const auto ended = outlet.ended;
        // Of this thread, and of those that it makes to render: a browser on the same machine has to draw what they send.
        constexpr int behind_the_page = 5;
        setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), behind_the_page);
        Work(*this, std::move(settings), std::move(outlet)).run();
        ended();
    });
}

Viewer::~Viewer() {
    stop();
    thread_.join();
}

void Viewer::order(const std::function<void(Orders&)>& put, bool at_once) {
    {
        const std::lock_guard lock(mutex_);
        put(orders_);
        waiting_.store(orders_.messages.size(), std::memory_order_relaxed);
    }
    if (at_once) hurry_ = true;
    ordered_.notify_one();
}

void Viewer::give(Message message) {
    if (message.request) {
        if (auto* look = std::get_if<Look>(&*message.request)) return order([&](Orders& o) { o.look = std::move(*look); }, true);
        if (auto* view = std::get_if<ViewSize>(&*message.request)) return order([&](Orders& o) { o.view = *view; }, false);
        if (std::holds_alternative<FrameShown>(*message.request)) return order([&](Orders& o) { o.messages.push_back(std::move(message)); }, false);
    }
    order([&](Orders& o) { o.messages.push_back(std::move(message)); }, true);
}

void Viewer::attach(std::uint32_t page) {
    order([page](Orders& o) { o.page = page; }, true);
}

void Viewer::stop() {
    stopping_ = true;
    order([](Orders&) {}, true);
}

}  // namespace crescente::app
