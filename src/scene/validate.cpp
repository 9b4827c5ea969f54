#include "scene/validate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/spelling.h"
#include "scene/camera_check.h"
#include "scene/field_check.h"

namespace crescente::scene {
namespace {

using math::Affine;
using math::Vec3;

std::string escaped(const std::string& key) {
    std::string result;
    for (const char c : key) result += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return result;
}

std::string key_of(const std::string& name, std::size_t index) { return name.empty() ? std::to_string(index) : escaped(name); }

class Validator {
public:
    Validator(const Scene& scene, const std::string& file) : scene_(scene), file_(file) {}

    // `all`: or of shapes the edited ones alone.
    Problems run(bool all, std::span<const ShapeId> edited) {
        check_things();
        for (std::uint32_t i = 0; all && i < scene_.shapes.size(); ++i) check_shape(i);
        for (const ShapeId shape : edited) check_shape(shape.value);
        if (check_hierarchy()) check_visible(all);
        return std::move(problems_);
    }

private:
    static constexpr std::size_t most_problems = 1000;

    void check_shape(std::uint32_t i) {
        const std::string place = "/shapes/" + key_of(scene_.shapes[i].name, i);
        std::visit([&](const auto& shape) {
            check_fields(shape, place + "/" + std::string(geometry::shape_names[scene_.shapes[i].shape.index()]));
            check_shape(shape, place);
        }, scene_.shapes[i].shape);
    }

    // All but shapes and hierarchy.
    void check_things() {
        check_fields(scene_.settings, "/settings");
        check_picture_size();
        if (scene_.camera) check_camera(*scene_.camera);
        if (scene_.environment) {
            check_fields(*scene_.environment, "/environment");
            if (!scene_.environment->image.empty() && !scene_.environment->panorama) add("/environment/image", "the picture was not read");
            if (!scene_.environment->sky.empty() && !scene_.environment->panorama) add("/environment/sky", "the sky was not made");
        }
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) check_light(scene_.lights[i], "/lights/" + key_of(scene_.lights[i].name, i));
        check_light_groups();
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            const std::string place = "/materials/" + key_of(scene_.materials[i].name, i);
            std::visit([&](const auto& model) { check_fields(model, place); }, scene_.materials[i].model);
            if (const auto* m = std::get_if<PhysicalMaterial>(&scene_.materials[i].model)) check_grain(*m, place), check_index(*m, place);
            for (const TextureBinding& binding : scene_.materials[i].textures) check_texture(scene_.materials[i], binding, place + "/textures/" + escaped(binding.target));
        }
    }

    void add(const std::string& place, std::string reason, std::string hint = {}) {
        if (problems_.size() < most_problems) problems_.push_back({file_, place, std::move(reason), std::move(hint)});
        else if (problems_.size() == most_problems) problems_.push_back({file_, {}, "there are more problems", {}});
    }

    // Lengths are told as the user measures them.
    std::string length_text(double metres) const { return number_text(metres / scene_.unit.metres) + " " + scene_.unit.name; }

    template <class Owner>
    void check_fields(const Owner& owner, const std::string& place) {
        for (const auto& f : Owner::fields()) {
            if (const auto wrong = range_problem(f.info, f.get(owner), scene_.unit.metres, scene_.unit.name)) add(place + "/" + f.info.name, *wrong);
        }
    }

    void check_grain(const PhysicalMaterial& m, const std::string& place) {
        const double l = length(m.grain_axis);
        if (is_finite(m.grain_axis) && !(l > 0 && std::isfinite(l))) add(place + "/grain_axis", "has no direction");
    }

    void check_index(const PhysicalMaterial& m, const std::string& place) {
        if (m.ior > 0 && m.ior < 1) add(place + "/ior", "is " + number_text(m.ior) + ", must be 1 or more, or 0 for infinite");
    }

    void check_texture(const Material& material, const TextureBinding& binding, const std::string& place) {
        const Texture& texture = binding.texture;
        check_fields(texture, place);
        const bool is_relief = std::find(std::begin(relief_targets), std::end(relief_targets), binding.target) != std::end(relief_targets);
        if (!is_relief && !textured_field(material, binding.target)) add(place, "there is nothing of this name that a texture may act on");
        if (texture.kind == TextureKind::image && !(texture.image && texture.image->decoded())) add(place + "/image", "the picture is not loaded");
        if (texture.projection == TextureProjection::solid && texture.kind == TextureKind::image) add(place + "/projection", "a picture is flat: only procedures can be carved from a block");
        if (texture.cutoff > 0 && binding.target != "opacity") add(place + "/cutoff", "only opacity can be cut off");
        if (!is_finite(texture.axis)) return;  // told above
        const double l = length(texture.axis);
        if (!(l > 0 && std::isfinite(l))) add(place + "/axis", "its length is " + number_text(l) + ": it points nowhere");
    }

    void positive(double value, const std::string& place) {
        if (value == 0) add(place, "is 0, must be more than 0");
    }

    void check_picture_size() {
        const auto pixels = std::int64_t{scene_.settings.width} * scene_.settings.height;
        constexpr std::int64_t most_pixels = std::int64_t{1} << 31;
        if (scene_.settings.width > 0 && scene_.settings.height > 0 && pixels > most_pixels) {
            add("/settings", "a picture of " + std::to_string(scene_.settings.width) + " x " + std::to_string(scene_.settings.height) +
                                 " pixels is larger than the " + std::to_string(most_pixels) + " that can be held");
        }
    }

    void check_camera(const Camera& camera) {
        check_fields(camera, "/camera");
        for (auto& [place, reason] : camera_problems(camera)) add("/camera" + place, std::move(reason));
    }

    void check_light(const Light& light, const std::string& place) {
        check_fields(light, place);
        const bool oriented = light.kind == LightKind::directional || is_flat(light) || (!has_extent(light) && light.outer_angle < math::pi);
        if (is_finite(light.direction)) {
            const double l = length(light.direction);
            if (oriented && !(l > 0 && std::isfinite(l))) add(place + "/direction", "its length is " + number_text(l) + ": it points nowhere");
        }
        if (light.kind == LightKind::point && light.inner_angle > light.outer_angle) {
            const auto degrees = [](double radians) { return number_text(std::round(radians * 180 / math::pi * 1e9) / 1e9); };
            add(place + "/inner_angle", "is " + degrees(light.inner_angle) + " deg, more than the outer angle of " + degrees(light.outer_angle) + " deg");
        }
        if (light.falloff == Falloff::classic && light.constant == 0 && light.linear == 0 && light.quadratic == 0) {
            add(place + "/constant", "all terms of the classic falloff are 0");
        }
        for (const auto& [list, field] : {std::pair{&light.only, "/only/"}, std::pair{&light.except, "/except/"}}) {
            for (std::size_t i = 0; i < list->size(); ++i) check_object_name((*list)[i], place + field + std::to_string(i));
        }
        if (has_extent(light)) check_extent(light, place);
        if (!light.profile.empty()) check_profile(light, place);
    }

    void check_object_name(const std::string& name, const std::string& place) {
        if (node_names_.empty()) std::transform(scene_.nodes.begin(), scene_.nodes.end(), std::inserter(node_names_, node_names_.end()), [](const Node& n) { return n.name; });
        if (!name.empty() && node_names_.contains(name)) return;
        constexpr std::ptrdiff_t most_candidates = 10000;
        const std::vector<std::string> known(node_names_.begin(), std::next(node_names_.begin(), std::min(most_candidates, std::ssize(node_names_))));
        add(place, "there is no object '" + name.substr(0, 300) + "'", spelling_hint(name, known));
    }

    void check_profile(const Light& light, const std::string& place) {
        if (light.kind != LightKind::point) return add(place + "/profile", "only point lights have one");
        if (!light.measured) add(place + "/profile", "the file was not read");
        check_upward(light, place);
        const double direction = length(light.direction);
        if (is_finite(light.direction) && light.outer_angle >= math::pi && !(direction > 0 && std::isfinite(direction))) {
            add(place + "/direction", "its length is " + number_text(direction) + ": it points nowhere");
        }
    }

    void check_upward(const Light& light, const std::string& place) {
        const double up = length(light.up);
        if (is_finite(light.up) && !(up > 0 && std::isfinite(up))) add(place + "/up", "its length is " + number_text(up) + ": it points nowhere");
    }

    void check_extent(const Light& light, const std::string& place) {
        if (light.kind == LightKind::rectangle) {
            positive(light.width, place + "/width"), positive(light.height, place + "/height");
            check_upward(light, place);
        } else {
            positive(light.radius, place + "/radius");
        }
        const double area = visible_area(light);
        if (std::isinf(area) || (area == 0 && light.radius > 0 && light.width > 0 && light.height > 0)) {
            add(place, "its area cannot be computed: the lengths are too " + std::string(area == 0 ? "small" : "large"));
        }
        const auto only_points = [&](const char* field, bool has) {
            if (has) add(place + "/" + field, "only lights without extent have one", "a light with extent shines evenly, and falls off with the square of the distance");
        };
        only_points("outer_angle", light.outer_angle < math::pi);
        only_points("falloff", light.falloff != Falloff::inverse_square);
        only_points("range", light.range > 0);
    }

    // Lights of one group are one: what is said of all must be the same.
    void check_light_groups() {
        std::unordered_map<std::string, const Light*> first;
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            const Light& light = scene_.lights[i];
            if (light.group.empty() || !has_extent(light)) continue;
            const Light& other = *first.emplace(light.group, &light).first->second;
            const auto differ = [&](const char* field, bool a, bool b) {
                if (a != b) add("/lights/" + key_of(light.name, i) + "/" + field, "differs from that of another light of the group \"" + light.group + "\"");
            };
            differ("shadows", light.shadows, other.shadows), differ("highlights", light.highlights, other.highlights);
        }
    }

    // --- shapes: what the field tables cannot say

    void check_shape(const geometry::Sphere& s, const std::string& place) { positive(s.radius, place + "/sphere/radius"); }
    void check_shape(const geometry::Box& box, const std::string& place) {
        for (int axis = 0; axis < 3; ++axis) {
            if (box.lower[axis] >= box.upper[axis]) {
                add(place + "/box", std::string("in ") + "xyz"[axis] + " the lower corner (" + length_text(box.lower[axis]) +
                                        ") is not below the upper one (" + length_text(box.upper[axis]) + ")");
            }
        }
    }
    void check_shape(const geometry::Cone& cone, const std::string& place) {
        if (cone.base_radius == 0 && cone.top_radius == 0) add(place + "/cone/base_radius", "both radii are 0");
        positive(cone.height, place + "/cone/height");
    }
    void check_shape(const geometry::Cylinder& cylinder, const std::string& place) {
        positive(cylinder.radius, place + "/cylinder/radius");
        positive(cylinder.height, place + "/cylinder/height");
    }
    void check_shape(const geometry::Torus& torus, const std::string& place) { positive(torus.minor_radius, place + "/torus/minor_radius"); }
    void check_shape(const geometry::Disk& disk, const std::string& place) {
        if (disk.inner_radius >= disk.radius) add(place + "/disk/inner_radius", "is not smaller than the radius");
    }
    void check_shape(const geometry::Plane&, const std::string&) {}
    template <class Kind>
        requires requires(const Kind& shape) { shape.patches(); }
    void check_shape(const Kind& shape, const std::string& place) {
        const auto patches = shape.patches();
        if (patches) return;
        const std::string name{geometry::shape_names[geometry::Shape(shape).index()]};
        for (const Problem& problem : patches.error().problems) add(place + "/" + name + "/" + problem.place, problem.reason, problem.hint);
    }

    void check_shape(const geometry::Polygon& polygon, const std::string& place) {
        const std::string here = place + "/polygon/loops";
        if (polygon.loops.empty()) return add(here, "a polygon needs at least one loop");
        math::Bounds box;
        bool usable = true;
        for (std::size_t i = 0; i < polygon.loops.size(); ++i) {
            if (polygon.loops[i].size() < 3) {
                add(here + "/" + std::to_string(i), "has " + std::to_string(polygon.loops[i].size()) + " points, needs at least 3");
                usable = false;
            }
            for (std::size_t j = 0; j < polygon.loops[i].size(); ++j) {
                if (is_finite(polygon.loops[i][j])) box.include(polygon.loops[i][j]);
                else add(here + "/" + std::to_string(i) + "/" + std::to_string(j), "is not a finite point"), usable = false;
            }
        }
        if (usable) check_plane(polygon, here, box);
    }

    // All points must lie in the plane of the first loop, whose normal is found by Newell's method (Sutherland et al. 1974).
    void check_plane(const geometry::Polygon& polygon, const std::string& here, const math::Bounds& box) {
        constexpr double flatness = 1e-6, least_area = 1e-12;  // shares of the size and of its square
        const double size = length(box.diagonal());
        if (!(size > 0) || !std::isfinite(size)) return add(here, size > 0 ? "is too large to compute with" : "all points are the same");
        const auto& first = polygon.loops.front();
        const Vec3 origin = first.front();
        Vec3 normal{};
        for (std::size_t i = 0; i < first.size(); ++i) normal += cross((first[i] - origin) / size, (first[(i + 1) % first.size()] - origin) / size);
        const double area = length(normal) / 2;
        if (!(area > least_area)) return add(here + "/0", "encloses no area");
        normal = normalize(normal);
        double worst = 0;
        for (const auto& loop : polygon.loops) {
            for (const Vec3 p : loop) worst = std::max(worst, std::abs(dot(p - origin, normal)));
        }
        if (worst > flatness * size) add(here, "the points are not in one plane: one lies " + length_text(worst) + " off");
    }

    void check_shape(const geometry::Brep& brep, const std::string& place) {
        if (brep.face_count() == 0) add(place + "/brep", "a part needs at least one face");
    }

    void check_shape(const geometry::Mesh& mesh, const std::string& place) {
        const std::string here = place + "/mesh";
        if (mesh.triangles.empty()) add(here + "/triangles", "a mesh needs at least one triangle");
        if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) add(here + "/triangles", "too many triangles");
        // One pass over each array; the first wrong element and the number of them say enough.
        report_first(here + "/positions", "is not a finite point", mesh.positions.size(), [&](std::size_t i) { return is_finite(mesh.positions[i]); });
        const std::size_t vertices = mesh.positions.size();
        report_first(here + "/triangles", "names a vertex beyond the " + std::to_string(vertices) + " positions", mesh.triangles.size(),
                     [&](std::size_t i) {
                         const auto& t = mesh.triangles[i];
                         return t[0] < vertices && t[1] < vertices && t[2] < vertices;
                     });
        if (!mesh.normals.empty() && mesh.normals.size() != vertices && mesh.normals.size() != 3 * mesh.triangles.size()) {
            add(here + "/normals", "there are " + std::to_string(mesh.normals.size()) + " normals, must be one for each of " +
                                       std::to_string(vertices) + " positions or " + std::to_string(3 * mesh.triangles.size()) + " corners");
        }
        report_first(here + "/normals", "is not a finite vector", mesh.normals.size(), [&](std::size_t i) {
            const auto& n = mesh.normals[i];
            return std::isfinite(n[0]) && std::isfinite(n[1]) && std::isfinite(n[2]);
        });
        check_attributes(here + "/coordinates", mesh.coordinates[0], vertices);
        check_attributes(here + "/coordinates_2", mesh.coordinates[1], vertices);
        check_attributes(here + "/colors", mesh.colors, vertices);
        check_attributes(here + "/tangents", mesh.tangents, vertices);
        if (!mesh.slots.empty() && mesh.slots.size() != mesh.triangles.size()) {
            add(here + "/slots", "there are " + std::to_string(mesh.slots.size()) + " slots for " + std::to_string(mesh.triangles.size()) + " triangles");
        }
    }

    template <std::size_t n>
    void check_attributes(const std::string& place, const std::vector<std::array<float, n>>& attributes, std::size_t vertices) {
        if (!attributes.empty() && attributes.size() != vertices) {
            add(place, "there are " + std::to_string(attributes.size()) + ", must be one for each of " + std::to_string(vertices) + " positions");
        }
        report_first(place, "is not finite", attributes.size(), [&](std::size_t i) {
            return std::all_of(attributes[i].begin(), attributes[i].end(), [](float v) { return std::isfinite(v); });
        });
    }

    template <class Good>
    void report_first(const std::string& place, const std::string& reason, std::size_t count, Good&& good) {
        std::size_t first = count, wrong = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (good(i)) continue;
            if (wrong++ == 0) first = i;
        }
        if (wrong > 0) add(place + "/" + std::to_string(first), reason + (wrong > 1 ? " (and " + std::to_string(wrong - 1) + " more like it)" : ""));
    }

    // --- the hierarchy

    // Whether it can be walked through.
    bool check_hierarchy() {
        const auto nodes = scene_.nodes.size();
        parents_.assign(nodes, NodeId::none);
        bool usable = true;
        for (std::size_t i = 0; i < scene_.roots.size(); ++i) {
            if (scene_.roots[i].value < nodes) continue;
            add("/objects/" + std::to_string(i), "there is no node " + std::to_string(scene_.roots[i].value));
            usable = false;
        }
        for (std::uint32_t i = 0; i < nodes; ++i) {
            for (const NodeId child : scene_.nodes[i].children) {
                if (child.value < nodes) {
                    if (parents_[child.value] == NodeId::none) parents_[child.value] = i;
                    continue;
                }
                add(place_of(i) + "/children", "there is no node " + std::to_string(child.value));
                usable = false;
            }
        }
        for (std::uint32_t i = 0; i < nodes; ++i) check_node(i);
        return usable && !find_cycle();
    }

    // "/objects/car/children/wheel": the way down from a root, of which a long one is cut at its beginning.
    std::string place_of(std::uint32_t node) const {
        constexpr std::size_t longest = 8;
        std::string path;
        std::uint32_t at = node;
        for (std::size_t steps = 0;; ++steps) {
            const std::string key = key_of(scene_.nodes[at].name, at);
            const bool root = parents_[at] == NodeId::none;
            path = (root ? "/objects/" : "/children/") + key + path;
            if (root) return path;
            if (steps == longest) return "/objects/..." + path;
            at = parents_[at];
        }
    }

    void check_node(std::uint32_t i) {
        const Node& node = scene_.nodes[i];
        if (node.shape.valid() && node.shape.value >= scene_.shapes.size()) add(place_of(i) + "/shape", "there is no shape " + std::to_string(node.shape.value));
        for (const MaterialId material : node.materials) {
            if (material.value >= scene_.materials.size()) {
                add(place_of(i) + "/materials", material.valid() ? "there is no material " + std::to_string(material.value) : "a material is missing");
            }
        }
        check_transform(node.transform, place_of(i) + "/transform");
        if (!node.motion) return;
        const std::size_t before = problems_.size();
        check_transform(*node.motion, place_of(i) + "/motion");
        if (problems_.size() == before && node.motion->determinant() < 0) add(place_of(i) + "/motion", "turns the object inside out, which nothing does step by step");
    }

    void check_transform(const Affine& a, const std::string& place) {
        if (!is_finite(a.x) || !is_finite(a.y) || !is_finite(a.z) || !is_finite(a.origin)) return add(place, "has numbers that are not finite");
        // The volume of the unit cube's image against that of a box with its edges: how far it is from flat.
        const double edges = length(a.x) * length(a.y) * length(a.z);
        constexpr double flattest = 1e-12;
        if (!std::isfinite(edges) || !is_finite(inverse(a).x) || !is_finite(inverse(a).y) || !is_finite(inverse(a).z) ||
            !is_finite(inverse(a).origin) || !(std::abs(a.determinant()) > flattest * edges)) {
            add(place, "cannot be inverted: it flattens what it transforms, or scales beyond all numbers");
        }
    }

    // Depth-first, without recursion: a hierarchy may be very deep. Names a cycle if there is one.
    bool find_cycle() {
        enum : std::uint8_t { unseen, open, done };
        std::vector<std::uint8_t> state(scene_.nodes.size(), unseen);
        struct Step {
            std::uint32_t node;
            std::size_t next_child;
        };
        std::vector<Step> path;
        for (std::uint32_t start = 0; start < scene_.nodes.size(); ++start) {
            if (state[start] != unseen) continue;
            path.push_back({start, 0});
            state[start] = open;
            while (!path.empty()) {
                Step& step = path.back();
                const auto& children = scene_.nodes[step.node].children;
                if (step.next_child == children.size()) {
                    state[step.node] = done;
                    path.pop_back();
                    continue;
                }
                const std::uint32_t child = children[step.next_child++].value;
                if (state[child] == open) {
                    report_cycle(path, child);
                    return true;
                }
                if (state[child] == unseen) {
                    state[child] = open;
                    path.push_back({child, 0});
                }
            }
        }
        return false;
    }

    template <class Path>
    void report_cycle(const Path& path, std::uint32_t from) {
        constexpr std::size_t longest = 10;
        const auto name = [&](std::uint32_t node) { return "'" + (scene_.nodes[node].name.empty() ? std::to_string(node) : scene_.nodes[node].name) + "'"; };
        std::string text;
        bool inside = false;
        std::size_t count = 0;
        for (const auto& step : path) {
            inside = inside || step.node == from;
            if (inside && ++count <= longest) text += name(step.node) + " -> ";
        }
        if (count > longest) text += "... -> ";
        add("/objects", "the hierarchy goes round in a circle: " + text + name(from));
    }

    // Whether something is seen. Also counts what a walk down the hierarchy comes by: nested instances multiply, with and without shapes.
    void check_visible(bool required) {
        struct Below {
            double shapes = -1, places = 0;  // at and below a node, hidden ones left out; as doubles they cannot overflow
        };
        std::vector<Below> below(scene_.nodes.size());
        std::vector<std::pair<std::uint32_t, bool>> open;
        double shapes = 0, places = 0;
        for (const NodeId root : scene_.roots) {
            open.push_back({root.value, false});
            while (!open.empty()) {
                const auto [node, children_known] = open.back();
                open.pop_back();
                Below& sum = below[node];
                if (sum.shapes >= 0) continue;
                const Node& n = scene_.nodes[node];
                if (!n.visible) {
                    sum = {0, 1};
                } else if (!children_known) {
                    open.push_back({node, true});
                    for (const NodeId child : n.children) {
                        if (below[child.value].shapes < 0) open.push_back({child.value, false});
                    }
                } else {
                    sum = {n.shape.valid() ? 1.0 : 0.0, 1};
                    for (const NodeId child : n.children) sum.shapes += below[child.value].shapes, sum.places += below[child.value].places;
                }
            }
            shapes += below[root.value].shapes;
            places += below[root.value].places;
        }
        constexpr double most_shapes = 1 << 26, most_places = 1 << 28;  // some 16 GB, and some seconds to walk through
        if (required && shapes == 0) add("/objects", "nothing in the scene can be seen", "no visible object has a shape");
        if (shapes > most_shapes) {
            add("/objects", "the instances show " + number_text(shapes) + " shapes, more than the " + number_text(most_shapes) + " that can be held");
        } else if (places > most_places) {
            add("/objects", "shared groups make " + number_text(places) + " places, more than the " + number_text(most_places) + " that can be walked through");
        }
    }

    const Scene& scene_;
    const std::string& file_;
    Problems problems_;
    std::vector<std::uint32_t> parents_;  // the first parent of each node
    std::set<std::string> node_names_;  // once they were asked for
};

}  // namespace

Problems validate(const Scene& scene, const std::string& file) { return Validator{scene, file}.run(true, {}); }

Problems validate_edited(const Scene& scene, const std::string& file, std::span<const ShapeId> edited) { return Validator{scene, file}.run(false, edited); }

}  // namespace crescente::scene
