#include "io/text_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <system_error>

namespace crescente::io {

Expected<std::string> read_whole_file(const std::filesystem::path& file) {
    const auto fail = [&](ErrorKind kind, std::string reason) { return failure(kind, {file.string(), "", std::move(reason), ""}); };
    std::error_code code;
    const auto status = std::filesystem::status(file, code);
    if (!std::filesystem::exists(status)) return fail(ErrorKind::input, "there is no such file");
    if (std::filesystem::is_directory(status)) return fail(ErrorKind::input, "this is a folder, not a file");
    if (!std::filesystem::is_regular_file(status)) return fail(ErrorKind::input, "this is not a regular file");
    const std::uintmax_t size = std::filesystem::file_size(file, code);
    if (code) return fail(ErrorKind::input, "cannot be read: " + code.message());

    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream{std::fopen(file.c_str(), "rb"), &std::fclose};
    if (!stream) return fail(ErrorKind::input, std::string("cannot be opened: ") + std::strerror(errno));
    std::string bytes;
    try {
        bytes.resize(size);
    } catch (const std::exception&) {  // length_error or bad_alloc
        return fail(ErrorKind::resource, "is larger than the memory that is left");
    }
    if (std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size()) {
        return fail(ErrorKind::input, "cannot be read to its end");
    }
    return bytes;
}

bool stays_in_folder(std::string_view name) {
    if (name.empty() || name.find_first_of(":\\") != std::string_view::npos || name.find('\0') != std::string_view::npos) return false;
    const std::filesystem::path path(name);
    if (path.has_root_path()) return false;
    for (const auto& part : path) {
        if (part == "..") return false;
    }
    return true;
}

}  // namespace crescente::io
