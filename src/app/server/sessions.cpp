#include "app/server/sessions.h"

#include <algorithm>
#include <filesystem>

#include <boost/asio/post.hpp>

#include "app/server/guard.h"

namespace crescente::app {
namespace {

constexpr std::size_t key_bytes = 15;

}  // namespace

Sessions::Sessions(boost::asio::io_context& network, SessionLimits limits, std::filesystem::path folder, std::string token, SceneRequest request, std::shared_ptr<FileLibrary> files)
    : network_(network), limits_(limits), folder_(std::move(folder)), token_(std::move(token)), request_(std::move(request)), files_(std::move(files)), timer_(network) {
    look_around();
}

Sessions::Entry* Sessions::find(const std::string& key) {
    const auto found = entries_.find(key);
    return found == entries_.end() || found->second.stopping ? nullptr : &found->second;
}

Sessions::Entry* Sessions::begin() {
    if (ending_) return nullptr;
    if (entries_.size() >= limits_.most) {
        Entry* oldest = nullptr;
        for (auto& [key, entry] : entries_) {
            if (!entry.stopping && entry.page.expired() && (!oldest || entry.left < oldest->left)) oldest = &entry;
        }
        if (oldest) give_up(*oldest, "there are too many sessions");
        const auto stopping = static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(), [](const auto& e) { return e.second.stopping; }));
        if (entries_.size() - stopping >= limits_.most || entries_.size() >= 2 * limits_.most) return nullptr;
    }
    const std::string key = random_text(key_bytes);
    Entry& entry = entries_[key];
    entry.key = key;
    entry.folder = folder_ / key;
    entry.left = std::chrono::steady_clock::now();
    std::error_code error;
    for (const char* name : {"uploads", "exports"}) std::filesystem::create_directories(entry.folder / name, error);
    if (error) {
        entries_.erase(key);
        return nullptr;
    }
    Outlet outlet;
    outlet.send = [this, key](std::uint32_t page, Outlet::Kind kind, std::string message) {
        boost::asio::post(network_, [this, key, page, kind, message = std::move(message)]() mutable {
            const auto found = entries_.find(key);
            if (found == entries_.end() || found->second.pages != page) return;
            const auto channel = found->second.page.lock();
            if (!channel) return;
            if (kind == Outlet::Kind::text) channel->send_text(std::move(message));
            else if (kind == Outlet::Kind::news) channel->send_news(std::move(message));
            else channel->send_frame(std::move(message));
        });
    };
    outlet.backlog = [backlog = entry.backlog] { return backlog->load(); };
    outlet.ended = [this, key] {
        boost::asio::post(network_, [this, key] {
            const auto found = entries_.find(key);
            if (found == entries_.end()) return;
            found->second.viewer.reset();
            std::error_code ignored;
            std::filesystem::remove_all(found->second.folder, ignored);
            entries_.erase(found);
        });
    };
    entry.viewer = std::make_unique<Viewer>(ViewerSettings{key, token_, request_, files_, entry.folder / "uploads", entry.folder / "exports"}, std::move(outlet));
    return &entry;
}

void Sessions::attach(Entry& entry, const std::shared_ptr<Channel>& page) {
    if (const auto before = entry.page.lock()) before->close("the session was taken up by another page");
    entry.page = page;
    entry.viewer->attach(++entry.pages);
}

void Sessions::detach(const std::string& key, const Channel* page) {
    const auto found = entries_.find(key);
    if (found == entries_.end()) return;
    const auto now = found->second.page.lock();
    if (now && now.get() != page) return;  // another has taken it up
    found->second.page.reset();
    found->second.left = std::chrono::steady_clock::now();
    if (!found->second.stopping) found->second.viewer->attach(0);
}

void Sessions::give_up(Entry& entry, const std::string& reason) {
    if (entry.stopping) return;
    entry.stopping = true;
    if (const auto page = entry.page.lock()) page->close(reason);
    entry.viewer->stop();
}

void Sessions::look_around() {
    const auto now = std::chrono::steady_clock::now();
    for (auto& [key, entry] : entries_) {
        if (entry.page.expired() && now - entry.left > limits_.kept) give_up(entry, "no page took it up");
    }
    if (ending_) return;
    timer_.expires_after(std::chrono::milliseconds(500));
    timer_.async_wait([this](const boost::system::error_code&) { look_around(); });
}

void Sessions::end(const std::string& reason) {
    ending_ = true;
    for (auto& [key, entry] : entries_) give_up(entry, reason);
    timer_.cancel();
}

}  // namespace crescente::app
