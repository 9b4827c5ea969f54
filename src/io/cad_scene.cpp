#include "io/cad_scene.h"

#include <utility>

#include "io/cad_material.h"

namespace crescente::io {
namespace {

using scene::MaterialId;
using scene::NodeId;
using scene::ShapeId;

class SceneMaker {
public:
    SceneMaker(const CadModel& model, std::vector<UntraceableFace>& untraceable) : model_(model), untraceable_(untraceable) {}

    Loaded make() {
        loaded_.cad = model_.counts;
        loaded_.warnings = model_.warnings;
        scene().unit = {model_.unit, model_.unit_metres};
        for (const CadColor& color : model_.colors) scene().materials.push_back(cad_material(color));
        for (std::uint32_t part = 0; part < model_.parts.size(); ++part) add_shapes(part);
        scene().nodes.resize(model_.nodes.size());
        for (std::uint32_t node = 0; node < model_.nodes.size(); ++node) fill_node(node);
        add_top();
        return std::move(loaded_);
    }

private:
    scene::Scene& scene() { return loaded_.scene; }

    ShapeId add_shape(const std::string& name, geometry::Shape shape) {
        scene().shapes.push_back({name, std::move(shape)});
        return {static_cast<std::uint32_t>(scene().shapes.size() - 1)};
    }

    void add_shapes(std::uint32_t which) {
        const CadPart& part = model_.parts[which];
        Shown shown;
        if (!part.faces.empty()) {
            std::vector<geometry::FaceProblem> problems;
            geometry::Brep brep(part.faces, problems);
            for (const geometry::FaceProblem& problem : problems) untraceable_.push_back({which, problem.face, problem.reason});
            if (brep.parts() > 0) shown.faces = add_shape(part.name, std::move(brep));
        }
        if (!part.mesh.triangles.empty()) shown.mesh = add_shape(shown.faces.valid() ? part.name + " (triangles)" : part.name, part.mesh);
        shown_.push_back(shown);
    }

    // A node shows one shape: the triangles of a part that also has faces get a node below.
    void fill_node(std::uint32_t which) {
        const CadNode& from = model_.nodes[which];
        scene::Node node;
        node.name = from.name;
        node.transform = from.transform;
        for (const std::uint32_t child : from.children) node.children.push_back({child});
        if (from.part < shown_.size()) {
            const Shown& shown = shown_[from.part];
            for (const std::uint32_t color : from.colors) node.materials.push_back(color == CadPart::no_color ? uncolored() : MaterialId{color});
            node.shape = shown.faces.valid() ? shown.faces : shown.mesh;
            if (shown.faces.valid() && shown.mesh.valid()) {
                scene::Node triangles;
                triangles.name = from.name + " (triangles)";
                triangles.shape = shown.mesh;
                triangles.materials = node.materials;
                node.children.push_back({static_cast<std::uint32_t>(scene().nodes.size())});
                scene().nodes.push_back(std::move(triangles));
            }
        }
        scene().nodes[which] = std::move(node);
    }

    // Turns z up to y up, and millimetres to metres. A single root is turned itself.
    void add_top() {
        constexpr double metre = 0.001;
        const math::Affine to_scene{{metre, 0, 0}, {0, 0, -metre}, {0, metre, 0}, {}};
        if (model_.roots.size() == 1) {
            scene::Node& root = scene().nodes[model_.roots[0]];
            root.transform = to_scene * root.transform;
            scene().name = root.name;
            scene().roots = {{model_.roots[0]}};
            return;
        }
        scene::Node top;
        top.transform = to_scene;
        for (const std::uint32_t root : model_.roots) top.children.push_back({root});
        scene().roots = {{static_cast<std::uint32_t>(scene().nodes.size())}};
        scene().nodes.push_back(std::move(top));
    }

    MaterialId uncolored() {
        if (!uncolored_.valid()) {
            uncolored_ = {static_cast<std::uint32_t>(scene().materials.size())};
            scene().materials.push_back(uncolored_cad_material());
        }
        return uncolored_;
    }

    struct Shown {
        ShapeId faces, mesh;
    };

    const CadModel& model_;
    std::vector<UntraceableFace>& untraceable_;
    Loaded loaded_;
    std::vector<Shown> shown_;  // by part
    MaterialId uncolored_;
};

}  // namespace

Loaded cad_scene(const CadModel& model, std::vector<UntraceableFace>& untraceable) { return SceneMaker(model, untraceable).make(); }

}  // namespace crescente::io
