#include "io/stl.h"

#include <cstring>

#include "io/mesh_scene.h"
#include "io/text_file.h"
#include "io/text_scanner.h"

namespace crescente::io {
namespace {

constexpr std::size_t binary_header = 84, binary_facet = 50;

std::uint32_t facet_count(std::string_view bytes) {
    std::uint32_t count = 0;
    if (bytes.size() >= binary_header) std::memcpy(&count, bytes.data() + 80, sizeof count);
    return count;
}

// Binary files may begin with "solid" too; what tells is whether the count fits the size.
bool is_binary(std::string_view bytes) {
    if (bytes.size() < binary_header) return !bytes.starts_with("solid");
    const std::size_t promised = binary_header + binary_facet * std::size_t{facet_count(bytes)};
    return promised == bytes.size() || !bytes.starts_with("solid") || bytes.substr(0, 1000).find('\0') != std::string_view::npos;
}

class StlReader {
public:
    StlReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    Expected<Loaded> read() {
        content_.unit = {"mm", 0.001};
        content_.z_up = true;
        if (!(is_binary(bytes_) ? read_binary() : read_text())) return tl::unexpected<Error>(Error{ErrorKind::input, std::move(problems_)});
        return scene_of(std::move(content_), file_, std::move(warnings_));
    }

private:
    bool problem(std::string place, std::string reason) {
        problems_.push_back({file_, std::move(place), std::move(reason), {}});
        return false;
    }

    void add_facet(const std::array<math::Vec3, 3>& corners) {
        const auto first = static_cast<std::uint32_t>(content_.mesh.positions.size());
        content_.mesh.positions.insert(content_.mesh.positions.end(), corners.begin(), corners.end());
        content_.mesh.triangles.push_back({first, first + 1, first + 2});
    }

    bool read_binary() {
        const std::size_t count = facet_count(bytes_), there = bytes_.size() < binary_header ? 0 : (bytes_.size() - binary_header) / binary_facet;
        if (bytes_.size() < binary_header) return problem("", "this is not STL: the file is shorter than the header");
        if (there < count) return problem("", "the file is cut: " + std::to_string(there) + " of " + std::to_string(count) + " triangles are there");
        content_.mesh.positions.reserve(3 * count);
        content_.mesh.triangles.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            std::array<float, 9> v;  // after the normal, which the corners give anyway
            std::memcpy(v.data(), bytes_.data() + binary_header + i * binary_facet + 12, sizeof v);
            add_facet({math::Vec3{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}});
        }
        return true;
    }

    // "solid", facets of "facet normal ... outer loop vertex ... (three times) endloop endfacet", "endsolid"; several solids may follow.
    bool read_text() {
        TextScanner in(bytes_);
        constexpr std::size_t most_problems = 50;
        bool open = false;
        std::array<math::Vec3, 3> corners;
        std::size_t corner_count = 0;
        while (in.to_word() && problems_.size() < most_problems) {
            const std::string place = "line " + std::to_string(in.line());
            const std::string_view word = in.word();
            if (word == "vertex") {
                double v[3];
                for (double& value : v) {
                    if (in.number(value) == TextScanner::Number::good) continue;
                    problem(place, "a vertex needs three finite numbers");
                    break;
                }
                if (corner_count < 3) corners[corner_count] = {v[0], v[1], v[2]};
                ++corner_count;
            } else if (word == "endloop") {
                if (corner_count == 3) add_facet(corners);
                else problem(place, "a facet has " + std::to_string(corner_count) + " vertices");
                corner_count = 0;
            } else if (word == "solid" || word == "endsolid" || word == "facet") {
                if (word != "facet") open = word == "solid";
                in.rest_of_line();  // a name, or the normal
            } else if (word != "outer" && word != "loop" && word != "endfacet") {
                problem(place, "unexpected '" + std::string(word.substr(0, 40)) + "'");
                in.rest_of_line();
            }
        }
        if (problems_.empty() && open) problem("", "the file is cut: 'endsolid' is missing");
        return problems_.empty();
    }

    std::string_view bytes_;
    const std::string& file_;
    MeshContent content_;
    Problems problems_, warnings_;
};

}  // namespace

Expected<Loaded> read_stl_file(const std::filesystem::path& file) {
    return read_whole_file(file).and_then([&](const std::string& bytes) { return read_stl(bytes, file.string()); });
}

Expected<Loaded> read_stl(std::string_view bytes, const std::string& file_name) { return StlReader(bytes, file_name).read(); }

}  // namespace crescente::io
