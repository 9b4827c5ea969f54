// CAD models that were read before, in the user's cache directory. Safe to delete at any time; what is damaged or of another version is not found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "io/cad_model.h"

namespace crescente::io {

class CadCache {
public:
    // `bytes_allowed`: entries are dropped, those unused for longest first, when there are more.
    explicit CadCache(std::filesystem::path folder, std::uint64_t bytes_allowed = std::uint64_t{1} << 30)
        : folder_(std::move(folder)), bytes_allowed_(bytes_allowed) {}

    // $XDG_CACHE_HOME/crescente/cad, or ~/.cache/crescente/cad; nothing if neither is known.
    static std::optional<CadCache> of_user();

    // The model that was kept for this file, if the file's content and that of the files it refers to are what they were.
    std::optional<CadModel> find(const std::filesystem::path& file) const;

    // Keeps it: written beside its place and renamed. Errors: output; the model can be used all the same.
    Expected<void> keep(const std::filesystem::path& file, const CadModel& model) const;

    const std::filesystem::path& folder() const { return folder_; }

private:
    void make_room(const std::filesystem::path& newest) const;

    std::filesystem::path folder_;
    std::uint64_t bytes_allowed_;
};

// An entry: a mark, the version, lengths, a checksum, the hashes of the files it was made from, and the model as of io/cad_messages.h.
struct CadCacheFile {
    std::string name;  // relative to the folder of the main file, which comes first, by its extension alone
    std::string hash;
    bool operator==(const CadCacheFile&) const = default;
};
struct CadCacheEntry {
    std::vector<CadCacheFile> files;
    CadModel model;
};
std::string cad_cache_bytes(const CadCacheEntry& entry);
std::optional<CadCacheEntry> cad_cache_entry(std::string_view bytes);  // nothing if they are not whole, sound and of this version

}  // namespace crescente::io
