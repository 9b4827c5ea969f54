// The sessions of the server: taken up by their key, kept for a while without a page, then freed. All on the network's thread.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "app/server/channel.h"
#include "app/server/viewer.h"

namespace crescente::app {

struct SessionLimits {
    std::size_t most = 8;
    std::chrono::duration<double> kept{300};  // without a page
    std::uint64_t upload = std::uint64_t{1} << 30;  // bytes of all files of a session
};

class Sessions {
public:
    struct Entry {
        std::string key;
        std::filesystem::path folder;  // its own, with "uploads" and "exports"
        std::unique_ptr<Viewer> viewer;
        std::shared_ptr<std::atomic<std::size_t>> backlog = std::make_shared<std::atomic<std::size_t>>(0);
        std::weak_ptr<Channel> page;
        std::uint32_t pages = 0;       // so many there were
        std::uint64_t uploaded = 0;    // bytes
        std::chrono::steady_clock::time_point left;  // when the last page went
        bool stopping = false;
    };

    // `folder`: a private one, for the folders of the sessions.
    Sessions(boost::asio::io_context& network, SessionLimits limits, std::filesystem::path folder, std::string token, SceneRequest request, std::shared_ptr<FileLibrary> files);

    // The session of the key; null if there is none, or it is being given up.
    Entry* find(const std::string& key);
    // A new one; where there are too many the one that has been without a page for longest is given up. Null if all have a page, or there is no place for its files.
    Entry* begin();
    // The page that looks now, in place of any other.
    void attach(Entry& entry, const std::shared_ptr<Channel>& page);
    // The page is gone.
    void detach(const std::string& key, const Channel* page);

    // Gives all up, tells the pages, and frees them; then there are no more.
    void end(const std::string& reason);
    bool empty() const { return entries_.empty(); }
    const SessionLimits& limits() const { return limits_; }

private:
    void give_up(Entry& entry, const std::string& reason);
    void look_around();

    boost::asio::io_context& network_;
    SessionLimits limits_;
    std::filesystem::path folder_;
    std::string token_;
    SceneRequest request_;
    std::shared_ptr<FileLibrary> files_;
    std::map<std::string, Entry> entries_;
    boost::asio::steady_timer timer_;
    bool ending_ = false;
};

}  // namespace crescente::app
