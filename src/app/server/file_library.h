// What a page may open: models in folders that the user allowed, examples, what was opened lately, and what was uploaded.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "app/server/replies.h"
#include "base/error.h"
#include "io/json_text.h"

namespace crescente::app {

// Shared by all viewers; any thread may ask.
class FileLibrary {
public:
    struct Places {
        std::vector<std::filesystem::path> folders;  // allowed as a whole
        std::vector<std::filesystem::path> files;    // allowed alone, with what lies beside them for reading the model only
        bool recent = true;                          // whether what was opened lately may be seen and opened
    };
    explicit FileLibrary(Places places);

    // A file to be read by its name: `upload/NAME` in the folder of uploads, `example/NAME`, or a path. Errors (input): it is not there, or not allowed; the two are told alike.
    Expected<std::filesystem::path> find(const std::string& name, const std::filesystem::path& uploads) const;

    // Whether a path, which need not exist, lies in an allowed folder or is an allowed file, after all links are followed.
    bool is_allowed(const std::filesystem::path& path, const std::filesystem::path& uploads) const;

    // The message `files`: of a folder, or of the start page. Errors (input): the folder is not allowed.
    Expected<ReplyJson> list(const std::optional<std::string>& folder, const std::filesystem::path& uploads) const;

    // Notes that the file was opened.
    void opened(const std::filesystem::path& file) const;

private:
    ReplyJson examples() const;
    ReplyJson recent() const;
    std::vector<std::filesystem::path> read_recent() const;

    Places places_;
    std::filesystem::path examples_, recent_list_;  // empty: there are none
    mutable std::mutex mutex_;                      // of the list of recent files
};

// Whether every file that an edit or a scene names (`image`, `profile`, `file`, `uri`) is allowed; `folder`: where relative paths begin. Errors (input): each that is not.
Expected<void> check_named_files(const io::Json& json, const FileLibrary& library, const std::filesystem::path& folder, const std::filesystem::path& uploads);

// The same for a model that was uploaded, and for those that it names in turn: nobody else vouches for it. Only formats that name files are looked into (native scenes, glTF as text).
Expected<void> check_upload(const std::filesystem::path& model, const FileLibrary& library, const std::filesystem::path& uploads);

}  // namespace crescente::app
