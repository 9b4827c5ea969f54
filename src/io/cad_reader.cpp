#include "io/cad_reader.h"

#include <algorithm>
#include <cctype>
#include <system_error>

#include <dlfcn.h>

#include "io/cad_cache.h"
#include "io/cad_messages.h"
#include "io/isolated.h"
#include "io/module_file.h"
#include "io/occt/module.h"

namespace crescente::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* module_name = "crescente_opencascade.so";

tl::unexpected<Error> without_opencascade(const std::string& file) {
    return failure(ErrorKind::unsupported, {file, {}, "this build is without OpenCASCADE, which reads this format", "build with CRESCENTE_OPENCASCADE=ON"});
}

// In the process of its own: loads OpenCASCADE there, which takes a while, and never here.
std::string read_with_module(const fs::path& module, const fs::path& file, const std::string& shown, const CadRequest& request, const TellProgress& tell) {
    const auto cannot = [&](std::string reason) { return pack_cad(failure(ErrorKind::unsupported, {shown, {}, std::move(reason), {}})); };
    void* library = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) return cannot(std::string("OpenCASCADE cannot be loaded: ") + dlerror());
    const auto read = reinterpret_cast<decltype(&crescente_cad_read)>(dlsym(library, "crescente_cad_read"));
    if (!read) return cannot(std::string("OpenCASCADE cannot be loaded: ") + dlerror());

    struct User {
        const TellProgress& tell;
        std::string answer;
    } user{tell, {}};
    CrescenteCadRequest c_request{};
    c_request.version = crescente_cad_version;
    c_request.file = file.c_str();
    c_request.shown_name = shown.c_str();
    c_request.deflection = request.deflection;
    std::vector<CrescenteCadFace> triangulated;
    for (const CadFaceNumber& face : request.triangulated) triangulated.push_back({face.part, face.number});
    c_request.triangulated = triangulated.data();
    c_request.triangulated_count = triangulated.size();
    c_request.user = &user;
    c_request.progress = [](void* to, double fraction, const char* stage) { static_cast<User*>(to)->tell(fraction, stage); };
    c_request.take = [](void* to, const char* bytes, std::size_t size) { static_cast<User*>(to)->answer.assign(bytes, size); };
    read(&c_request);
    return std::move(user.answer);
}

// A line of the log for each line that OpenCASCADE printed.
class PrintedLines {
public:
    explicit PrintedLines(const LogSink& log) : log_(log) {}
    ~PrintedLines() { finish(); }
    PrintedLines(const PrintedLines&) = delete;
    PrintedLines& operator=(const PrintedLines&) = delete;

    void take(std::string_view text) {
        for (const char c : text) {
            if (c == '\n' || line_.size() >= longest) finish();
            if (std::isprint(static_cast<unsigned char>(c))) line_ += c;  // control characters could play tricks on a terminal
        }
    }

private:
    static constexpr std::size_t longest = 500;

    void finish() {
        if (!line_.empty() && log_) log_(LogLevel::debug, "OpenCASCADE: " + line_);
        line_.clear();
    }

    const LogSink& log_;
    std::string line_;
};

Expected<CadModel> read_isolated(const fs::path& file, const CadRequest& request, const ReadOptions& options) {
    const std::string shown = file.string();
    const auto wrong = [&](ErrorKind kind, const char* reason) { return failure(kind, {shown, {}, reason, {}}); };
    const auto module = module_file(module_name);
    if (!module) return without_opencascade(shown);
    std::error_code code;
    const fs::path absolute = fs::absolute(file, code);  // with a relative path OpenCASCADE does not find the files that it refers to
    const std::uintmax_t size = fs::file_size(file, code);
    std::error_code unknown;
    const bool exists = fs::exists(file, unknown);
    if (exists && !fs::is_regular_file(file, unknown)) return wrong(ErrorKind::input, "is not a file");
    if (code) return wrong(ErrorKind::input, exists ? "cannot be read" : "there is no such file");
    if (size == 0) return wrong(ErrorKind::input, "is empty");

    IsolationLimits limits;
    const std::uintmax_t megabytes = size >> 20;
    limits.time = std::chrono::seconds(120 + 30 * megabytes);
    limits.memory = (std::size_t{4} << 30) + 200 * size;
    PrintedLines printed(options.log);
    IsolationWatch watch;
    watch.progress = options.progress;
    watch.printed = [&](std::string_view text) { printed.take(text); };
    watch.cancelled = options.cancelled;
    const auto answer = run_isolated([&](const TellProgress& tell) { return read_with_module(*module, absolute, shown, request, tell); }, limits, watch);
    if (!answer) {
        switch (answer.error()) {
            case IsolationFailure::crashed: return wrong(ErrorKind::input, "is damaged, or more than memory holds: OpenCASCADE, which reads this format, failed on it");
            case IsolationFailure::too_long: return wrong(ErrorKind::input, "is damaged, or too much: OpenCASCADE, which reads this format, did not come to an end");
            case IsolationFailure::cancelled: return wrong(ErrorKind::resource, "the reading was stopped");
            case IsolationFailure::unavailable: return wrong(ErrorKind::resource, "no process could be made to read it");
        }
    }
    auto model = unpack_cad(*answer);
    if (!model) return wrong(ErrorKind::internal, "the answer of the process that read it is not whole");
    return std::move(*model);
}

}  // namespace

Expected<CadModel> read_cad_anew(const fs::path& file, const CadRequest& request, const ReadOptions& options) {
    auto model = read_isolated(file, request, options);
    if (!model || !options.cache || request.deflection > 0) return model;
    if (const auto cache = CadCache::of_user()) {
        if (const auto kept = cache->keep(file, *model); !kept && options.log) options.log(LogLevel::warning, kept.error().text());
    }
    return model;
}

Expected<CadModel> read_cad_model(const fs::path& file, const ReadOptions& options) {
    const auto cache = options.cache ? CadCache::of_user() : std::nullopt;
    if (auto kept = cache ? cache->find(file) : std::nullopt) {
        for (Problem& warning : kept->warnings) warning.file = file.string();  // it may have another name now
        return std::move(*kept);
    }
    return read_cad_anew(file, {}, options);
}

}  // namespace crescente::io
