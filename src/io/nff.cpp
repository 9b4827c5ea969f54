#include "io/nff.h"

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "base/spelling.h"
#include "io/text_scanner.h"
#include "io/polygon_collector.h"
#include "io/text_file.h"

namespace crescente::io {
namespace {

using math::Rgb;
using math::Vec3;

const std::vector<std::string> entities{"b", "c", "f", "l", "p", "pp", "s", "v"};
const std::vector<std::string> view_words{"from", "at", "up", "angle", "hither", "yon", "resolution"};

bool is_one_of(std::string_view word, const std::vector<std::string>& words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

Rgb rgb(double r, double g, double b) { return {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)}; }

class NffReader {
public:
    NffReader(std::string_view text, const std::string& file) : in_(text), file_(file) {}

    Expected<Loaded> read() {
        while (in_.to_word() && problems_.size() < most_problems) read_entity();
        if (scene().nodes.empty() && faces_.empty() && problems_.empty()) problem(in_.line(), "there is no object in this file");
        if (!problems_.empty()) return tl::unexpected<Error>(Error{ErrorKind::input, std::move(problems_)});
        finish();
        return std::move(loaded_);
    }

private:
    static constexpr std::size_t most_problems = 50;

    scene::Scene& scene() { return loaded_.scene; }

    void problem(std::size_t line, std::string reason, std::string hint = {}) {
        if (problems_.size() < most_problems) {
            problems_.push_back({file_, "line " + std::to_string(line), std::move(reason), std::move(hint)});
        }
    }
    void warn(std::string reason, std::string place = {}) {
        loaded_.warnings.push_back({file_, std::move(place), std::move(reason), {}});
    }

    void read_entity() {
        entity_line_ = in_.line();
        const std::string_view word = in_.word();
        if (word == "s") return read_sphere();
        if (word == "pp") return read_polygon(true);
        if (word == "p") return read_polygon(false);
        if (word == "c") return read_cone();
        if (word == "f") return read_fill();
        if (word == "l") return read_light();
        if (word == "b") return read_background();
        if (word == "v") return read_view();
        unknown(word, entities);
    }

    void unknown(std::string_view word, const std::vector<std::string>& known) {
        constexpr std::size_t shown = 40;
        problem(in_.line(), "unexpected '" + std::string(word.substr(0, shown)) + "'", spelling_hint(word, known));
        in_.to_next_entity();
    }

    // Reads values.size() numbers. On failure tells what is wrong, goes on to the next entity and returns false.
    bool numbers(std::span<double> values, const char* what) {
        for (double& value : values) {
            const auto result = in_.number(value);
            if (result == TextScanner::Number::good) continue;
            if (result == TextScanner::Number::missing) {
                problem(entity_line_, std::string("the file ends before the last value of ") + what);
                return false;
            }
            const std::string_view word = in_.peek_word();
            if (is_one_of(word, entities) || is_one_of(word, view_words)) {
                problem(entity_line_, std::string("a value is missing: ") + what);
                return false;
            }
            constexpr std::size_t shown = 40;
            problem(in_.line(), "'" + std::string(word.substr(0, shown)) + "' is not a finite number", what);
            in_.to_next_entity();
            return false;
        }
        return true;
    }

    void read_sphere() {
        std::array<double, 4> v;
        if (!numbers(v, "s: centre x y z, radius")) return;
        if (v[3] == 0) return problem(entity_line_, "the radius of a sphere must not be 0");
        if (v[3] < 0) ++inside_out_;
        add_object(geometry::Sphere{std::abs(v[3])}, math::Affine::translation({v[0], v[1], v[2]}));
    }

    void read_cone() {
        std::array<double, 8> v;
        if (!numbers(v, "c: base x y z, base radius, apex x y z, apex radius")) return;
        const Vec3 base{v[0], v[1], v[2]}, axis = Vec3{v[4], v[5], v[6]} - base;
        const double height = length(axis), base_radius = std::abs(v[3]), apex_radius = std::abs(v[7]);
        if (v[3] * v[7] < 0) return problem(entity_line_, "the radii of a cone must have the same sign");
        if (base_radius == 0 && apex_radius == 0) return problem(entity_line_, "the radii of a cone must not both be 0");
        if (!(height > 0) || !std::isfinite(height)) return problem(entity_line_, "base and apex of a cone must be apart");
        if (v[3] < 0 || v[7] < 0) ++inside_out_;
        const Vec3 y = axis / height, x = math::perpendicular(y);
        const math::Affine place{x, y, cross(x, y), base};
        if (base_radius == apex_radius) add_object(geometry::Cylinder{base_radius, height, false}, place);
        else add_object(geometry::Cone{base_radius, apex_radius, height, false}, place);
    }

    void read_polygon(bool patch) {
        double count = 0;
        if (!numbers({&count, 1}, patch ? "pp: number of vertices" : "p: number of vertices")) return;
        if (!(count >= 3) || count != std::floor(count)) {
            problem(entity_line_, "a polygon has a whole number of vertices, at least 3");
            return in_.to_next_entity();
        }
        const std::size_t shortest = patch ? 12 : 6;  // bytes of a vertex
        if (count > static_cast<double>(in_.bytes_left() / shortest + 1)) {
            problem(entity_line_, "the polygon has more vertices than the rest of the file can hold");
            return in_.to_next_entity();
        }
        points_.clear();
        normals_.clear();
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            std::array<double, 6> v;
            if (!numbers({v.data(), patch ? 6u : 3u}, patch ? "pp: vertex x y z, normal x y z" : "p: vertex x y z")) return;
            points_.push_back({v[0], v[1], v[2]});
            if (patch) normals_.push_back({v[3], v[4], v[5]});
        }
        const std::size_t material = material_ ? *material_ + 1 : 0;
        if (faces_.size() <= material) faces_.resize(material + 1);
        if (!material_) ++without_material_;
        faces_[material].add(points_, normals_);
    }

    void read_fill() {
        std::array<double, 9> v{};
        if (!numbers({v.data(), 8}, "f: red green blue Kd Ks Shine T index_of_refraction")) return;
        if (in_.to_word_of_line() && !numbers({v.data() + 8, 1}, "f: Ka")) return;  // Extended NFF, 1993
        for (const double value : v) {
            if (value < 0) return problem(entity_line_, "the values of a fill must not be negative");
        }
        const auto& [r, g, b, kd, ks, shine, t, ior, ka] = v;
        if (t > 0 && !(ior > 0)) return problem(entity_line_, "a transmitting fill needs an index of refraction above 0");
        const auto [known, is_new] = fills_.try_emplace(v, static_cast<std::uint32_t>(scene().materials.size()));
        material_ = known->second;
        if (!is_new) return;
        const Rgb color = rgb(r, g, b);
        const auto share = [&](double factor) { return color * static_cast<float>(factor); };
        scene::ClassicMaterial fill;
        fill.ambient = share(ka);
        fill.diffuse = share(kd);
        fill.specular = fill.reflection = math::gray(static_cast<float>(ks));
        fill.shininess = shine;
        fill.transmission = share(t);
        fill.ior = t > 0 ? ior : 1;
        scene().materials.push_back({{}, fill});
    }

    void read_light() {
        std::array<double, 3> v;
        if (!numbers(v, "l: position x y z, optionally red green blue")) return;
        scene::Light light;
        light.position = {v[0], v[1], v[2]};
        light.falloff = scene::Falloff::none;
        if (in_.to_word_of_line()) {
            if (!numbers(v, "l: red green blue")) return;
            if (v[0] < 0 || v[1] < 0 || v[2] < 0) return problem(entity_line_, "the colour of a light must not be negative");
            light.color = rgb(v[0], v[1], v[2]);
        } else {
            plain_lights_.push_back(scene().lights.size());
        }
        scene().lights.push_back(light);
    }

    void read_background() {
        std::array<double, 3> v;
        if (!numbers(v, "b: red green blue")) return;
        if (v[0] < 0 || v[1] < 0 || v[2] < 0) return problem(entity_line_, "the background must not be negative");
        scene::Environment environment;
        environment.zenith = environment.horizon = environment.nadir = rgb(v[0], v[1], v[2]);
        scene().environment = environment;
    }

    void read_view() {
        const std::size_t view_line = entity_line_;
        if (scene().camera) warn("there is more than one view: the last one is taken", "line " + std::to_string(view_line));
        scene::Camera camera;
        std::vector<std::string> missing{"from", "at", "up", "angle", "resolution"};
        bool good = true;
        while (in_.to_word()) {
            const std::string_view word = in_.peek_word();
            if (is_one_of(word, entities)) break;
            entity_line_ = in_.line();
            in_.word();
            std::erase(missing, word);
            if (!read_view_word(word, camera)) good = false;
            if (problems_.size() >= most_problems) return;
        }
        if (good && !missing.empty()) {
            std::string list;
            for (const std::string& word : missing) list += (list.empty() ? "'" : ", '") + word + "'";
            problem(view_line, "the view lacks " + list);
        }
        scene().camera = camera;
    }

    bool read_view_word(std::string_view word, scene::Camera& camera) {
        std::array<double, 3> v;
        if (word == "from" || word == "at" || word == "up") {
            if (!numbers(v, "x y z")) return false;
            (word == "from" ? camera.position : word == "at" ? camera.target : camera.up) = {v[0], v[1], v[2]};
        } else if (word == "angle") {
            if (!numbers({v.data(), 1}, "angle: degrees")) return false;
            if (!(v[0] > 0 && v[0] < 180)) return problem(entity_line_, "the angle must be between 0 and 180 degrees"), false;
            camera.field_of_view = v[0] * math::pi / 180;
        } else if (word == "hither") {
            if (!numbers({v.data(), 1}, "hither: distance")) return false;
            if (v[0] < 0) return problem(entity_line_, "the hither distance must not be negative"), false;
            camera.near = v[0];
        } else if (word == "yon") {
            if (!numbers({v.data(), 1}, "yon: distance")) return false;
            warn("the yon plane is not applied", "line " + std::to_string(entity_line_));
        } else if (word == "resolution") {
            if (!numbers({v.data(), 2}, "resolution: width and height in pixels")) return false;
            constexpr double largest = 65536;
            for (const double size : {v[0], v[1]}) {
                if (size != std::floor(size) || size < 1 || size > largest) {
                    return problem(entity_line_, "the resolution must be whole numbers of pixels from 1 to 65536"), false;
                }
            }
            scene().settings.width = static_cast<int>(v[0]);
            scene().settings.height = static_cast<int>(v[1]);
        } else {
            return unknown(word, view_words), false;
        }
        return true;
    }

    // The group that gives its children the current material, so that they need no list of their own.
    std::uint32_t group_of(std::size_t material) {
        if (groups_.size() <= material) groups_.resize(material + 1);
        if (!groups_[material].valid()) {
            groups_[material] = {static_cast<std::uint32_t>(scene().nodes.size())};
            scene().nodes.emplace_back();
            if (material > 0) scene().nodes.back().materials.push_back({static_cast<std::uint32_t>(material - 1)});
            scene().roots.push_back(groups_[material]);
        }
        return groups_[material].value;
    }

    void add_object(geometry::Shape shape, const math::Affine& place) {
        if (!material_) ++without_material_;
        add_node(material_ ? *material_ + 1 : 0, std::move(shape), place);
    }

    void add_node(std::size_t material, geometry::Shape shape, const math::Affine& place) {
        const std::uint32_t group = group_of(material);
        scene().nodes[group].children.push_back({static_cast<std::uint32_t>(scene().nodes.size())});
        scene::Node& node = scene().nodes.emplace_back();
        node.transform = place;
        node.shape = {static_cast<std::uint32_t>(scene().shapes.size())};
        scene().shapes.push_back({{}, std::move(shape)});
    }

    void finish() {
        std::size_t without_area = 0, not_planar = 0, normals_lost = 0;
        for (std::size_t material = 0; material < faces_.size(); ++material) {
            PolygonCollector& faces = faces_[material];
            if (!faces.flat.triangles.empty()) add_node(material, std::move(faces.flat), {});
            if (!faces.smooth.triangles.empty()) add_node(material, std::move(faces.smooth), {});
            for (geometry::Polygon& polygon : faces.polygons) add_node(material, std::move(polygon), {});
            without_area += faces.without_area;
            not_planar += faces.not_planar;
            normals_lost += faces.normals_lost;
        }
        const auto told = [&](std::size_t count, const char* what) {
            if (count > 0) warn(std::to_string(count) + what);
        };
        told(without_area, " polygons have no area and were dropped");
        told(not_planar, " polygons are neither convex nor planar and were flattened");
        told(normals_lost, " patches are not convex: their normals are not applied");
        told(inside_out_, " spheres and cones have negative radii (seen only from inside): they are seen from both sides");
        told(without_material_, " objects come before the first fill: they have the default material");
        if (!scene().camera) warn("there is no view");

        // All lights together are as bright for any number of them, as the format's author recommends.
        for (const std::size_t light : plain_lights_) {
            scene().lights[light].intensity = 1 / std::sqrt(static_cast<double>(scene().lights.size()));
        }
        scene().settings.depth = 4;  // the format's databases prescribe trees of depth 5, the camera ray included
    }

    TextScanner in_;
    const std::string& file_;
    Loaded loaded_;
    Problems problems_;
    std::size_t entity_line_ = 1;
    std::optional<std::uint32_t> material_;                      // of the objects that follow
    std::map<std::array<double, 9>, std::uint32_t> fills_;       // materials known, by their values
    std::vector<scene::NodeId> groups_;                          // by material + 1; 0: none
    std::vector<PolygonCollector> faces_;                        // the same
    std::vector<std::size_t> plain_lights_;                      // without a colour of their own
    std::vector<Vec3> points_, normals_;                         // of the polygon being read
    std::size_t inside_out_ = 0, without_material_ = 0;
};

}  // namespace

Expected<Loaded> read_nff_file(const std::filesystem::path& file) {
    return read_whole_file(file).and_then([&](const std::string& text) { return read_nff(text, file.string()); });
}

Expected<Loaded> read_nff(std::string_view text, const std::string& file_name) { return NffReader(text, file_name).read(); }

}  // namespace crescente::io
