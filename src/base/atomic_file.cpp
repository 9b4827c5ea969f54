#include "base/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace crescente {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot_write(const fs::path& file, const std::string& reason, std::string hint = {}) {
    return failure(ErrorKind::output, {file.string(), {}, "cannot be written: " + reason, std::move(hint)});
}

std::string reason_of(int code) { return std::generic_category().message(code); }

// Where the content really goes: the end of a symbolic link.
fs::path destination_of(const fs::path& file) {
    std::error_code error;
    if (!fs::is_symlink(file, error)) return file;
    fs::path target = fs::weakly_canonical(file, error);
    return error ? file : target;
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path{"."}; }

}  // namespace

Expected<void> can_write_file(const fs::path& file) {
    if (!file.has_filename()) return cannot_write(file, "it names no file");
    const fs::path destination = destination_of(file);
    const fs::path folder = folder_of(destination);
    struct stat status {};
    if (stat(folder.c_str(), &status) != 0) {
        return cannot_write(file, "the folder " + folder.string() + ": " + reason_of(errno));
    }
    if (!S_ISDIR(status.st_mode)) return cannot_write(file, folder.string() + " is not a folder");
    if (faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
        return cannot_write(file, "the folder " + folder.string() + ": " + reason_of(errno));
    }
    if (stat(destination.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode)) return cannot_write(file, "it is a folder");
        if (!S_ISREG(status.st_mode)) return cannot_write(file, "it is not a regular file");
        if (faccessat(AT_FDCWD, destination.c_str(), W_OK, AT_EACCESS) != 0) return cannot_write(file, reason_of(errno));
    } else if (errno != ENOENT) {
        return cannot_write(file, reason_of(errno));
    }
    return {};
}

// Tries names beside the destination until one is not taken, or something else is in the way.
template <class Take>
void AtomicFile::with_free_name(Take take) const {
    static std::atomic<unsigned> counter{0};  // only makes names differ
    constexpr int tries = 100;
    for (int i = 0; i < tries; ++i) {
        if (take(folder_of(destination_) / (".crescente-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".part")) || errno != EEXIST) return;
    }
}

AtomicFile::AtomicFile(const fs::path& file) : file_(file), destination_(destination_of(file)) {
    // Without a name, where the system can do that: nothing is left of it then even if the program is killed.
    if (access("/proc/self/fd", X_OK) == 0) descriptor_ = open(folder_of(destination_).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
    nameless_ = descriptor_ >= 0;
    if (nameless_) return;
    with_free_name([&](const fs::path& path) {
        path_ = path;
        descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        return descriptor_ >= 0;
    });
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : file_(std::move(other.file_)), destination_(std::move(other.destination_)), path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)),
      nameless_(other.nameless_) {}

AtomicFile::~AtomicFile() {
    if (descriptor_ < 0) return;
    close(descriptor_);
    if (!nameless_) unlink(path_.c_str());
}

Expected<AtomicFile> AtomicFile::beside(const fs::path& file) {
    if (const auto possible = can_write_file(file); !possible) return tl::unexpected(possible.error());
    AtomicFile made(file);
    if (made.descriptor_ < 0) return cannot_write(file, reason_of(errno));
    return made;
}

Expected<void> AtomicFile::write(std::string_view content) {
    while (!content.empty()) {
        const ssize_t n = ::write(descriptor_, content.data(), content.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return cannot_write(file_, reason_of(errno));
        content.remove_prefix(static_cast<std::size_t>(n));
    }
    return {};
}

Expected<void> AtomicFile::put() {
    if (struct stat old {}; stat(destination_.c_str(), &old) == 0) (void)fchmod(descriptor_, old.st_mode & 07777);
    if (fsync(descriptor_) != 0) return cannot_write(file_, reason_of(errno));
    if (nameless_) {
        const std::string open_file = "/proc/self/fd/" + std::to_string(descriptor_);
        with_free_name([&](const fs::path& path) {
            path_ = path;
            nameless_ = linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, path_.c_str(), AT_SYMLINK_FOLLOW) != 0;
            return !nameless_;
        });
        if (nameless_) return cannot_write(file_, reason_of(errno));
    }
    if (rename(path_.c_str(), destination_.c_str()) != 0) return cannot_write(file_, reason_of(errno));
    close(std::exchange(descriptor_, -1));
    return {};
}

Expected<void> write_atomically(const fs::path& file, std::string_view content) {
    auto beside = AtomicFile::beside(file);
    if (!beside) return tl::unexpected(std::move(beside.error()));
    if (auto written = beside->write(content); !written) return written;
    return beside->put();
}

}  // namespace crescente
