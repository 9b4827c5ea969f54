#include "app/cli/info_cad.h"

#include <cstdio>
#include <numeric>

namespace crescente::app {
namespace {

using Json = nlohmann::ordered_json;

std::uint64_t faces_of(const scene::Scene& scene, const scene::Node& node) {
    const auto* brep = node.shape.valid() ? std::get_if<geometry::Brep>(&scene.shapes[node.shape.value].shape) : nullptr;
    return brep ? brep->face_count() : 0;
}
std::uint64_t triangles_of(const scene::Scene& scene, const scene::Node& node) {
    const auto* mesh = node.shape.valid() ? std::get_if<geometry::Mesh>(&scene.shapes[node.shape.value].shape) : nullptr;
    return mesh ? mesh->triangles.size() : 0;
}

std::string plural(std::uint64_t count, const char* what) { return std::to_string(count) + " " + what + (count == 1 ? "" : "s"); }

// The hierarchy as indented lines.
class TreeText {
public:
    explicit TreeText(const scene::Scene& scene) : scene_(scene) {}

    std::string text() {
        add_all(scene_.roots, 0);
        if (left_out_ > 0) text_ += "           ... and " + plural(left_out_, "more place") + " (all in --json)\n";
        return std::move(text_);
    }

private:
    static constexpr std::size_t most_lines = 200;
    static constexpr int deepest = 40;

    bool alike(scene::NodeId a, scene::NodeId b) const {
        const scene::Node &one = scene_.nodes[a.value], &other = scene_.nodes[b.value];
        return one.shape == other.shape && one.children == other.children && one.materials == other.materials;
    }

    void add_all(const std::vector<scene::NodeId>& nodes, int depth) {
        for (std::size_t i = 0; i < nodes.size();) {
            std::size_t count = 1;
            while (i + count < nodes.size() && alike(nodes[i], nodes[i + count])) ++count;
            if (lines_ < most_lines && depth < deepest) add(scene_.nodes[nodes[i].value], count, depth);
            else left_out_ += count;
            i += count;
        }
    }

    void add(const scene::Node& node, std::size_t count, int depth) {
        ++lines_;
        text_ += (lines_ == 1 ? "tree       " : std::string(11, ' ')) + std::string(static_cast<std::size_t>(depth) * 2, ' ');
        text_ += node.name.empty() ? "(unnamed)" : node.name;
        if (count > 1) text_ += " x " + std::to_string(count);
        if (const auto faces = faces_of(scene_, node)) text_ += ": " + plural(faces, "face");
        if (const auto triangles = triangles_of(scene_, node)) text_ += ": " + plural(triangles, "triangle");
        text_ += '\n';
        add_all(node.children, depth + 1);
    }

    const scene::Scene& scene_;
    std::string text_;
    std::size_t lines_ = 0;
    std::uint64_t left_out_ = 0;
};

}  // namespace

Json cad_json(const io::Loaded& loaded) {
    const io::CadCounts& counts = *loaded.cad;
    Json kinds = Json::object();
    for (std::size_t kind = 0; kind < counts.faces.size(); ++kind) {
        if (counts.faces[kind] > 0) kinds[std::string(io::cad_surface_names[kind])] = counts.faces[kind];
    }
    Json tree = Json::array();
    for (const scene::Node& node : loaded.scene.nodes) {
        Json entry = {{"name", node.name}};
        if (const auto faces = faces_of(loaded.scene, node)) entry["faces"] = faces;
        if (const auto triangles = triangles_of(loaded.scene, node)) entry["triangles"] = triangles;
        if (node.shape.valid()) entry["shape"] = node.shape.value;
        Json children = Json::array();
        for (const scene::NodeId child : node.children) children.push_back(child.value);
        if (!children.empty()) entry["children"] = std::move(children);
        tree.push_back(std::move(entry));
    }
    Json roots = Json::array();
    for (const scene::NodeId root : loaded.scene.roots) roots.push_back(root.value);
    return {{"faces", std::accumulate(counts.faces.begin(), counts.faces.end(), std::uint64_t{0})},
            {"surfaces", std::move(kinds)},
            {"faces_shown", counts.shown},
            {"exact", counts.exact},
            {"approximated", counts.approximated},
            {"tessellated", counts.tessellated},
            {"degenerate", counts.degenerate},
            {"healed", counts.healed},
            {"patches", counts.patches},
            {"largest_tolerance_mm", counts.largest_tolerance},
            {"largest_gap_mm", counts.largest_gap},
            {"roots", std::move(roots)},
            {"tree", std::move(tree)}};
}

std::string cad_text(const io::Loaded& loaded) {
    const io::CadCounts& counts = *loaded.cad;
    const std::uint64_t all = std::accumulate(counts.faces.begin(), counts.faces.end(), std::uint64_t{0});
    std::string text = "faces      " + std::to_string(all) + ", shown " + std::to_string(counts.shown) + " with instances\n";
    std::string kinds;
    for (std::size_t kind = 0; kind < counts.faces.size(); ++kind) {
        if (counts.faces[kind] > 0) kinds += (kinds.empty() ? "" : ", ") + std::to_string(counts.faces[kind]) + " " + std::string(io::cad_surface_names[kind]);
    }
    text += "surfaces   " + kinds + "\n";
    std::string exact = std::to_string(counts.exact);
    const auto add = [&](std::uint64_t count, const char* what) {
        if (count > 0) exact += ", " + std::to_string(count) + " " + what;
    };
    add(counts.approximated, "approximated to 1e-6 of the part"), add(counts.tessellated, "as triangles"), add(counts.degenerate, "without area");
    add(counts.healed, "mended");
    text += "exact      " + exact + "\n";
    char gaps[96];
    std::snprintf(gaps, sizeof gaps, "edges      declared to %.3g mm, measured gaps up to %.3g mm\n", counts.largest_tolerance, counts.largest_gap);
    return text + gaps + TreeText(loaded.scene).text();
}

}  // namespace crescente::app
