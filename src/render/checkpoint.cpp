#include "render/checkpoint.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

#include "base/atomic_file.h"
#include "base/byte_archive.h"
#include "base/checksum.h"
#include "render/counts_archive.h"
#include "render/level.h"
#include "render/tile_archive.h"
#include "render/tile_check.h"

namespace crescente::render {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mark = "crescente forest\n";
constexpr std::size_t longest_head = 1 << 20;  // bytes
constexpr std::size_t longest_note = 1 << 16;

constexpr const char* picture_settings[] = {"width", "height", "tile"};
constexpr const char* growth_settings[] = {"level", "threshold", "depth", "supersampling", "contrast", "subpixel_shortcut",
                                           "noise",  "samples",   "caustics", "exposure"};

const Field<scene::Settings>& setting(std::string_view name) {
    for (const auto& field : scene::Settings::fields()) {
        if (field.info.name == name) return field;
    }
    std::abort();  // the table of settings has no such line
}

template <class Visit>
void for_each_tree_setting(Visit&& visit) {
    for (const char* name : picture_settings) visit(setting(name));
    for (const char* name : growth_settings) visit(setting(name));
}

// Numbers are within the range of their field.
template <class Archive>
void tree_setting(Archive& a, scene::Settings& settings, const Field<scene::Settings>& field) {
    const FieldValue held = field.get(settings);
    const bool whole = std::holds_alternative<std::int64_t>(held), either = std::holds_alternative<bool>(held);
    double number = whole ? static_cast<double>(std::get<std::int64_t>(held)) : either ? double(std::get<bool>(held)) : std::get<double>(held);
    value(a, number);
    if (!(number >= field.info.minimum && number <= field.info.maximum) || ((whole || either) && number != std::floor(number))) a.fail();
    if (a.good()) field.set(settings, whole ? FieldValue{static_cast<std::int64_t>(number)} : either ? FieldValue{number != 0} : FieldValue{number});
}

template <class Archive>
void head_of(Archive& a, CheckpointHead& head) {
    value(a, head.program), value(a, head.note);
    value(a, head.scene);
    for_each_tree_setting([&](const Field<scene::Settings>& field) { tree_setting(a, head.settings, field); });
    SessionCounts& c = head.counts;
    array(a, c.level_seconds);
    list(a, c.level_rays, sizeof(RayCounts), [&](RayCounts& rays) { counts(a, rays); });
    counts(a, c.past_rays), counts(a, c.past_tests), value(a, c.render_seconds);
    value(a, c.peak_bytes), value(a, c.drops), value(a, c.dropped_bytes), value(a, c.dropped_nodes), value(a, c.revised);
}

bool counts_hold(const SessionCounts& c) {
    const auto is_time = [](double seconds) { return std::isfinite(seconds) && seconds >= 0; };
    return c.level_seconds.size() == levels().size() && c.level_rays.size() == levels().size() && is_time(c.render_seconds) &&
           std::all_of(c.level_seconds.begin(), c.level_seconds.end(), is_time);
}

// A section: the length of its bytes, their checksum, which also depends on the section's number, and the bytes.
struct SectionHead {
    std::uint64_t length, checksum;
};
constexpr std::uint64_t head_section = 0, first_tile_section = 1;

// Reads a file section by section.
class SectionReader {
public:
    static Expected<SectionReader> open(const fs::path& file) {
        SectionReader reader(file);
        std::error_code code;
        const auto status = fs::status(file, code);
        if (!fs::exists(status)) return reader.wrong("", "there is no such file");
        if (!fs::is_regular_file(status)) return reader.wrong("", "this is not a regular file");
        reader.stream_.reset(std::fopen(file.c_str(), "rb"));
        if (!reader.stream_) return reader.wrong("", std::string("cannot be opened: ") + std::strerror(errno));
        reader.left_ = fs::file_size(file, code);
        if (code) return reader.wrong("", "cannot be read: " + code.message());
        std::string begin(std::min<std::uint64_t>(mark.size(), reader.left_), '\0');
        if (!reader.read(begin) || begin != mark) return reader.wrong("", "this is no checkpoint of Crescente");
        return reader;
    }

    Expected<void> check_version() {
        std::uint32_t version = 0;
        std::string number(sizeof version, '\0');
        if (!read(number)) return wrong("the beginning", "is damaged: the file ends too early");
        std::memcpy(&version, number.data(), sizeof version);
        if (version == checkpoint_version) return {};
        return wrong("", "is a checkpoint of version " + std::to_string(version) + ", this program reads version " + std::to_string(checkpoint_version));
    }

    Expected<std::string> section(std::uint64_t number, const std::string& place, std::uint64_t longest) {
        std::string bytes(sizeof(SectionHead), '\0');
        if (!read(bytes)) return wrong(place, "is damaged: the file ends too early");
        SectionHead head{};
        std::memcpy(&head, bytes.data(), sizeof head);
        if (head.length > left_) return wrong(place, "is damaged: the file ends too early");
        if (head.length > longest) return wrong(place, "is damaged: it is longer than it can be");
        bytes.resize(head.length);
        if (!read(bytes)) return wrong(place, "cannot be read");
        if (checksum(bytes, number) != head.checksum) return wrong(place, "is damaged: the checksum does not fit");
        return bytes;
    }

    std::uint64_t left() const { return left_; }
    tl::unexpected<Error> wrong(const std::string& place, std::string reason, std::string hint = {}) const {
        return failure(ErrorKind::input, {file_.string(), place, std::move(reason), std::move(hint)});
    }

private:
    explicit SectionReader(const fs::path& file) : file_(file), stream_(nullptr, &std::fclose) {}
    bool read(std::string& bytes) {  // as many as it has
        if (bytes.size() > left_) return false;
        left_ -= bytes.size();
        return std::fread(bytes.data(), 1, bytes.size(), stream_.get()) == bytes.size();
    }

    fs::path file_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
    std::uint64_t left_ = 0;  // bytes to the end
};

Expected<CheckpointHead> read_head(SectionReader& reader) {
    if (const auto version = reader.check_version(); !version) return tl::unexpected(version.error());
    const auto bytes = reader.section(head_section, "the head", longest_head);
    if (!bytes) return tl::unexpected(bytes.error());
    CheckpointHead head;
    ByteReader archive{*bytes};
    head_of(archive, head);
    if (!archive.good() || !archive.bytes.empty() || !counts_hold(head.counts)) return reader.wrong("the head", "is damaged: it makes no sense");
    if (head.program != CRESCENTE_VERSION) {
        return reader.wrong("", "was written by Crescente " + head.program + ", this is " CRESCENTE_VERSION ": their trees may differ");
    }
    return head;
}

// How the scene that a checkpoint is of differs from this one, else empty.
std::string other_parts(const Fingerprint& a, const Fingerprint& b) {
    std::vector<std::string_view> others;
    for (std::size_t i = 0; i < a.parts.size(); ++i) {
        if (a.parts[i] != b.parts[i]) others.push_back(Fingerprint::names[i]);
    }
    std::string text;
    for (std::size_t i = 0; i < others.size(); ++i) text += std::string(i == 0 ? "" : i + 1 < others.size() ? ", " : " and ") + std::string(others[i]);
    return text;
}

std::string picture_text(const scene::Settings& s) {
    return std::to_string(s.width) + "x" + std::to_string(s.height) + " pixels in tiles of " + std::to_string(s.tile);
}

tl::unexpected<Error> no_memory(const fs::path& file, const char* what) { return failure(ErrorKind::resource, {file.string(), "", what, ""}); }

Expected<Checkpoint> read_all(const fs::path& file, const World& world) {
    auto reader = SectionReader::open(file);
    if (!reader) return tl::unexpected(reader.error());
    auto head = read_head(*reader);
    if (!head) return tl::unexpected(head.error());
    if (const std::string others = other_parts(head->scene, fingerprint_of(world.scene)); !others.empty()) {
        return reader->wrong("", "is of another scene: it differs in " + others);
    }
    const scene::Settings& now = world.scene.settings;
    if (picture_text(head->settings) != picture_text(now)) return reader->wrong("", "is of a picture of " + picture_text(head->settings) + ", not of " + picture_text(now));

    const std::vector<Stage> stages = stages_of(head->settings);
    const scene::Level head_level = head->settings.level;
    Checkpoint checkpoint{std::move(*head), cut_tiles(now)};
    for (std::size_t i = 0; i < checkpoint.tiles.size(); ++i) {
        Tile& tile = checkpoint.tiles[i];
        const std::string place = "tile " + std::to_string(i + 1) + " of " + std::to_string(checkpoint.tiles.size());
        const auto bytes = reader->section(first_tile_section + i, place, reader->left());
        if (!bytes) return tl::unexpected(bytes.error());
        auto read = tile_of(*bytes, tile);
        if (!read) return reader->wrong(place, "is damaged: its columns do not fit");
        // Trees of a level that samples begin again at one that does not; of which groups of lights their samples are, its world does not know.
        if (head_level > scene::Level::edges && now.level <= scene::Level::edges) forget_samples(*read);
        if (const std::string problem = tile_problem(*read, world, stages); !problem.empty()) return reader->wrong(place, "is damaged: it " + problem);
        tile = std::move(*read);
        for (const Node& node : tile.nodes) {
            tile.materials |= std::uint64_t{1} << node.material % 64;
            tile.keeps_clear = tile.keeps_clear || node.clear > 0;
        }
    }
    if (reader->left() != 0) return reader->wrong("the end", "is damaged: something follows the last tile");
    return checkpoint;
}

Expected<std::uint64_t> write_all(const fs::path& file, const World& world, const std::string& note, const SessionCounts& counts, std::vector<Tile>& tiles) {
    auto out = AtomicFile::beside(file);
    if (!out) return tl::unexpected(out.error());
    std::string bytes(mark);
    bytes.append(reinterpret_cast<const char*>(&checkpoint_version), sizeof checkpoint_version);
    std::uint64_t size = 0;
    // Writes what the section is after, and its bytes from `begin` on.
    const auto write_section = [&](std::uint64_t number, std::size_t begin) -> Expected<void> {
        const std::string_view content = std::string_view(bytes).substr(begin);
        const SectionHead head{content.size(), checksum(content, number)};
        std::memcpy(bytes.data() + begin - sizeof head, &head, sizeof head);
        size += bytes.size();
        return out->write(bytes);
    };
    bytes.append(sizeof(SectionHead), '\0');
    const std::size_t begin = bytes.size();
    CheckpointHead head{CRESCENTE_VERSION, note.substr(0, longest_note), fingerprint_of(world.scene), {}, counts};
    copy_tree_settings(world.scene.settings, head.settings);
    ByteWriter writer{std::move(bytes)};
    head_of(writer, head);
    bytes = std::move(writer.bytes);
    if (auto written = write_section(head_section, begin); !written) return tl::unexpected(written.error());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        bytes.assign(sizeof(SectionHead), '\0');
        append_tile(tiles[i], bytes);
        if (auto written = write_section(first_tile_section + i, sizeof(SectionHead)); !written) return tl::unexpected(written.error());
    }
    if (auto put = out->put(); !put) return tl::unexpected(put.error());
    return size;
}

}  // namespace

void copy_tree_settings(const scene::Settings& from, scene::Settings& to) {
    for_each_tree_setting([&](const Field<scene::Settings>& field) { field.set(to, field.get(from)); });
}

Expected<std::uint64_t> write_checkpoint(const fs::path& file, const World& world, const std::string& note, const SessionCounts& counts, std::vector<Tile>& tiles) {
    try {
        return write_all(file, world, note, counts, tiles);
    } catch (const std::bad_alloc&) {
        return no_memory(file, "cannot be written: not enough memory");
    }
}

bool is_checkpoint(const fs::path& file) { return SectionReader::open(file).has_value(); }

Expected<CheckpointHead> read_checkpoint_head(const fs::path& file) {
    try {
        auto reader = SectionReader::open(file);
        if (!reader) return tl::unexpected(reader.error());
        return read_head(*reader);
    } catch (const std::bad_alloc&) {
        return no_memory(file, "cannot be read: not enough memory");
    }
}

Expected<Checkpoint> read_checkpoint(const fs::path& file, const World& world) {
    try {
        return read_all(file, world);
    } catch (const std::bad_alloc&) {
        return no_memory(file, "cannot be read: not enough memory");
    }
}

}  // namespace crescente::render
