// Writing a file so that its place holds the old file or the whole new one, whatever happens.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/error.h"

namespace crescente {

// Whether `file` could be written by write_atomically: an existing folder with permission, no folder or device of that name, not
// write-protected. Leaves no trace. Errors: output.
Expected<void> can_write_file(const std::filesystem::path& file);

// A file that is written piece by piece beside its final place. A symbolic link is followed. Unless it is put there, it is removed again and the old
// one stays untouched. Errors: output, with the system's reason.
class AtomicFile {
public:
    static Expected<AtomicFile> beside(const std::filesystem::path& file);
    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    Expected<void> write(std::string_view content);
    // Syncs to disk and renames; the last thing to be done.
    Expected<void> put();

private:
    explicit AtomicFile(const std::filesystem::path& file);
    template <class Take>
    void with_free_name(Take take) const;

    std::filesystem::path file_, destination_, path_;  // as the user gave it, the end of links, the name beside it
    int descriptor_ = -1;
    bool nameless_ = false;  // without a name so far
};

// The same for content that is at hand.
Expected<void> write_atomically(const std::filesystem::path& file, std::string_view content);

}  // namespace crescente
