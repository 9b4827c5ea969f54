#include "app/server/file_library.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>

#include "base/atomic_file.h"
#include "io/formats.h"

namespace crescente::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_recent = 12, most_listed = 2000;
constexpr std::string_view upload_prefix = "upload/", example_prefix = "example/";

// With all links followed, as far as it exists; empty if that cannot be found out.
fs::path resolved(const fs::path& path) {
    std::error_code error;
    fs::path found = fs::weakly_canonical(path, error);
    return error ? fs::path{} : found.lexically_normal();
}

bool lies_in(const fs::path& path, const fs::path& folder) {
    if (folder.empty() || path.empty()) return false;
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

bool is_file(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
}

bool is_folder(const fs::path& path) {
    std::error_code error;
    return fs::is_directory(path, error);
}

bool is_model(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return std::any_of(io::formats().begin(), io::formats().end(),
                       [&](const io::Format& format) { return std::find(format.extensions.begin(), format.extensions.end(), extension) != format.extensions.end(); });
}

// Pictures that may surround a scene.
bool is_environment(const fs::path& path) { return path.extension() == ".hdr" || path.extension() == ".exr"; }

// Installed beside the program, or above it where it was built.
fs::path examples_folder() {
    const fs::path program = resolved("/proc/self/exe").parent_path();
    if (program.empty()) return {};
    for (const fs::path& folder : {program / "../share/crescente/scenes", program / "../../../scenes"}) {
        if (is_file(folder / "LICENCES.md")) return resolved(folder);
    }
    return {};
}

// XDG Base Directory Specification 0.8; empty where there is no home.
fs::path recent_file() {
    const char* state = std::getenv("XDG_STATE_HOME");
    if (state && *state == '/') return fs::path(state) / "crescente" / "recent";
    const char* home = std::getenv("HOME");
    if (home && *home == '/') return fs::path(home) / ".local" / "state" / "crescente" / "recent";
    return {};
}

std::int64_t seconds_since_1970(fs::file_time_type time) {
    return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::file_clock::to_sys(time).time_since_epoch()).count();
}

ReplyJson file_json(const fs::path& path, const std::string& name) {
    std::error_code error;
    ReplyJson json{{"name", path.filename().string()}, {"title", path.filename().string()}, {"file", name}};
    const auto bytes = fs::file_size(path, error);
    if (!error) json["bytes"] = bytes;
    const auto time = fs::last_write_time(path, error);
    if (!error) json["time"] = seconds_since_1970(time);
    return json;
}

// Those of a folder; each is opened by its name after the prefix.
void add_environments(const fs::path& folder, const std::string& prefix, ReplyJson& list) {
    if (folder.empty()) return;
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator at(folder, fs::directory_options::skip_permission_denied, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (!name.starts_with('.') && is_environment(name) && is_file(at->path()) && names.size() < most_listed) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) {
        list.push_back({{"name", name}, {"title", fs::path(name).stem().string()}, {"file", prefix + name}});
    }
}

tl::unexpected<Error> refused(const std::string& name) {
    return failure(ErrorKind::input, {name, "", "there is no such file, or it may not be opened", "`--folder DIR` allows a folder"});
}

bool names_files(const fs::path& file) { return file.extension() == ".json" || file.extension() == ".gltf"; }

// Calls visit with each file that the value names, and where that is said.
template <class Visit>
void for_each_named_file(const io::Json& json, const io::Place& place, Visit&& visit) {
    const auto names_file = [](std::string_view key) {
        const auto last = key.substr(key.rfind('.') + 1);  // of a path of `set`, or the key itself
        return last == "image" || last == "profile" || last == "file" || last == "uri";
    };
    if (json.array()) {
        std::size_t index = 0;
        for (const io::Json& element : *json.array()) for_each_named_file(element, place / index++, visit);
    }
    if (!json.object()) return;
    for (const io::Json::Member& member : *json.object()) {
        const io::Place here = place / member.key;
        if (names_file(member.key) && member.value.text()) visit(*member.value.text(), here);
        else for_each_named_file(member.value, here, visit);
    }
}

}  // namespace

FileLibrary::FileLibrary(Places places) : places_(std::move(places)), examples_(examples_folder()) {
    for (fs::path& folder : places_.folders) folder = resolved(folder);
    for (fs::path& file : places_.files) file = resolved(file);
    if (places_.recent) recent_list_ = recent_file();
}

bool FileLibrary::is_allowed(const fs::path& path, const fs::path& uploads) const {
    const fs::path real = resolved(path);
    if (real.empty()) return false;
    if (lies_in(real, uploads) || lies_in(real, examples_)) return true;
    if (std::find(places_.files.begin(), places_.files.end(), real) != places_.files.end()) return true;
    return std::any_of(places_.folders.begin(), places_.folders.end(), [&](const fs::path& folder) { return lies_in(real, folder); });
}

Expected<fs::path> FileLibrary::find(const std::string& name, const fs::path& uploads) const {
    const auto below = [&](std::string_view prefix, const fs::path& folder) -> Expected<fs::path> {
        const fs::path path = resolved(folder / name.substr(prefix.size()));
        if (folder.empty() || !lies_in(path, folder) || !is_file(path)) return refused(name);
        return path;
    };
    if (name.starts_with(upload_prefix)) return below(upload_prefix, uploads);
    if (name.starts_with(example_prefix)) return below(example_prefix, examples_);
    const fs::path path = resolved(name);
    if (!is_file(path)) return refused(name);
    if (is_allowed(path, uploads)) return path;
    const auto lately = read_recent();
    if (std::find(lately.begin(), lately.end(), path) != lately.end()) return path;
    return refused(name);
}

Expected<ReplyJson> FileLibrary::list(const std::optional<std::string>& folder, const fs::path& uploads) const {
    ReplyJson json{{"folder", nullptr}, {"folders", ReplyJson::array()}, {"files", ReplyJson::array()}, {"environments", ReplyJson::array()}, {"examples", examples()}, {"recent", recent()}};
    if (!folder) {
        add_environments(examples_, std::string(example_prefix), json["environments"]);
        add_environments(uploads, std::string(upload_prefix), json["environments"]);
        for (const fs::path& allowed : places_.folders) {
            json["folders"].push_back(allowed.string());
            add_environments(allowed, allowed.string() + "/", json["environments"]);
        }
        for (const fs::path& file : places_.files) json["files"].push_back(file_json(file, file.string()));
        return json;
    }
    const fs::path path = resolved(*folder);
    if (!is_folder(path) || !is_allowed(path, uploads)) return failure(ErrorKind::input, {*folder, "", "there is no such folder, or it may not be seen", "`--folder DIR` allows a folder"});
    std::vector<fs::path> folders, files;
    std::error_code error;
    for (fs::directory_iterator at(path, fs::directory_options::skip_permission_denied, error), end; !error && at != end; at.increment(error)) {
        if (folders.size() + files.size() >= most_listed) break;
        if (at->path().filename().string().starts_with('.') || !is_allowed(at->path(), uploads)) continue;
        if (is_folder(at->path())) folders.push_back(at->path());
        else if (is_file(at->path()) && is_model(at->path())) files.push_back(at->path());
    }
    std::sort(folders.begin(), folders.end());
    std::sort(files.begin(), files.end());
    json["folder"] = path.string();
    for (const fs::path& inner : folders) json["folders"].push_back(inner.filename().string());
    add_environments(path, path.string() + "/", json["environments"]);
    for (const fs::path& file : files) json["files"].push_back(file_json(file, file.string()));
    return json;
}

ReplyJson FileLibrary::examples() const {
    std::vector<fs::path> files;
    std::error_code error;
    if (!examples_.empty()) {
        for (fs::directory_iterator at(examples_, error), end; !error && at != end; at.increment(error)) {
            if (is_file(at->path()) && is_model(at->path())) files.push_back(at->path());
        }
    }
    std::sort(files.begin(), files.end());
    ReplyJson json = ReplyJson::array();
    for (const fs::path& file : files) {
        ReplyJson one = file_json(file, std::string(example_prefix) + file.filename().string());
        one["title"] = file.stem().string();
        json.push_back(std::move(one));
    }
    return json;
}

ReplyJson FileLibrary::recent() const {
    ReplyJson json = ReplyJson::array();
    for (const fs::path& file : read_recent()) json.push_back(file_json(file, file.string()));
    return json;
}

std::vector<fs::path> FileLibrary::read_recent() const {
    std::vector<fs::path> files;
    if (recent_list_.empty()) return files;
    const std::lock_guard lock(mutex_);
    std::ifstream stream(recent_list_);
    for (std::string line; files.size() < most_recent && std::getline(stream, line);) {
        if (!line.empty() && is_file(line)) files.emplace_back(line);
    }
    return files;
}

void FileLibrary::opened(const fs::path& file) const {
    if (recent_list_.empty() || lies_in(resolved(file), examples_)) return;
    std::vector<fs::path> files = read_recent();
    std::erase(files, file);
    files.insert(files.begin(), file);
    if (files.size() > most_recent) files.resize(most_recent);
    std::string text;
    for (const fs::path& one : files) text += one.string().find('\n') == std::string::npos ? one.string() + "\n" : std::string{};
    const std::lock_guard lock(mutex_);
    std::error_code error;
    fs::create_directories(recent_list_.parent_path(), error);
    (void)write_atomically(recent_list_, text);  // it is a convenience: where it cannot be kept, it is not
}

Expected<void> check_named_files(const io::Json& json, const FileLibrary& library, const fs::path& folder, const fs::path& uploads) {
    Error error{ErrorKind::input, {}};
    for_each_named_file(json, {}, [&](const std::string& file, const io::Place& place) {
        if (file.empty() || file.starts_with("data:")) return;
        // Names in glTF may be escaped, by which dots can hide.
        const bool escaped_dots = file.find("%2") != std::string::npos;
        if (escaped_dots || !library.is_allowed(folder / file, uploads)) error.problems.push_back({"", place.pointer(), "'" + file.substr(0, 300) + "' may not be read", "`--folder DIR` allows a folder"});
    });
    if (!error.problems.empty()) return tl::unexpected(std::move(error));
    return {};
}

Expected<void> check_upload(const fs::path& model, const FileLibrary& library, const fs::path& uploads) {
    constexpr std::uintmax_t longest = std::uintmax_t{1} << 28;
    std::vector<fs::path> open{resolved(model)}, seen;
    while (!open.empty()) {
        const fs::path file = open.back();
        open.pop_back();
        std::error_code error;
        if (!names_files(file) || std::find(seen.begin(), seen.end(), file) != seen.end() || !lies_in(file, uploads)) continue;
        if (fs::file_size(file, error) > longest || error) return failure(ErrorKind::input, {file.filename().string(), "", "is too large to be looked into", ""});
        seen.push_back(file);
        std::ifstream stream(file, std::ios::binary);
        const std::string text((std::istreambuf_iterator<char>(stream)), {});
        io::ProblemList problems{file.filename().string()};
        const auto json = io::parse_json(text, problems);
        if (!json) continue;  // its reader tells what is wrong
        if (const auto allowed = check_named_files(*json, library, file.parent_path(), uploads); !allowed) return allowed;
        for_each_named_file(*json, {}, [&](const std::string& name, const io::Place&) { open.push_back(resolved(file.parent_path() / name)); });
    }
    return {};
}

}  // namespace crescente::app
