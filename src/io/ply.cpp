#include "io/ply.h"

#include <algorithm>
#include <cstring>

#include "base/spelling.h"
#include "io/mesh_scene.h"
#include "io/polygon_collector.h"
#include "io/text_file.h"
#include "io/text_scanner.h"

namespace crescente::io {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64, none };

constexpr std::size_t size_of(Type type) {
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8, 0};
    return sizes[static_cast<std::size_t>(type)];
}

Type type_named(std::string_view name) {
    constexpr std::pair<std::string_view, Type> names[] = {
        {"char", Type::int8},    {"int8", Type::int8},     {"uchar", Type::uint8},   {"uint8", Type::uint8},   {"short", Type::int16},
        {"int16", Type::int16},  {"ushort", Type::uint16}, {"uint16", Type::uint16}, {"int", Type::int32},     {"int32", Type::int32},
        {"uint", Type::uint32},  {"uint32", Type::uint32}, {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64},
        {"float64", Type::float64}};
    for (const auto& [known, type] : names) {
        if (known == name) return type;
    }
    return Type::none;
}

// What a property means here.
enum class Role { x, y, z, nx, ny, nz, red, green, blue, corners, other };

Role role_of(std::string_view element, std::string_view name) {
    constexpr std::pair<std::string_view, Role> of_vertex[] = {{"x", Role::x},     {"y", Role::y},     {"z", Role::z},
                                                               {"nx", Role::nx},   {"ny", Role::ny},   {"nz", Role::nz},
                                                               {"red", Role::red}, {"green", Role::green}, {"blue", Role::blue}};
    if (element == "face" && (name == "vertex_indices" || name == "vertex_index")) return Role::corners;
    for (const auto& [known, role] : of_vertex) {
        if (element == "vertex" && known == name) return role;
    }
    return Role::other;
}

struct Property {
    Type count_type = Type::none;  // of a list
    Type type = Type::none;
    Role role = Role::other;
    bool is_list() const { return count_type != Type::none; }
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

class PlyReader {
public:
    PlyReader(std::string_view bytes, const std::string& file) : in_(bytes), file_(file), end_(bytes.data() + bytes.size()) {}

    Expected<Loaded> read() {
        if (read_header() && problems_.empty()) {
            at_ = in_.at();
            for (const Element& element : elements_) {
                if (!read_element(element)) break;
            }
        }
        if (!problems_.empty()) return tl::unexpected<Error>(Error{ErrorKind::input, std::move(problems_)});
        finish();
        return scene_of(std::move(content_), file_, std::move(warnings_));
    }

private:
    static constexpr std::size_t most_problems = 50;

    bool problem(std::string place, std::string reason, std::string hint = {}) {
        if (problems_.size() < most_problems) problems_.push_back({file_, std::move(place), std::move(reason), std::move(hint)});
        return false;
    }
    bool header_problem(std::string reason, std::string hint = {}) {
        return problem("line " + std::to_string(in_.line()), std::move(reason), std::move(hint));
    }

    bool read_header() {
        static const std::vector<std::string> words{"format", "comment", "obj_info", "element", "property", "end_header"};
        if (in_.rest_of_line() != "ply") return problem("line 1", "this is not PLY: the first line must be 'ply'");
        bool has_format = false;
        while (problems_.size() < most_problems) {
            if (in_.bytes_left() == 0) return problem("", "the file ends inside its header");
            if (!in_.to_word_of_line()) {
                in_.rest_of_line();
                continue;
            }
            const std::string_view word = in_.word();
            if (word == "end_header") {
                in_.rest_of_line();
                return has_format || problem("", "the header names no format");
            }
            if (word == "format") has_format = read_format();
            else if (word == "element") read_element_line();
            else if (word == "property") read_property_line();
            else if (word != "comment" && word != "obj_info") {
                // Old exporters forgot the word "comment"; a word misspelt is an error.
                const std::string reason = "unexpected '" + std::string(word.substr(0, 40)) + "'", near = nearest_spelling(word, words);
                if (!near.empty()) header_problem(reason, "did you mean '" + near + "'?");
                else warnings_.push_back({file_, "line " + std::to_string(in_.line()), reason + ": the line is not read", {}});
                if (warnings_.size() > most_problems) return problem("", "the header is not one of PLY");
            }
            in_.rest_of_line();
        }
        return false;
    }

    std::string_view header_word() { return in_.to_word_of_line() ? in_.word() : std::string_view{}; }

    bool read_format() {
        const std::string_view name = header_word();
        text_ = name == "ascii";
        swapped_ = name == "binary_big_endian";
        if (text_ || swapped_ || name == "binary_little_endian") return true;
        return header_problem("the format must be ascii, binary_little_endian or binary_big_endian");
    }

    void read_element_line() {
        Element element;
        element.name = std::string(header_word().substr(0, 100));
        double count = -1;
        if (in_.to_word_of_line()) in_.number(count);
        if (!(count >= 0 && count < 4294967295.0 && count == std::floor(count))) {
            header_problem("an element needs a name and a number");
            count = 0;
        }
        element.count = static_cast<std::size_t>(count);
        elements_.push_back(std::move(element));
    }

    void read_property_line() {
        if (elements_.empty()) {
            header_problem("a property comes before any element");
            return;
        }
        Property property;
        std::string_view type = header_word();
        if (type == "list") {
            property.count_type = type_named(header_word());
            if (property.count_type >= Type::float32) header_problem("the length of a list must be of an integer type");
            type = header_word();
        }
        property.type = type_named(type);
        if (property.type == Type::none) header_problem("a property has no type that PLY knows");
        property.role = role_of(elements_.back().name, header_word());
        if ((property.role == Role::corners) != property.is_list()) property.role = Role::other;
        elements_.back().properties.push_back(property);
    }

    template <class T>
    double load() {
        char bytes[sizeof(T)];
        std::memcpy(bytes, at_, sizeof(T));
        if (swapped_) std::reverse(bytes, bytes + sizeof(T));
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        at_ += sizeof(T);
        return static_cast<double>(value);
    }

    bool value(Type type, double& to) {
        if (text_) {
            const auto result = in_.number(to);
            if (result == TextScanner::Number::good) return true;
            if (result == TextScanner::Number::missing) return problem("", "the file is cut: its header promises more");
            return header_problem("'" + std::string(in_.peek_word().substr(0, 40)) + "' is not a finite number");
        }
        if (static_cast<std::size_t>(end_ - at_) < size_of(type)) return problem("", "the file is cut: its header promises more");
        switch (type) {
            case Type::int8: to = load<std::int8_t>(); break;
            case Type::uint8: to = load<std::uint8_t>(); break;
            case Type::int16: to = load<std::int16_t>(); break;
            case Type::uint16: to = load<std::uint16_t>(); break;
            case Type::int32: to = load<std::int32_t>(); break;
            case Type::uint32: to = load<std::uint32_t>(); break;
            case Type::float32: to = load<float>(); break;
            default: to = load<double>(); break;
        }
        return true;
    }

    bool read_element(const Element& element) {
        std::size_t least = 0;  // bytes that one takes at least; a digit and what parts it in text
        for (const Property& p : element.properties) least += text_ ? 2 : size_of(p.is_list() ? p.count_type : p.type);
        const std::size_t left = text_ ? in_.bytes_left() + 1 : static_cast<std::size_t>(end_ - at_);
        if (element.count > 0 && (least == 0 || element.count > left / least)) {
            return problem("", "the file is cut, or its header promises more '" + element.name + "' than it holds");
        }
        const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
        if (is_vertex && has_normals_.has_value()) return problem("", "there is more than one list of vertices");
        if (is_vertex) start_vertices(element);
        for (std::size_t i = 0; i < element.count; ++i) {
            corners_.clear();
            for (const Property& property : element.properties) {
                double number = 0;
                if (!property.is_list()) {
                    if (!value(property.type, number)) return false;
                    values_[static_cast<std::size_t>(property.role)] = number / scale_of(property);
                    continue;
                }
                if (!value(property.count_type, number)) return false;
                const std::size_t bytes = text_ ? in_.bytes_left() / 2 + 1 : static_cast<std::size_t>(end_ - at_) / size_of(property.type);
                if (!(number >= 0 && number <= static_cast<double>(bytes))) return problem("", "a list is longer than the rest of the file");
                for (auto n = static_cast<std::size_t>(number); n > 0; --n) {
                    if (!value(property.type, number)) return false;
                    if (property.role != Role::corners) continue;
                    if (!(number >= 0 && number < static_cast<double>(content_.mesh.positions.size()))) {
                        return problem("face " + std::to_string(i), "has a vertex that is not there");
                    }
                    corners_.push_back(static_cast<std::uint32_t>(number));
                }
            }
            if (is_vertex) add_vertex();
            if (is_face) add_face();
        }
        return true;
    }

    static double scale_of(const Property& property) {
        const bool is_color = property.role == Role::red || property.role == Role::green || property.role == Role::blue;
        return !is_color ? 1 : property.type == Type::uint8 ? 255 : property.type == Type::uint16 ? 65535 : 1;
    }

    double value_of(Role role) const { return values_[static_cast<std::size_t>(role)]; }

    void start_vertices(const Element& element) {
        const auto has = [&](Role role) {
            return std::any_of(element.properties.begin(), element.properties.end(), [=](const Property& p) { return p.role == role; });
        };
        if (!has(Role::x) || !has(Role::y) || !has(Role::z)) problem("", "the vertices have no x, y and z");
        has_normals_ = has(Role::nx) && has(Role::ny) && has(Role::nz);
        has_colors_ = has(Role::red) && has(Role::green) && has(Role::blue);
        content_.mesh.positions.reserve(element.count);
        if (*has_normals_) normals_.reserve(element.count);
    }

    void add_vertex() {
        content_.mesh.positions.push_back({value_of(Role::x), value_of(Role::y), value_of(Role::z)});
        if (*has_normals_) {
            const math::Vec3 n{value_of(Role::nx), value_of(Role::ny), value_of(Role::nz)};
            const math::Vec3 unit = n / length(n);
            if (!is_finite(unit)) all_normals_good_ = false;
            normals_.push_back({static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)});
        }
        if (has_colors_) color_sum_ += {value_of(Role::red), value_of(Role::green), value_of(Role::blue)};
    }

    void add_face() {
        geometry::Mesh& mesh = content_.mesh;
        if (corners_.size() < 3) {
            ++not_faces_;
            return;
        }
        if (corners_.size() > 3) {
            ring_.clear();
            for (const std::uint32_t corner : corners_) ring_.push_back(mesh.positions[corner]);
            if (!is_convex(ring_)) return not_convex_.add(ring_, {});
        }
        for (std::size_t i = 1; i + 1 < corners_.size(); ++i) mesh.triangles.push_back({corners_[0], corners_[i], corners_[i + 1]});
    }

    void finish() {
        content_.z_up = true;
        geometry::Mesh& mesh = content_.mesh;
        if (has_normals_.value_or(false) && all_normals_good_) {
            mesh.normals.reserve(3 * mesh.triangles.size());  // for corners, the layout that no number can mistake
            for (const auto& triangle : mesh.triangles) {
                for (const std::uint32_t corner : triangle) mesh.normals.push_back(normals_[corner]);
            }
        }
        const auto warn = [&](std::string reason) { warnings_.push_back({file_, {}, std::move(reason), {}}); };
        if (has_colors_ && !mesh.positions.empty()) {
            const math::Vec3 mean = color_sum_ / static_cast<double>(mesh.positions.size());
            const auto channel = [](double v) { return static_cast<float>(std::clamp(std::isfinite(v) ? v : 0.0, 0.0, 1.0)); };
            content_.color = math::Rgb{channel(mean.x), channel(mean.y), channel(mean.z)};
            warn("vertex colours are not applied: their mean stands in");
        }
        if (not_faces_ > 0) warn(std::to_string(not_faces_) + " faces have less than three vertices and are not shown");
        if (not_convex_.without_area > 0) warn(std::to_string(not_convex_.without_area) + " polygons have no area and were dropped");
        if (not_convex_.not_planar > 0) warn(std::to_string(not_convex_.not_planar) + " polygons are neither convex nor planar and were flattened");
        content_.polygons = std::move(not_convex_.polygons);
    }

    TextScanner in_;
    const std::string& file_;
    const char* at_ = nullptr;  // in binary data
    const char* end_;
    bool text_ = false, swapped_ = false;
    std::vector<Element> elements_;
    std::array<double, 11> values_{};  // of the element being read, by role
    std::vector<std::uint32_t> corners_;
    std::vector<math::Vec3> ring_;
    std::optional<bool> has_normals_;  // none: no vertices yet
    bool has_colors_ = false, all_normals_good_ = true;
    std::vector<std::array<float, 3>> normals_;
    math::Vec3 color_sum_;
    PolygonCollector not_convex_;
    std::size_t not_faces_ = 0;
    MeshContent content_;
    Problems problems_, warnings_;
};

}  // namespace

Expected<Loaded> read_ply_file(const std::filesystem::path& file) {
    return read_whole_file(file).and_then([&](const std::string& bytes) { return read_ply(bytes, file.string()); });
}

Expected<Loaded> read_ply(std::string_view bytes, const std::string& file_name) { return PlyReader(bytes, file_name).read(); }

}  // namespace crescente::io
