#include "io/assimp_files.h"

#ifdef CRESCENTE_WITH_ASSIMP

#include <algorithm>
#include <cstring>

#include "io/text_file.h"

namespace crescente::io {
namespace {

// A file in memory, for reading.
class MemoryStream : public Assimp::IOStream {
public:
    explicit MemoryStream(std::string_view bytes) : bytes_(bytes) {}
    explicit MemoryStream(std::string owned) : owned_(std::move(owned)), bytes_(owned_) {}

    std::size_t Read(void* to, std::size_t size, std::size_t count) override {
        if (size == 0) return 0;
        const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
        if (whole > 0) std::memcpy(to, bytes_.data() + at_, whole * size);
        at_ += whole * size;
        return whole;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        const std::size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
        const std::size_t to = from + offset;  // a negative offset comes as its two's complement
        if (to > bytes_.size()) return aiReturn_FAILURE;
        at_ = to;
        return aiReturn_SUCCESS;
    }
    std::size_t Tell() const override { return at_; }
    std::size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

private:
    std::string owned_;
    std::string_view bytes_;
    std::size_t at_ = 0;
};

std::string_view without_dot(std::string_view name) { return name.starts_with("./") ? name.substr(2) : name; }

}  // namespace

bool AssimpFiles::Exists(const char* name) const {
    if (without_dot(name) == main_file_) return true;
    std::error_code code;
    return stays_in_folder(name) && std::filesystem::is_regular_file(folder_ / name, code);
}

Assimp::IOStream* AssimpFiles::Open(const char* name, const char* mode) {
    if (std::strpbrk(mode, "wa+")) return nullptr;
    if (without_dot(name) == main_file_) return new MemoryStream(bytes_);
    if (stays_in_folder(name)) {
        if (auto bytes = read_whole_file(folder_ / name)) return new MemoryStream(std::move(*bytes));
    }
    note_missing(name);
    return nullptr;
}

void AssimpFiles::note_missing(const std::string& name) {
    constexpr std::size_t most = 20;
    if (missing_.size() < most && std::find(missing_.begin(), missing_.end(), name) == missing_.end()) missing_.push_back(name);
}

}  // namespace crescente::io

#endif
