#include "app/cli/scene_options.h"

#include <charconv>
#include <cmath>

#include "app/cli/quantities.h"
#include "base/spelling.h"
#include "io/json_fields.h"
#include "scene/sky.h"

namespace crescente::app {
namespace {

// Options that are a field of scene::Settings by another name.
struct SettingOption {
    const char* option;
    const char* field;
    const char* value;
    const char* doc;
};
constexpr SettingOption setting_options[] = {
    {"--level", "level", "LEVEL", "How far realism grows: visible, shadows, reflections, edges, soft, indirect, or 0 to 5"},
    {"--threads", "threads", "N", "Threads; 0: one for each core"},
    {"--depth", "depth", "N", "Most bounces of a ray"},
    {"--noise", "noise", "X", "Levels soft and indirect: error, relative to the brightness, down to which light is sampled"},
    {"--samples", "samples", "N", "Levels soft and indirect: most samples of a point"},
    {"--denoise", "denoise", "HOW", "Levels soft and indirect: off or filter, for what has fewer samples than it wants"},
    {"--threshold", "threshold", "X", "Rays of less influence on their pixel are not followed, 0 to 1"},
    {"--contrast", "contrast", "X", "Difference of corners that splits a pixel, 0 to 1"},
    {"--accel", "accelerator", "NAME", "How rays find objects: embree, kay-kajiya or linear"},
};

const Field<scene::Settings>& setting(const std::string& name) {
    for (const auto& field : scene::Settings::fields()) {
        if (field.info.name == name) return field;
    }
    std::abort();  // an option names a field that does not exist
}

template <class Number>
bool read_all(const std::string& text, Number& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

Problem out_of_range(const std::string& option, const std::string& text, const FieldInfo& info) {
    const auto print = [](double number) {
        char buffer[32];
        std::snprintf(buffer, sizeof buffer, "%.15g", number);
        return std::string(buffer);
    };
    return {"", option, text + " is out of range", "from " + print(info.minimum) + " to " + print(info.maximum)};
}

// Collects what the options say and what is wrong with them.
struct Reader {
    SceneRequest request;
    Problems problems;

    template <class T>
    bool keep(const Expected<T>& value) {
        if (value) return true;
        problems.insert(problems.end(), value.error().problems.begin(), value.error().problems.end());
        return false;
    }

    void set_integer(const std::string& option, const std::string& name, std::int64_t value) {
        const auto& field = setting(name);
        const auto as_number = static_cast<double>(value);
        if (as_number < field.info.minimum || as_number > field.info.maximum) {
            problems.push_back(out_of_range(option, std::to_string(value), field.info));
        } else {
            request.settings.emplace_back(&field, value);
        }
    }

    void set_text(const std::string& option, const std::string& name, const std::string& text) {
        const auto& field = setting(name);
        const FieldInfo& info = field.info;
        if (info.type == FieldType::choice) {
            const auto& choices = info.choices;
            std::int64_t index = -1;
            if (!read_all(text, index)) index = std::find(choices.begin(), choices.end(), text) - choices.begin();
            if (index >= 0 && index < std::ssize(choices)) {
                request.settings.emplace_back(&field, index);
            } else {
                problems.push_back({"", option, "there is no '" + text + "'", spelling_hint(text, choices)});
            }
        } else if (info.type == FieldType::integer) {
            std::int64_t value = 0;
            if (read_all(text, value)) {
                set_integer(option, name, value);
            } else {
                problems.push_back({"", option, "'" + text + "' is not a whole number", ""});
            }
        } else {
            double value = 0;
            if (!read_all(text, value) || !std::isfinite(value)) {
                problems.push_back({"", option, "'" + text + "' is not a number", ""});
            } else if (value < info.minimum || value > info.maximum) {
                problems.push_back(out_of_range(option, text, info));
            } else {
                request.settings.emplace_back(&field, value);
            }
        }
    }
};

std::string studio_list() {
    std::string list;
    for (const std::string_view name : scene::studio_names) list += (list.empty() ? "" : ", ") + std::string(name);
    return list;
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
    command.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // scripts can append to what they wrap
    command.add_option("MODEL", options.file, "Scene or model file (see `crescente formats`)")->required()->option_text(" ");
    command.add_option("--size", options.size, "Size of the picture in pixels")->option_text("WxH");
    for (const SettingOption& o : setting_options) {
        command.add_option(o.option, options.settings[o.field], o.doc)->option_text(o.value);
    }
    command.add_option("--supersampling", options.supersampling, "How often a pixel may be split in four, 0 to 5, or off")->option_text("N");
    command.add_option("--memory", options.memory, "Ceiling for the kept rays, such as 2G; 0: none")->option_text("BYTES");
    command.add_option("--camera", options.camera, "px,py,pz,tx,ty,tz in the file's unit, or a view: " + view_names())->option_text("VIEW");
    command.add_option("--fov", options.field_of_view, "Vertical field of view")->option_text("DEGREES");
    command.add_flag("--orthographic", options.orthographic, "Parallel projection");
    command.add_option("--aperture", options.lens.aperture, "Diameter of the lens in the file's unit, for levels soft and indirect; 0: all is sharp")->option_text("LENGTH");
    command.add_option("--focus", options.lens.focus, "Distance of what is sharp in the file's unit, or auto: that of what the middle of the picture shows")->option_text("LENGTH|auto");
    command.add_option("--blades", options.lens.blades, "Corners of the lens's opening; 0: it is round")->option_text("N");
    command.add_option("--shutter", options.lens.shutter, "When the shutter opens and closes, as shares of the motion's time")->option_text("OPEN,CLOSE");
    command.add_option("--environment", options.environment, "Equirectangular picture that surrounds and lights the scene, such as sky.hdr")->option_text("FILE");
    command.add_option("--sky", options.sky, "Clear sky and sun: azimuth,elevation or 2024-06-21T14:30,latitude,longitude (universal time), and ,turbidity")->option_text("SUN");
    command.add_option("--set", options.overrides, "Override a value of the scene: material.chrome.roughness=0.1 (repeatable)")
        ->option_text("PATH=VALUE")->expected(1)->take_all()->allow_extra_args(false);
    command.add_option("--studio", options.studio, "Lights and ground that fit the model, whatever light it has: " + studio_list())->option_text("NAME");
    command.add_option("--ground", options.ground, "What the model stands on: studio, catch (only shadows and reflections are seen) or none")
        ->check(CLI::IsMember({"studio", "catch", "none"}))->option_text("NAME");
    command.add_option("--background", options.background, "Behind everything: transparent (PNG, TIFF and EXR keep an alpha channel) or a colour, #rrggbb")->option_text("WHAT");
    command.add_flag("--no-studio", options.no_studio, "Add no lights and ground to a bare model");
    command.add_flag("--no-cache", options.no_cache, "Read a CAD file anew, and keep nothing of it");
    command.add_option("--missing-textures", options.missing_textures, "What to do where a texture's picture is missing or damaged: error, or show a pattern")
        ->check(CLI::IsMember({"error", "pattern"}))->option_text("error|pattern");
    command.add_flag("-v,--verbose", options.verbose, "Tell what the libraries that read the file have to say");
}

Expected<SceneRequest> understand(const SceneOptions& options) {
    Reader reader;
    for (const SettingOption& o : setting_options) {
        if (const auto& text = options.settings.at(o.field)) reader.set_text(o.option, o.field, *text);
    }
    if (options.size) {
        if (const auto size = parse_size("--size", *options.size); reader.keep(size)) {
            reader.set_integer("--size", "width", size->width);
            reader.set_integer("--size", "height", size->height);
        }
    }
    if (options.supersampling) {
        reader.set_text("--supersampling", "supersampling", options.supersampling == "off" ? "0" : *options.supersampling);
    }
    if (options.memory) {
        if (const auto bytes = parse_bytes("--memory", *options.memory); reader.keep(bytes)) reader.set_integer("--memory", "memory", *bytes);
    }
    if (options.sky) {
        if (auto daylight = scene::daylight_of(*options.sky)) {
            reader.request.sky = options.sky;
        } else {
            for (Problem& problem : daylight.error().problems) reader.problems.push_back({"", "--sky", std::move(problem.reason), std::move(problem.hint)});
        }
        if (options.environment) reader.problems.push_back({"", "--sky", "and --environment cannot be together", ""});
    }
    if (options.studio) {
        const auto found = std::find(std::begin(scene::studio_names), std::end(scene::studio_names), *options.studio);
        if (found != std::end(scene::studio_names)) {
            reader.request.asked_studio = static_cast<scene::Studio>(found - std::begin(scene::studio_names));
        } else {
            const std::vector<std::string> known(std::begin(scene::studio_names), std::end(scene::studio_names));
            reader.problems.push_back({"", "--studio", "there is no studio '" + *options.studio + "'", spelling_hint(*options.studio, known)});
        }
        if (options.no_studio) reader.problems.push_back({"", "--studio", "and --no-studio cannot be together", ""});
    }
    if (options.ground == "studio") reader.request.ground = scene::Ground::studio;
    if (options.ground == "catch") reader.request.ground = scene::Ground::catcher;
    if (options.ground == "none") reader.request.ground = scene::Ground::none;
    if (options.background) {
        reader.request.background.emplace();
        if (*options.background != "transparent") {
            reader.request.background->color = io::color_of_text(*options.background);
            if (!reader.request.background->color) reader.problems.push_back({"", "--background", "'" + *options.background + "' is no background", "write transparent, or a colour such as #ffffff"});
        }
    }
    if (auto view = parse_view(options.camera, options.field_of_view, options.orthographic); reader.keep(view)) {
        reader.request.view = std::move(*view);
    }
    if (auto lens = parse_lens(options.lens); reader.keep(lens)) reader.request.lens = std::move(*lens);
    if (!reader.problems.empty()) return tl::unexpected<Error>({ErrorKind::usage, std::move(reader.problems)});
    reader.request.file = options.file;
    reader.request.environment = options.environment;
    reader.request.overrides = options.overrides;
    reader.request.studio = !options.no_studio;
    reader.request.cache = !options.no_cache;
    reader.request.verbose = options.verbose;
    reader.request.texture_pattern = options.missing_textures == "pattern";
    return std::move(reader.request);
}

}  // namespace crescente::app
