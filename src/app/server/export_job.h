// A picture, or the scene, made for download while the viewer goes on: a session of its own in a thread of its own.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <thread>

#include "base/error.h"
#include "io/formats.h"

namespace crescente::app {

class ExportJob {
public:
    // Begins at once, in few threads of low priority. `file`: where it goes; its extension says the format, ".json" the scene itself. The settings of the scene say size and level.
    // `sources` are those of the scene's exact shapes.
    ExportJob(std::uint32_t number, scene::Scene scene, io::ShapeSources sources, std::filesystem::path file);
    ~ExportJob();  // gives it up, if it is not done
    ExportJob(const ExportJob&) = delete;
    ExportJob& operator=(const ExportJob&) = delete;

    std::uint32_t number() const { return number_; }
    const std::filesystem::path& file() const { return file_; }
    double fraction() const { return fraction_; }
    bool is_done() const { return done_; }
    // Of one that is done.
    const Expected<void>& result() const { return result_; }

private:
    Expected<void> run(scene::Scene scene, const io::ShapeSources& sources);

    std::uint32_t number_;
    std::filesystem::path file_;
    std::atomic<double> fraction_ = 0;
    std::atomic<bool> stopping_ = false, done_ = false;
    Expected<void> result_;
    std::thread thread_;
};

// How many threads something in the background may have.
int background_threads();

}  // namespace crescente::app
