#include "io/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace crescente::io {
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

// A new file beside the final place, removed again unless it is put there.
class Beside {
public:
    explicit Beside(const fs::path& destination) {
        static std::atomic<unsigned> counter{0};  // only makes names differ
        constexpr int tries = 100;
        for (int i = 0; i < tries && descriptor_ < 0; ++i) {
            path_ = folder_of(destination) / (".crescente-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".part");
            descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (descriptor_ < 0 && errno != EEXIST) break;
        }
    }
    ~Beside() {
        const int code = errno;
        if (descriptor_ >= 0) {
            close(descriptor_);
            unlink(path_.c_str());
        }
        errno = code;
    }
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;

    bool open_failed() const { return descriptor_ < 0; }

    bool write_all(std::string_view content) {
        while (!content.empty()) {
            const ssize_t n = write(descriptor_, content.data(), content.size());
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) return false;
            content.remove_prefix(static_cast<std::size_t>(n));
        }
        return true;
    }

    bool put(const fs::path& destination) {
        if (struct stat old {}; stat(destination.c_str(), &old) == 0) (void)fchmod(descriptor_, old.st_mode & 07777);
        if (fsync(descriptor_) != 0) return false;
        if (rename(path_.c_str(), destination.c_str()) != 0) return false;
        close(std::exchange(descriptor_, -1));
        return true;
    }

private:
    fs::path path_;
    int descriptor_ = -1;
};

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

Expected<void> write_atomically(const fs::path& file, std::string_view content) {
    if (auto possible = can_write_file(file); !possible) return possible;
    const fs::path destination = destination_of(file);
    Beside beside{destination};
    if (beside.open_failed() || !beside.write_all(content) || !beside.put(destination)) return cannot_write(file, reason_of(errno));
    return {};
}

}  // namespace crescente::io
