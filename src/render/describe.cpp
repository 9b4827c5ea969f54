#include "render/describe.h"

namespace crescente::render {
namespace {

std::string name_or(const std::string& name, const char* kind, std::uint32_t index) { return name.empty() ? kind + (" " + std::to_string(index)) : "'" + name + "'"; }

const char* word(Share share) {
    switch (share) {
        case Share::untried: return "not tried";
        case Share::behind: return "behind the surface or out of reach";
        case Share::blocked: return "in shadow";
        case Share::clear: return "clear";
        case Share::filtered: return "filtered";
    }
    return "";
}

const char* word(Way way) {
    switch (way) {
        case Way::reflected: return "reflected";
        case Way::refracted: return "refracted";
        case Way::straight: return "straight";
    }
    return "";
}

// Takes trees out of one tile.
class Taker {
public:
    Taker(const Tile& tile, const World& world) : tile_(tile), world_(world), radiance_(radiances(tile)) {}

    RayTree take(std::uint32_t index, const char* kind) const {
        const Node& node = tile_.nodes[index];
        RayTree tree;
        tree.kind = kind;
        tree.influence = influence(tile_, index);
        tree.radiance = radiance_[index];
        tree.position = node.position;
        tree.local = node.local;
        tree.left_scene = node.left_scene();
        if (tree.left_scene) return tree;
        if (node.parent == no_node) tree.from = world_.camera.viewer_of(node.position);
        add_surface(node, tree);
        add_lights(index, tree);
        for_each_child(tile_, index, [&](std::uint32_t child, Way way) { tree.children.push_back(take(child, word(way))); });
        for (const Pending& p : tile_.pending) {
            if (p.parent == index) tree.ungrown.push_back({word(p.way), double(p.influence)});
        }
        return tree;
    }

private:
    void add_surface(const Node& node, RayTree& tree) const {
        const scene::Scene& scene = world_.scene;
        tree.object = world_.node_of_instance[node.instance];
        tree.object_name = name_or(scene.nodes[tree.object].name, "node", tree.object);
        const geometry::Shape& shape = scene.shapes[scene.nodes[tree.object].shape.value].shape;
        tree.shape = geometry::shape_names[shape.index()];
        tree.face = geometry::face_number(shape, node.primitive);
        const bool named = node.material < scene.materials.size();
        if (named) tree.material = node.material;
        tree.material_name = named ? name_or(scene.materials[node.material].name, "material", node.material) : "the default material";
        tree.inside = node.inside;
        tree.normal = {node.normal[0], node.normal[1], node.normal[2]};
    }

    void add_lights(std::uint32_t index, RayTree& tree) const {
        const std::size_t lights = world_.lights.size();
        for (std::size_t l = 0; l < lights; ++l) {
            const std::size_t key = index * lights + l;
            const Share share = key < tile_.shares.size() ? tile_.shares[key] : Share::untried;
            SeenLight seen{static_cast<std::uint32_t>(l), name_or(world_.lights[l].source().name, "light", static_cast<std::uint32_t>(l)), word(share), {1, 1, 1},
                           world_.lights[l].at(tree.position).strength};
            if (share == Share::filtered) seen.through = tile_.filtered.at(key);
            tree.lights.push_back(std::move(seen));
        }
    }

    const Tile& tile_;
    const World& world_;
    std::vector<Rgb> radiance_;
};

std::size_t splits(const Tile& tile, const Quad& quad) {
    if (quad.parts == no_node) return 0;
    std::size_t sum = 1;
    for (std::uint32_t k = 0; k < 4; ++k) sum += splits(tile, tile.quads[quad.parts + k]);
    return sum;
}

// The five roots that split a quad, whose top left corner and size are given in pixels, and those that split its parts.
void take_parts(const Tile& tile, const Taker& taker, const Quad& quad, double x, double y, double size, std::vector<PixelTrees::Corner>& out) {
    if (quad.parts == no_node) return;
    const double half = size / 2;
    const auto take_root = [&](std::uint32_t part, std::uint32_t corner, double dx, double dy) {
        out.push_back({x + dx, y + dy, taker.take(tile.quads[quad.parts + part].corners[corner], "camera")});
    };
    take_root(0, 1, half, 0);
    take_root(0, 2, 0, half);
    take_root(0, 3, half, half);
    take_root(1, 3, size, half);
    take_root(2, 3, half, size);
    for (std::uint32_t k = 0; k < 4; ++k) take_parts(tile, taker, tile.quads[quad.parts + k], x + (k & 1 ? half : 0), y + (k & 2 ? half : 0), half, out);
}

}  // namespace

PixelTrees trees_of_pixel(const Tile& tile, const World& world, int x, int y) {
    PixelTrees trees{tile.x0 + x, tile.y0 + y, {}, {}};
    const Taker taker(tile, world);
    for (int k = 0; k < 4; ++k) {
        const std::uint32_t root = tile.corners.empty() ? no_node : tile.corner(x + (k & 1), y + (k >> 1));
        PixelTrees::Corner corner{double(trees.x + (k & 1)), double(trees.y + (k >> 1)), {}};
        if (root != no_node) corner.tree = taker.take(root, "camera");
        trees.corners.push_back(std::move(corner));
    }
    if (!tile.quads.empty()) {
        const Quad& quad = tile.quads[static_cast<std::size_t>(y) * static_cast<std::size_t>(tile.width) + static_cast<std::size_t>(x)];
        trees.splits = splits(tile, quad);
        take_parts(tile, taker, quad, trees.x, trees.y, 1, trees.corners);
    }
    return trees;
}

}  // namespace crescente::render
