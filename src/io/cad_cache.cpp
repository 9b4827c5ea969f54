#include "io/cad_cache.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <vector>

#include "base/atomic_file.h"
#include "base/byte_archive.h"
#include "base/checksum.h"
#include "io/cad_messages.h"
#include "io/content_hash.h"
#include "io/text_file.h"

namespace crescente::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mark = "crescente cad\n";
constexpr const char* extension_of_entries = ".cad";

std::string lower_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

template <class Archive>
void value(Archive& a, CadCacheFile& file) {
    crescente::value(a, file.name), crescente::value(a, file.hash);
}

// The main file and those it refers to as they are now; nothing if one cannot be read.
std::optional<std::vector<CadCacheFile>> files_now(const fs::path& file, const std::vector<std::string>& referenced) {
    std::vector<CadCacheFile> files;
    const auto add = [&](const fs::path& path, const std::string& name) {
        const auto hash = content_hash(path);
        if (hash) files.push_back({name, *hash});
        return hash.has_value();
    };
    if (!add(file, lower_extension(file))) return std::nullopt;
    for (const std::string& name : referenced) {
        if (!stays_in_folder(name) || !add(file.parent_path() / name, name)) return std::nullopt;
    }
    return files;
}

}  // namespace

std::string cad_cache_bytes(const CadCacheEntry& entry) {
    ByteWriter body;
    auto files = entry.files;
    list(body, files, 2 * sizeof(std::uint64_t), [&](CadCacheFile& file) { value(body, file); });
    body.bytes += pack_cad(entry.model);
    std::uint64_t size = body.bytes.size(), checksum = crescente::checksum(body.bytes);
    std::uint32_t version = cad_message_version;
    ByteWriter whole;
    whole.bytes = mark;
    crescente::value(whole, version), crescente::value(whole, size), crescente::value(whole, checksum);
    return whole.bytes + body.bytes;
}

std::optional<CadCacheEntry> cad_cache_entry(std::string_view bytes) {
    if (!bytes.starts_with(mark)) return std::nullopt;
    ByteReader reader{bytes.substr(mark.size())};
    std::uint32_t version = 0;
    std::uint64_t size = 0, checksum = 0;
    crescente::value(reader, version), crescente::value(reader, size), crescente::value(reader, checksum);
    if (!reader.good() || version != cad_message_version || size != reader.bytes.size()) return std::nullopt;
    if (checksum != crescente::checksum(reader.bytes)) return std::nullopt;
    CadCacheEntry entry;
    list(reader, entry.files, 2 * sizeof(std::uint64_t), [&](CadCacheFile& file) { value(reader, file); });
    if (!reader.good() || entry.files.empty()) return std::nullopt;
    auto model = unpack_cad(reader.bytes);
    if (!model || !*model) return std::nullopt;
    entry.model = std::move(**model);
    return entry;
}

std::optional<CadCache> CadCache::of_user() {
    const auto absolute = [](const char* variable) -> std::optional<fs::path> {
        const char* value = std::getenv(variable);
        if (!value || !fs::path(value).is_absolute()) return std::nullopt;  // a relative one is to be ignored (XDG Base Directory Specification)
        return fs::path(value);
    };
    if (const auto cache = absolute("XDG_CACHE_HOME")) return CadCache(*cache / "crescente" / "cad");
    if (const auto home = absolute("HOME")) return CadCache(*home / ".cache" / "crescente" / "cad");
    return std::nullopt;
}

// Entries are named by the main file's content and extension; what it refers to is checked inside.
std::optional<CadModel> CadCache::find(const fs::path& file) const {
    const auto hash = content_hash(file);
    if (!hash) return std::nullopt;
    const fs::path place = folder_ / (*hash + lower_extension(file) + extension_of_entries);
    const auto bytes = read_whole_file(place);
    if (!bytes) return std::nullopt;
    auto entry = cad_cache_entry(*bytes);
    if (!entry) return std::nullopt;
    const auto now = files_now(file, entry->model.referenced);
    if (!now || *now != entry->files) return std::nullopt;
    std::error_code code;
    fs::last_write_time(place, fs::file_time_type::clock::now(), code);  // used last now
    return std::move(entry->model);
}

Expected<void> CadCache::keep(const fs::path& file, const CadModel& model) const {
    auto files = files_now(file, model.referenced);
    if (!files) return failure(ErrorKind::output, {file.string(), {}, "cannot be read again to keep it in the cache", {}});
    const std::string name = files->front().hash + lower_extension(file) + extension_of_entries;
    const std::string bytes = cad_cache_bytes({std::move(*files), model});
    if (bytes.size() > bytes_allowed_ / 4) return failure(ErrorKind::output, {file.string(), {}, "is too large for the cache", {}});
    std::error_code code;
    if (fs::create_directories(folder_, code); code) return failure(ErrorKind::output, {folder_.string(), {}, "cannot be made: " + code.message(), {}});
    fs::permissions(folder_, fs::perms::owner_all, code);
    return write_atomically(folder_ / name, bytes).map([&] { make_room(folder_ / name); });
}

void CadCache::make_room(const fs::path& newest) const {
    struct Entry {
        fs::path path;
        fs::file_time_type used;
        std::uint64_t bytes;
    };
    std::vector<Entry> entries;
    std::uint64_t all = 0;
    std::error_code code;
    for (const fs::directory_entry& each : fs::directory_iterator(folder_, code)) {
        if (each.path().extension() != extension_of_entries || !each.is_regular_file(code)) continue;
        const std::uint64_t bytes = each.file_size(code);
        if (code) continue;
        entries.push_back({each.path(), each.last_write_time(code), bytes});
        all += bytes;
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
    for (const Entry& entry : entries) {
        if (all <= bytes_allowed_) break;
        if (entry.path == newest || !fs::remove(entry.path, code)) continue;
        all -= entry.bytes;
    }
}

}  // namespace crescente::io
