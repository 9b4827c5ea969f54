#include "io/set_value.h"

#include "io/ies_file.h"
#include "io/panorama_file.h"
#include "io/scene_names.h"
#include "io/scene_parts.h"
#include "io/scene_words.h"

namespace crescente::io {
namespace {

using scene::Draft;

// "material.chrome.roughness" in its parts.
struct Path {
    std::string_view what, name, field;
    bool has_name = false;
};

std::optional<Path> split(std::string_view text) {
    const auto first = text.find('.'), last = text.rfind('.');
    if (first == std::string_view::npos) return std::nullopt;
    Path path{text.substr(0, first), {}, text.substr(last + 1), last > first};
    if (!path.has_name) return path;
    path.name = text.substr(first + 1, last - first - 1);
    if (path.name.size() >= 2 && path.name.front() == '"' && path.name.back() == '"') path.name = path.name.substr(1, path.name.size() - 2);
    return path;
}

class Setter {
public:
    Setter(Draft& draft, const Path& path, const Json& value, const Measure& measure, const Place& place, ProblemList& problems)
        : draft_(draft), path_(path), value_(value), measure_(measure), place_(place), problems_(problems) {}

    void run() {
        if (path_.what == "settings") return void(set_single(draft_.settings));
        if (path_.what == "material") return set_named(draft_.materials, [](Draft& d, std::size_t i) -> auto& { return d.materials.change(i); });
        if (path_.what == "light") return set_named(draft_.lights, [](Draft& d, std::size_t i) -> auto& { return d.lights[i]; });
        if (path_.what == "shape") return set_named(draft_.shapes, [](Draft& d, std::size_t i) -> auto& { return d.shapes.change(i); });
        if (path_.what == "camera") {
            if (!draft_.camera) return wrong("the scene has no camera yet");
            return void(set_single(*draft_.camera));
        }
        if (path_.what == "environment") {
            if (!draft_.environment) draft_.environment.emplace();
            if (set_single(*draft_.environment) && (path_.field == "image" || path_.field == "sky")) load_panorama(*draft_.environment, value_, place_, problems_);
            return;
        }
        const std::vector<std::string> known{"settings", "camera", "environment", "light", "material", "shape"};
        wrong("'" + std::string(path_.what.substr(0, 100)) + "' is nothing that can be set", spelling_hint(path_.what, known));
    }

private:
    void wrong(std::string reason, std::string hint = {}) { problems_.add(value_, place_, std::move(reason), std::move(hint)); }

    // Whether nothing was wrong.
    template <class Owner>
    bool set_field(Owner& owner) {
        const auto& table = Owner::fields();
        const auto found = std::find_if(table.begin(), table.end(), [&](const auto& f) { return f.info.name == path_.field; });
        if (found == table.end()) {
            wrong("'" + std::string(path_.field.substr(0, 100)) + "' is no field of " + std::string(path_.what), spelling_hint(path_.field, names_of(table)));
            return false;
        }
        const auto value = read_value(value_, found->info, measure_, place_, problems_);
        if (value) found->set(owner, *value);
        return value.has_value();
    }
    bool set_in(scene::Light& light) {
        if (!set_field(light)) return false;
        if (path_.field == "profile") load_profile(light, value_, place_, problems_);
        return true;
    }
    bool set_in(scene::Material& material) {
        if (path_.field == library_word().name) {
            const scene::LibraryMaterial* found = read_library_material(value_, place_, problems_);
            if (found) material.model = found->material, material.textures = found->textures;
            return found != nullptr;
        }
        return std::visit([&](auto& model) { return set_field(model); }, material.model);
    }
    bool set_in(scene::NamedShape& shape) {
        return std::visit([&](auto& s) { return set_field(s); }, shape.shape);
    }

    // `change` gives the thing of an index, to be changed.
    template <class Things, class Change>
    void set_named(const Things& things, Change&& change) {
        const std::string what{path_.what};
        if (!path_.has_name) return wrong("which " + what + " is meant?", "write " + what + ".name.field");
        const auto found = find_named(things, path_.name);
        if (found.empty()) return wrong("there is no " + what + " '" + std::string(path_.name.substr(0, 300)) + "'", nearest_named(things, path_.name));
        for (const std::uint32_t i : found) {
            if (!set_in(change(draft_, i))) return;  // the same would be told of the others
        }
    }
    template <class Owner>
    bool set_single(Owner& owner) {
        const std::string what{path_.what};
        if (!path_.has_name) return set_field(owner);
        wrong("there is only one " + what, "write " + what + "." + std::string(path_.field));
        return false;
    }

    Draft& draft_;
    const Path& path_;
    const Json& value_;
    const Measure& measure_;
    const Place& place_;
    ProblemList& problems_;
};

}  // namespace

void set_value(Draft& draft, std::string_view text, const Json& value, const Measure& measure, const Place& place, ProblemList& problems) {
    const auto path = split(text);
    if (!path) return problems.add(value, place, "has no '.'", "write what.name.field or what.field, such as settings.threshold");
    Setter(draft, *path, value, measure, place, problems).run();
}

}  // namespace crescente::io
