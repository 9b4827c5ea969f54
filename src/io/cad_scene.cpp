#include "io/cad_scene.h"

#include <utility>

#include "io/cad_material.h"

namespace crescente::io {
namespace {

using scene::MaterialId;
using scene::NodeId;
using scene::ShapeId;

constexpr double metre = 0.001;  // of the file's millimetres

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
        add_roots();
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

    // A node shows one shape: the triangles of a part that also has faces get a node below. The spaces of assemblies are those of the scene, y up and in
    // metres, so that edits may speak of them; only the shapes themselves are in the file's millimetres, z up.
    void fill_node(std::uint32_t which) {
        const CadNode& from = model_.nodes[which];
        scene::Node node;
        node.name = from.name;
        node.transform = turn() * from.transform * math::inverse(turn());
        node.transform.origin *= metre;
        for (const std::uint32_t child : from.children) node.children.push_back({child});
        if (from.part < shown_.size()) {
            if (from.children.empty()) show(from, node);
            else show_below(from, node);
        }
        scene().nodes[which] = std::move(node);
    }

    void show(const CadNode& from, scene::Node& node) {
        const Shown& shown = shown_[from.part];
        node.transform = node.transform * to_scene();
        for (const std::uint32_t color : from.colors) node.materials.push_back(color == CadPart::no_color ? uncolored() : MaterialId{color});
        node.shape = shown.faces.valid() ? shown.faces : shown.mesh;
        if (shown.faces.valid() && shown.mesh.valid()) {
            scene::Node triangles;
            triangles.name = from.name + " (triangles)";
            triangles.shape = shown.mesh;
            triangles.materials = node.materials;
            add_below(node, std::move(triangles));
        }
    }

    // Of a part that is also an assembly.
    void show_below(const CadNode& from, scene::Node& node) {
        scene::Node part;
        part.name = from.name;
        show(from, part);
        add_below(node, std::move(part));
    }

    void add_below(scene::Node& node, scene::Node child) {
        node.children.push_back({static_cast<std::uint32_t>(scene().nodes.size())});
        scene().nodes.push_back(std::move(child));
    }

    static math::Affine turn() { return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {}}; }  // z up to y up
    static math::Affine to_scene() { return math::Affine::scaling({metre, metre, metre}) * turn(); }

    void add_roots() {
        for (const std::uint32_t root : model_.roots) scene().roots.push_back({root});
        if (model_.roots.size() == 1) scene().name = scene().nodes[model_.roots[0]].name;
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
